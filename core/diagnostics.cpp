#include "core/diagnostics.h"

#include <algorithm>
#include <optional>

namespace trapeze {
namespace {

constexpr size_t kExcerptWidth = 100;  // characters of a line that are shown

/// The n-th line (from 1) without its end. Lines end with \n, \r\n or \r.
std::optional<std::string_view> line_of(std::string_view text, int64_t n) {
    while (true) {
        const size_t end = std::min(text.find_first_of("\r\n"), text.size());
        if (n == 1) return text.substr(0, end);
        if (end == text.size() || n < 1) return {};
        const bool two = text[end] == '\r' && end + 1 < text.size() && text[end + 1] == '\n';
        text.remove_prefix(end + (two ? 2 : 1));
        --n;
    }
}

/// The part of a line around a column (from 1), and a caret below it. Tabs and what cannot be shown become
/// spaces, so that the caret stands right.
std::string excerpt_around(std::string_view line, uint32_t column) {
    const size_t caret = std::min<size_t>(column > 0 ? column - 1 : 0, line.size());
    const size_t first = caret < kExcerptWidth - 20 ? 0 : caret - kExcerptWidth / 2;
    const size_t last = std::min(line.size(), first + kExcerptWidth);
    std::string shown = first > 0 ? "..." : "";
    const size_t indent = shown.size() + caret - first;
    for (const char c : line.substr(first, last - first))
        shown += static_cast<unsigned char>(c) < 32 || c == 127 ? ' ' : c;
    if (last < line.size()) shown += "...";
    return "    " + shown + "\n    " + std::string(indent, ' ') + "^";
}

}  // namespace

std::string to_string(const Diagnostic& diagnostic) {
    static constexpr const char* kNames[] = {"note", "warning", "error"};
    std::string line;
    if (!diagnostic.place.empty()) line += diagnostic.place + ": ";
    line += kNames[static_cast<int>(diagnostic.severity)];
    line += ": ";
    line += diagnostic.text;
    if (!diagnostic.excerpt.empty()) line += "\n" + diagnostic.excerpt;
    for (const std::string& place : diagnostic.included_from) line += "\n    included from " + place;
    return line;
}

uint32_t Diagnostics::add_source(std::string name, SourceLocation included_from) {
    return add_source(std::move(name), included_from, nullptr);
}

uint32_t Diagnostics::add_source(std::string name, SourceLocation included_from,
                                 std::shared_ptr<const std::string> text, int64_t line_shift) {
    const std::lock_guard lock(mutex_);
    sources_.push_back({std::move(name), included_from, std::move(text), line_shift});
    return static_cast<uint32_t>(sources_.size());
}

std::string Diagnostics::source_name(uint32_t source) const {
    const std::lock_guard lock(mutex_);
    return source == 0 || source > sources_.size() ? std::string() : sources_[source - 1].name;
}

std::string Diagnostics::place_of(SourceLocation at) const {
    if (at.source == 0 || at.source > sources_.size()) return {};
    std::string place = sources_[at.source - 1].name;
    if (at.line > 0) place += ":" + std::to_string(at.line) + ":" + std::to_string(at.column);
    return place;
}

std::string Diagnostics::excerpt_of(SourceLocation at) const {
    if (at.source == 0 || at.source > sources_.size() || at.line == 0) return {};
    const Source& source = sources_[at.source - 1];
    if (!source.text) return {};
    const auto line = line_of(*source.text, static_cast<int64_t>(at.line) - source.line_shift);
    return line ? excerpt_around(*line, at.column) : std::string();
}

void Diagnostics::report(Severity severity, SourceLocation at, std::string text, std::string kind) {
    const std::lock_guard lock(mutex_);
    ++counts_[static_cast<int>(severity)];
    if (!kind.empty()) {
        auto [entry, is_new] = kinds_.try_emplace(kind, KindCount{severity, text, 0});
        ++entry->second.count;
        if (!is_new) return;
    }
    if (!listener_) return;
    Diagnostic diagnostic{severity, std::move(text), place_of(at), {}, std::move(kind), excerpt_of(at)};
    for (SourceLocation from = at; from.source != 0 && from.source <= sources_.size();) {
        from = sources_[from.source - 1].included_from;
        if (from.source != 0) diagnostic.included_from.push_back(place_of(from));
    }
    listener_(diagnostic);
}

uint64_t Diagnostics::count(Severity severity) const {
    const std::lock_guard lock(mutex_);
    return counts_[static_cast<int>(severity)];
}

std::map<std::string, Diagnostics::KindCount> Diagnostics::kinds() const {
    const std::lock_guard lock(mutex_);
    return kinds_;
}

}  // namespace trapeze
