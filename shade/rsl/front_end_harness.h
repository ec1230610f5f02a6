/// What the front end's tests share.
#pragma once

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/files/file_text_harness.h"
#include "shade/rsl/front_end.h"

namespace trapeze::testing {

/// Collects messages as "error 3:5: text", without the file's name.
struct Heard {
    std::vector<std::string> lines;
    Diagnostics diagnostics{[this](const Diagnostic& d) {
        static constexpr const char* kNames[] = {"note", "warning", "error"};
        const size_t colon = d.place.find(':');
        const std::string place = colon == std::string::npos ? "" : d.place.substr(colon + 1);
        lines.push_back(std::string(kNames[static_cast<int>(d.severity)]) + " " + place + ": " + d.text);
    }};

    std::string all() const {
        std::string text;
        for (const std::string& line : lines) text += line + "\n";
        return text;
    }
    /// The first line, or nothing.
    std::string first() const { return lines.empty() ? "" : lines[0]; }
};

/// The shaders in a folder, in a fixed order.
inline std::vector<std::filesystem::path> shaders_in(const std::string& folder) {
    std::vector<std::filesystem::path> paths;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ".sl") paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    return paths;
}

bool same(const rsl::TranslationUnit& a, const rsl::TranslationUnit& b);

}  // namespace trapeze::testing
