#include "core/diagnostics.h"

namespace trapeze {

std::string to_string(const Diagnostic& diagnostic) {
    static constexpr const char* kNames[] = {"note", "warning", "error"};
    std::string line;
    if (!diagnostic.place.empty()) line += diagnostic.place + ": ";
    line += kNames[static_cast<int>(diagnostic.severity)];
    line += ": ";
    line += diagnostic.text;
    for (const std::string& place : diagnostic.included_from) line += "\n    included from " + place;
    return line;
}

uint32_t Diagnostics::add_source(std::string name, SourceLocation included_from) {
    const std::lock_guard lock(mutex_);
    sources_.push_back({std::move(name), included_from});
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

void Diagnostics::report(Severity severity, SourceLocation at, std::string text, std::string kind) {
    const std::lock_guard lock(mutex_);
    ++counts_[static_cast<int>(severity)];
    if (!kind.empty()) {
        auto [entry, is_new] = kinds_.try_emplace(kind, KindCount{severity, text, 0});
        ++entry->second.count;
        if (!is_new) return;
    }
    if (!listener_) return;
    Diagnostic diagnostic{severity, std::move(text), place_of(at), {}, std::move(kind)};
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
