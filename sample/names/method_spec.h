/// How users name a visibility method or a sample pattern: "name" or "name:key=value,key=value".
#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace trapeze {

/// A name and the value of every option that it has, defaults filled in.
struct MethodSpec {
    std::string name;
    std::map<std::string, std::string, std::less<>> options;

    /// The value of an option that the table lists.
    const std::string& operator[](std::string_view key) const { return options.find(key)->second; }
    bool has(std::string_view key) const { return options.contains(key); }
    bool is_on(std::string_view key) const { return (*this)[key] == "on"; }
    /// Of an option whose values in the table are all numbers; complete_spec() has let no other word through.
    int number(std::string_view key) const { return std::stoi((*this)[key]); }
    bool operator==(const MethodSpec&) const = default;
};

/// What an option may be: one of some words, of which the first is the default. Numbers are words too.
struct SpecOption {
    std::string_view name;
    std::vector<std::string_view> values;
};

/// The row of a name in a table; null when there is none.
template <class Row>
const Row* find_named(const std::vector<Row>& table, std::string_view name) {
    const auto found =
        std::find_if(table.begin(), table.end(), [name](const Row& row) { return row.name == name; });
    return found == table.end() ? nullptr : &*found;
}

/// Splits a text without looking at any table; "name" and the options given. Empty with *error set when it
/// is malformed.
std::optional<MethodSpec> parse_spec(std::string_view text, std::string* error);

/// Fills in defaults; false with *error set when an option or a value is unknown.
bool complete_spec(MethodSpec& spec, const std::vector<SpecOption>& options, std::string* error);

/// The shortest text that gives the spec: options at their default are left out.
std::string spec_text(const MethodSpec& spec, const std::vector<SpecOption>& options);

/// "no KIND "name"; there are: a, b, c".
std::string unknown_name(std::string_view kind, std::string_view name,
                         const std::vector<std::string_view>& names);

/// Reads a text against a table whose rows have a name and options.
template <class Row>
std::optional<MethodSpec> parse_spec_of(const std::vector<Row>& table, std::string_view kind,
                                        std::string_view text, std::string* error) {
    auto spec = parse_spec(text, error);
    if (!spec) return {};
    const Row* row = find_named(table, spec->name);
    if (!row) {
        std::vector<std::string_view> names;
        for (const Row& r : table) names.push_back(r.name);
        *error = unknown_name(kind, spec->name, names);
        return {};
    }
    if (!complete_spec(*spec, row->options, error)) return {};
    return spec;
}

}  // namespace trapeze
