#!/usr/bin/env python3
"""Where the time of shading goes, by family: a table of shade_bench's shaders from perf's samples.

    tests/bench/shade_cost.py build/bin/shade_bench [--simd avx2] [BENCHMARK...]

Each row is one benchmark on one thread; shares are of the samples taken while it ran, the nanoseconds those of
a vertex. "interpreter" is the machine's own work: steps, masks, frames and values moved between planes.
"variables" is what comes in from a grid and goes out again. Needs perf (Debian: linux-perf).
"""
import argparse
import collections
import csv
import os
import re
import subprocess
import sys
import tempfile

SHADERS = ["constant", "plastic_unlit", "plastic_distant", "plastic_spot", "plastic_four_points", "dented_matte",
           "six_octaves", "octaves_alone", "textured", "plastic_one_micropolygon"]

# In order: the first pattern that a symbol matches says its family. Kernels are in a namespace of their
# instruction set (N_AVX2...), so their plain names are enough.
KERNEL = r"::N_\w+::"
FAMILIES = [
    ("noise", KERNEL + r".*(noise|lattice|gradient)"),
    ("lights", KERNEL + r".*(sum_|find_cone|turn_to_surface|specular_brdf)"),
    ("maps", r"OpenImageIO|OIIO|Imf_|Texture|MapService|map_"),
    ("elementary", KERNEL + r".*(\bpow\b|\bexp|\blog|\bsin|\bcos|\btan|\bacos|\batan|sqrt)|sincosf|hypot"),
    ("geometry", KERNEL + r".*(normalize|face_forward|dot_product|cross_product|transform|length|distance|"
                 r"reflect|refract|fresnel|rotate)"),
    ("neighbours", r"derivative|calculate_normals|neighbour|difference|displace|normal_at|normals"),
    ("interpreter", KERNEL + r".*\bsame\b"),
    ("arithmetic", KERNEL),
    ("interpreter", r"vm::(Run|Machine|Frame|MaskStack|copy_|find_kernel|find_)|LightRig|BoundShader|"
                    r"_Hashtable|_Map_base|same_uniforms|GridRun|Shading::|set_parameters"),
    ("variables", r"set_variable|Loader|take_|mem(move|cpy|set|cmp)|variable_planes|pack|malloc|free|operator new"),
]
NAMES = ["arithmetic", "elementary", "geometry", "lights", "noise", "maps", "neighbours", "interpreter",
         "variables", "other"]


def family_of(symbol):
    for name, pattern in FAMILIES:
        if re.search(pattern, symbol):
            return name
    return "other"


def nanoseconds_a_vertex(bench, simd, name):
    """Processor time by the benchmark's own clock, without perf: the median of five."""
    text = subprocess.run([bench, *simd, f"--benchmark_filter=^{name}(/real_time/threads:1)?$", "--benchmark_format=csv",
                           "--benchmark_repetitions=5", "--benchmark_report_aggregates_only=true"],
                          check=True, capture_output=True, text=True).stdout
    rows = list(csv.DictReader(line for line in text.splitlines() if line.startswith(("name,", '"'))))
    median = next(row for row in rows if row["name"].endswith("_median"))
    side = 2 if "one_micropolygon" in name else 17
    return float(median["cpu_time"]) / side**2


def shares(bench, simd, name):
    """Of the samples of one benchmark, by family; and the largest symbols of `other`."""
    with tempfile.TemporaryDirectory() as folder:
        data = os.path.join(folder, "perf.data")
        subprocess.run(["perf", "record", "-q", "-F", "2999", "-o", data, bench, *simd,
                        f"--benchmark_filter=^{name}(/real_time/threads:1)?$", "--benchmark_min_time=3"],
                       check=True, capture_output=True)
        report = subprocess.run(["perf", "report", "-i", data, "--stdio", "-F", "overhead,symbol", "--percent-limit", "0"],
                                check=True, capture_output=True, text=True).stdout
    totals, others = collections.Counter(), collections.Counter()
    for line in report.splitlines():
        found = re.match(r"\s*([\d.]+)%\s+\[[.k]\]\s+(.*)", line)
        # The loader's work and that of the benchmark's start are not the shader's.
        if not found or re.search(r"_dl_|do_lookup|check_match|\[k\]|strcmp", line):
            continue
        name = family_of(found[2])
        totals[name] += float(found[1])
        if name == "other":
            others[found[2].strip()] += float(found[1])
    whole = sum(totals.values()) or 1
    return {name: totals[name] / whole for name in NAMES}, others.most_common(3)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bench")
    parser.add_argument("--simd")
    parser.add_argument("shaders", nargs="*", metavar="BENCHMARK")
    options = parser.parse_intermixed_args()
    simd = ["--simd", options.simd] if options.simd else []
    print(f"{'':26}{'ns/vertex':>10}" + "".join(f"{name:>12}" for name in NAMES))
    for name in options.shaders or SHADERS:
        nanoseconds = nanoseconds_a_vertex(options.bench, simd, name)
        split, others = shares(options.bench, simd, name)
        print(f"{name:26}{nanoseconds:10.2f}" + "".join(f"{100 * split[family]:11.1f}%" for family in NAMES))
        if split["other"] > 0.1:
            print("    other: " + ", ".join(f"{symbol} {share:.1f}%" for symbol, share in others), file=sys.stderr)


if __name__ == "__main__":
    main()
