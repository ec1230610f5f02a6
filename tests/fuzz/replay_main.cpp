/// Runs a fuzz target without a fuzzer: every seed as it is, then mutations of seeds, the same ones each
/// time.
///     TARGET SEED_FOLDER [MUTATIONS]
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <set>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

namespace {

using Bytes = std::vector<uint8_t>;

std::vector<Bytes> read_seeds(const std::string& folder) {
    std::set<std::filesystem::path> paths;  // in a fixed order
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) paths.insert(entry.path());
    std::vector<Bytes> seeds;
    for (const auto& path : paths) {
        std::ifstream file(path, std::ios::binary);
        seeds.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    }
    return seeds;
}

Bytes mutated(const std::vector<Bytes>& seeds, std::mt19937& random) {
    const auto below = [&](size_t n) { return n ? random() % n : 0; };
    Bytes bytes = seeds[below(seeds.size())];
    const size_t changes = 1 + below(6);
    for (size_t c = 0; c < changes && !bytes.empty(); ++c) {
        const size_t at = below(bytes.size());
        switch (below(6)) {
            case 0:
                bytes[at] = static_cast<uint8_t>(random());
                break;
            case 1:
                bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(at));
                break;
            case 2:
                bytes.resize(at);
                break;
            case 3:
                bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), "[]\"# -9e.\n"[below(10)]);
                break;
            case 4: {  // a piece of another seed
                const Bytes& other = seeds[below(seeds.size())];
                if (other.empty()) break;
                const size_t from = below(other.size()),
                             length = below(std::min<size_t>(64, other.size() - from)) + 1;
                bytes.insert(
                    bytes.begin() + static_cast<std::ptrdiff_t>(at),
                    other.begin() + static_cast<std::ptrdiff_t>(from),
                    other.begin() + static_cast<std::ptrdiff_t>(std::min(other.size(), from + length)));
                break;
            }
            default: {  // a number made large
                const std::string number =
                    std::to_string(static_cast<int64_t>(random()) * (random() % 2 ? 1 : -1048576));
                bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), number.begin(), number.end());
            }
        }
    }
    return bytes;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) return 2;
    const std::vector<Bytes> seeds = read_seeds(argv[1]);
    if (seeds.empty()) {
        std::fprintf(stderr, "no seeds in %s\n", argv[1]);
        return 1;
    }
    for (const Bytes& seed : seeds) LLVMFuzzerTestOneInput(seed.data(), seed.size());
    const int mutations = argc > 2 ? std::atoi(argv[2]) : 2000;
    std::mt19937 random(1);
    for (int i = 0; i < mutations; ++i) {
        const Bytes bytes = mutated(seeds, random);
        LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
    }
    std::printf("%zu seeds and %d mutations\n", seeds.size(), mutations);
    return 0;
}
