#include "pipeline/compare/record/replay.h"

#include <algorithm>
#include <array>

#include "sample/visibility.h"

namespace trapeze {
namespace {

/// Not in the order of the file: ordered_json copies what is nested, however deep, as it grows.
using Value = nlohmann::json;

/// Fields that are of the run and not of what it found, or that follow from times; others whose name has
/// "seconds" in it are times, too. Peaks are counted in pages of the process. Grids' memory is in chunks of
/// each thread, and their number a matter of which thread comes first.
constexpr std::array<std::string_view, 11> kNotCompared = {"program",
                                                           "scenes",
                                                           "command",
                                                           "options",
                                                           "inputs",
                                                           "machine",
                                                           "verdict",
                                                           "ratio_to_baseline",
                                                           "samples_per_second",
                                                           "grid_bytes",
                                                           "build_peak_bytes"};

bool is_compared(const std::string& field) {
    return std::ranges::find(kNotCompared, field) == kNotCompared.end() &&
           field.find("seconds") == std::string::npos;
}

/// Whether a row of results is of a method that another library has: what memory it takes is a matter of its
/// threads.
bool is_of_another_library(const Value& row) {
    if (!row.contains("method") || !row["method"].is_string()) return false;
    const std::string method = row["method"].get<std::string>();
    const VisibilityMethod* const known =
        find_named(visibility_methods(), std::string_view(method).substr(0, method.find(':')));
    return known && !known->is_exact;
}

/// "interval at 4x4: " of a row of results.
std::string row_name(const Value& row) {
    if (!row.is_object() || !row.contains("method") || !row["method"].is_string()) return {};
    std::string name = row["method"].get<std::string>();
    if (row.contains("samples_x") && row.contains("samples_y"))
        name += " at " + row["samples_x"].dump() + "x" + row["samples_y"].dump();
    return name + ": ";
}

/// Walks two values side by side. Only what both have is walked into, so that what is read from a file is
/// walked no deeper than what the program has made.
class Walk {
  public:
    explicit Walk(ReplayOutcome& outcome) : outcome_(outcome) {}

    void compare(const Value& was, const Value& is, const std::string& row, const std::string& field) {
        if (was.is_object() && is.is_object()) return compare_objects(was, is, row, field);
        if (was.is_array() && is.is_array()) return compare_arrays(was, is, row, field);
        ++outcome_.compared;
        if (was != is) differs(row, field, short_text(was), short_text(is));
    }

  private:
    void compare_objects(const Value& was, const Value& is, const std::string& row,
                         const std::string& field) {
        const std::string before = field.empty() ? "" : field + ".";
        const bool foreign = is_of_another_library(is);
        for (const auto& [name, value] : is.items()) {
            if (!is_compared(name) || (foreign && name.find("bytes") != std::string::npos)) continue;
            if (const auto found = was.find(name); found != was.end())
                compare(*found, value, row, before + name);
            else
                differs(row, before + name, "not there", short_text(value));
        }
        for (const auto& [name, value] : was.items())
            if (is_compared(name) && !is.contains(name))
                differs(row, before + name, short_text(value), "not there");
    }
    void compare_arrays(const Value& was, const Value& is, const std::string& row, const std::string& field) {
        if (was.size() != is.size())
            differs(row, field, std::to_string(was.size()) + " values", std::to_string(is.size()));
        for (size_t i = 0; i < std::min(was.size(), is.size()); ++i) {
            const std::string name = row_name(is[i]);
            compare(was[i], is[i], name.empty() ? row : name,
                    name.empty() ? field + "[" + std::to_string(i) + "]" : "");
        }
    }
    void differs(const std::string& row, const std::string& field, const std::string& was,
                 const std::string& is) {
        outcome_.differences.push_back(row + "\"" + field + "\" was " + was + ", is " + is);
    }
    /// Values that are long, or deep, are not shown.
    static std::string short_text(const Value& value) {
        if (value.is_structured()) return value.is_array() ? "a list" : "an object";
        constexpr size_t kMost = 120;
        const std::string text = value.dump(-1, ' ', false, Value::error_handler_t::replace);
        return text.size() <= kMost ? text : text.substr(0, kMost) + "...";
    }

    ReplayOutcome& outcome_;
};

/// Strings of an array; empty optional where it is anything else.
std::optional<std::vector<std::string>> strings_of(const Value& value) {
    if (!value.is_array()) return {};
    std::vector<std::string> strings;
    for (const Value& one : value) {
        if (!one.is_string()) return {};
        strings.push_back(one.get<std::string>());
    }
    return strings;
}

std::optional<std::vector<RecordedOption>> options_of(const Value& value) {
    if (!value.is_object()) return {};
    std::vector<RecordedOption> options;
    for (const auto& [name, given] : value.items()) {
        RecordedOption& option = options.emplace_back();
        option.name = name;
        if (given.is_boolean() && given.get<bool>()) continue;
        if (given.is_string()) {
            option.values = {given.get<std::string>()};
            continue;
        }
        const auto values = strings_of(given);
        if (!values || values->empty()) return {};
        option.values = *values;
    }
    return options;
}

std::optional<std::vector<InputFile>> inputs_of(const Value& value) {
    if (!value.is_array()) return {};
    std::vector<InputFile> inputs;
    for (const Value& one : value) {
        for (const char* field : {"name", "bytes", "sha256"})
            if (!one.is_object() || !one.contains(field)) return {};
        const Value &name = one["name"], &bytes = one["bytes"], &hash = one["sha256"];
        if (!name.is_string() || !bytes.is_number_unsigned() || (!hash.is_string() && !hash.is_null()))
            return {};
        inputs.push_back({name.get<std::string>(), bytes.get<uint64_t>(),
                          hash.is_null() ? std::string() : hash.get<std::string>()});
    }
    return inputs;
}

/// The first of the fields that a JSON of compare always has and this one has not, or has as something else.
std::string missing_field(const Value& whole) {
    if (!whole["results"].is_array()) return "results";
    if (!whole["machine"].is_object() || !whole["machine"].contains("trapeze") ||
        !whole["machine"]["trapeze"].is_string())
        return "machine";
    const auto scenes = strings_of(whole["scenes"]);
    if (!scenes || scenes->empty()) return "scenes";
    if (!options_of(whole["options"])) return "options";
    if (!inputs_of(whole["inputs"])) return "inputs";
    return {};
}

}  // namespace

std::optional<RecordedComparison> read_recorded(std::string_view text, std::string* error) {
    RecordedComparison recorded;
    Value& whole = recorded.whole;
    try {
        whole = Value::parse(text);
    } catch (const Value::parse_error& problem) {
        *error = "it is no JSON from byte " + std::to_string(problem.byte) + " on";
        return {};
    }
    if (!whole.is_object() || !whole.contains("program") || whole["program"] != kCompareProgram) {
        *error = "it was not written by `trapeze compare --json`";
        return {};
    }
    for (const char* field : {"results", "machine", "scenes", "options", "inputs"})
        if (!whole.contains(field)) whole[field] = nullptr;
    if (const std::string missing = missing_field(whole); !missing.empty()) {
        *error = "\"" + missing + "\" is not there, or not what `trapeze compare --json` writes";
        return {};
    }
    recorded.scenes = *strings_of(whole["scenes"]);
    recorded.options = *options_of(whole["options"]);
    recorded.inputs = *inputs_of(whole["inputs"]);
    recorded.version = whole["machine"]["trapeze"].get<std::string>();
    return recorded;
}

ReplayOutcome compare_figures(const Value& recorded, const Value& now) {
    ReplayOutcome outcome;
    Walk(outcome).compare(recorded, now, {}, {});
    return outcome;
}

std::vector<std::string> changed_inputs(const std::vector<InputFile>& recorded,
                                        const std::vector<InputFile>& now) {
    const auto find = [](const std::vector<InputFile>& files, const std::string& name) {
        return std::ranges::find(files, name, &InputFile::name);
    };
    std::vector<std::string> sentences;
    for (const InputFile& was : recorded) {
        const auto is = find(now, was.name);
        if (is == now.end())
            sentences.push_back("\"" + was.name + "\" was read then, and is not read now");
        else if (was.sha256.empty() || is->sha256.empty())
            sentences.push_back("\"" + was.name + "\" cannot be held against what was read then: it " +
                                (was.sha256.empty() ? "was" : "is") + " no regular file");
        else if (was.sha256 != is->sha256)
            sentences.push_back("\"" + was.name + "\" has changed: its SHA-256 was " + was.sha256 + ", is " +
                                is->sha256);
    }
    for (const InputFile& is : now)
        if (find(recorded, is.name) == recorded.end())
            sentences.push_back("\"" + is.name + "\" is read now, and was not read then");
    return sentences;
}

}  // namespace trapeze
