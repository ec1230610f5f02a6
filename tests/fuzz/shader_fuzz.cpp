/// The shading language's front end on bytes from strangers. With clang: -fsanitize=fuzzer,address,undefined
/// and shade/rsl/test_shaders as corpus. With any compiler: linked with replay_main.cpp it runs the seeds
/// and mutations of them. What is printed must parse again.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "shade/rsl/front_end.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace trapeze::rsl;
    constexpr size_t kMostBytes = size_t{1} << 16;
    const Source source{"fuzz.sl", {reinterpret_cast<const char*>(data), std::min(size, kMostBytes)}};
    CompileOptions options;
    options.include_folders = {"include"};
    // A file may include itself and others like it.
    options.read_file = [&](const std::string& path) -> std::optional<std::string> {
        if (path.ends_with("fuzz.sl")) return source.text;
        if (path.ends_with(".h"))
            return "#define INCLUDED(x) x ## x #x\nfloat included(float x) { return x; }\n";
        return {};
    };
    trapeze::Diagnostics diagnostics([](const trapeze::Diagnostic&) {});
    if (const auto unit = parse(source, options, diagnostics)) {
        const std::string text = print(*unit);
        const auto again = parse({"printed.sl", text}, options, diagnostics);
        if (!again || print(*again) != text) std::abort();
    }
    if (const auto unit = compile_front(source, options, diagnostics)) print(*unit);
    return 0;
}
