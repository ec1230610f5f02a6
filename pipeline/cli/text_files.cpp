#include "pipeline/cli/text_files.h"

#include <fmt/format.h>

#include "core/output_file.h"

namespace trapeze {
namespace {

bool report(const std::string& path, const OutputFile& file, Diagnostics& diagnostics) {
    diagnostics.error({}, fmt::format("cannot write \"{}\": {}", path, file.error()));
    return false;
}

}  // namespace

bool can_write(std::initializer_list<std::string> paths, Diagnostics& diagnostics) {
    for (const std::string& path : paths) {
        if (path.empty()) continue;
        OutputFile file(path);
        if (!file.open()) return report(path, file, diagnostics);
    }
    return true;
}

bool write_text(const std::string& path, const std::string& text, Diagnostics& diagnostics) {
    OutputFile file(path);
    return (file.open() && file.write(text.data(), text.size()) && file.commit()) ||
           report(path, file, diagnostics);
}

}  // namespace trapeze
