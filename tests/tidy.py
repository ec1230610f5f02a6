#!/usr/bin/env python3
"""clang-tidy over many sources at once: tests/tidy.py BUILD SOURCE...   (tests/lint --tidy calls it)

Most of what clang-tidy does with a source is to read its headers. So sources are put together, some fifty in one, as
the build does with eight. Names in unnamed namespaces and macros then meet. They are found here by a look at the text
(clang-format sets them at the beginning of lines), and sources whose names would meet are kept apart. Where that was
not enough the compiler says so, and those sources are looked at again without the others.

BUILD has a compile_commands.json, whose include folders and definitions count. Kernels are looked at for one
instruction set. Prints what was found; ends with 1 if anything was.
"""
import concurrent.futures
import json
import os
import re
import subprocess
import sys
import tempfile

MOST_LINES = 12000  # of sources in one: memory, and work for every core
ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def flags_of_sources(build):
    """Of every source of the build: what its command says of includes and definitions."""
    flags = {}
    with open(build + "/compile_commands.json") as file:
        commands = json.load(file)
    for command in commands:
        words = command["command"].replace('\\"', '"').split()
        given = [w for w in words if re.match("-[DI]", w)]
        given += ["-isystem" + words[i + 1] for i, w in enumerate(words) if w == "-isystem"]
        sources = [command["file"]]
        if "/Unity/" in command["file"]:
            with open(command["file"]) as file:
                sources = re.findall('#include "(.*)"', file.read())
        for source in sources:
            flags.setdefault(os.path.relpath(source, ROOT), [g.replace('"(', "(").replace(')"', ")") for g in given])
    return flags


class Text:
    """A source or a header: the names that it declares, hidden in an unnamed namespace or for all, and all its words."""

    def __init__(self, path):
        with open(os.path.join(ROOT, path)) as file:
            text = file.read()
        self.path, self.lines = path, text.count("\n")
        code = re.sub(r'//.*|"(?:[^"\\\n]|\\.)*"|#include.*', "", text)
        # Types, constants, and what is called; but no members and nothing of std.
        self.words = set(re.findall(r"(?<![\w.>:])(?:k?[A-Z]\w*|\w+(?=[(<]))", code))
        self.includes = [i for i in re.findall('#include "(.*)"', text) if os.path.exists(os.path.join(ROOT, i))]
        self.hidden, self.open = set(), set()
        is_hidden = False
        for line in text.splitlines():
            if line == "namespace {":
                is_hidden = True
            elif line.startswith("}  // namespace"):
                is_hidden = False
            elif line.startswith("#define "):
                self.hidden.add(re.match(r"#define (\w+)", line)[1])
            elif line[:1].isalpha() and not re.match("namespace|using namespace|#", line):
                found = re.findall(r", (\w+)(?:\[[^]]*\])? = ", line)
                first = re.search(r"([\w:~]+)(?= ?(?:[({=\[;]|: | final))", line)
                if first and "::" not in first[1]:
                    found.append(first[1])
                (self.hidden if is_hidden else self.open).update(found)
        # TEST() and other macros, and what Highway's sources define anew.
        self.hidden = {n for n in self.hidden if not re.fullmatch("[A-Z][A-Z_]+|HWY_.*|float|struct|inline", n)}


class Batch:
    def __init__(self):
        self.sources, self.lines = [], 0
        self.hidden, self.open = set(), set()

    def takes(self, text, declared):
        return (self.lines + text.lines <= MOST_LINES and not self.hidden & (text.words | declared)
                and not text.hidden & (self.open - declared))

    def add(self, text, declared):
        self.sources.append(text.path)
        self.lines += text.lines
        self.hidden |= text.hidden
        self.open |= declared


def batches_of(sources):
    headers = {}

    def declared_by(text, seen):
        names = set(text.open)
        for path in text.includes:
            if path not in seen:
                seen.add(path)
                if path not in headers:
                    headers[path] = Text(path)
                names |= declared_by(headers[path], seen)
        return names

    batches = []
    # Those with many words first: they are the hardest to place.
    for text in sorted(map(Text, sources), key=lambda t: (-len(t.words), t.path)):
        declared = declared_by(text, set())
        batch = next((b for b in batches if b.takes(text, declared)), None)
        if not batch:
            batch = Batch()
            batches.append(batch)
        batch.add(text, declared)
    return [b.sources for b in batches]


def look_at(sources, flags, folder):
    """What clang-tidy says, as pairs of a source and the lines that begin there; and sources to look at again."""
    wanted = list(dict.fromkeys(f for s in sources for f in flags[s]))
    with tempfile.NamedTemporaryFile("w", suffix=".cpp", dir=folder) as file:
        file.writelines('#include "%s/%s"\n' % (ROOT, s) for s in sources)
        file.flush()
        done = subprocess.run(["clang-tidy", "--quiet", "--config-file=" + ROOT + "/.clang-tidy", file.name, "--", "-std=c++20", "-ferror-limit=0",
                               "-Wno-macro-redefined", "-DHWY_COMPILE_ONLY_STATIC", *wanted],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    messages = []
    for line in done.stdout.replace(ROOT + "/", "").splitlines():
        if re.match(r"\S+:\d+:\d+: (error|warning): ", line):
            messages.append([line])
        elif messages:
            messages[-1].append(line)
    if done.returncode and not messages:
        messages.append(["clang-tidy: " + (done.stderr or "it ended with %d" % done.returncode)])
    broken = {m[0].split(":")[0] for m in messages if "[clang-diagnostic-error" in m[0]}
    again = []
    if broken and len(sources) > 1:
        again = [s for s in sources if s in broken]
        if not broken <= set(again) or len(again) == len(sources):  # in a header, or everywhere
            return [], [sources[::2], sources[1::2]]
        messages = [m for m in messages if m[0].split(":")[0] not in broken]
    return messages, [again] if again else []


def main():
    build, sources = os.path.abspath(sys.argv[1]), sys.argv[2:]
    flags = flags_of_sources(build)
    work = batches_of([s for s in sources if s in flags])
    found = set()
    with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool, \
            tempfile.TemporaryDirectory(dir=build) as folder:
        while work:
            again = []
            for messages, left in pool.map(lambda batch: look_at(batch, flags, folder), work):
                found |= {"\n".join(m) for m in messages}
                again += left
            work = again
    print("".join(text + "\n" for text in sorted(found)), end="")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
