#include "pipeline/cli/pages/command_table.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>

namespace trapeze {
namespace {

/// The part of `text` before the first `mark`, and the rest after it.
std::pair<std::string, std::string> parted(const std::string& text, const std::string& mark) {
    const size_t at = text.find(mark);
    if (at == std::string::npos) return {text, {}};
    return {text.substr(0, at), text.substr(at + mark.size())};
}

/// The members of CLI11's "{a,b,c}".
std::vector<std::string> members_of(const std::string& set) {
    std::vector<std::string> members;
    std::istringstream text(set.substr(1, set.size() - 2));
    for (std::string member; std::getline(text, member, ',');) members.push_back(member);
    return members;
}

/// The names in a help text that ends with "one of: raytrace:tree=wide|paper bruteforce".
std::vector<std::string> named_in(const std::string& about) {
    std::vector<std::string> names;
    std::istringstream text(parted(about, "one of:").second);
    for (std::string word; text >> word;) names.push_back(parted(word, ":").first);
    return names;
}

/// CLI11 writes what it knows of a value as "FORM:LIMITS".
void describe_value(const CLI::Option& option, OptionText& text) {
    const auto [form, limits] = parted(option.get_type_name(), ":");
    std::tie(text.value, text.example) = parted(form, " like ");
    if (limits.starts_with("{"))
        text.choices = members_of(limits);
    else
        text.limits = parted(limits, "in ").second;
    if (text.choices.empty()) text.choices = named_in(text.about);
    text.by_default = option.get_default_str();
}

/// What the parser knows of an option, as a value.
OptionText text_of(const CLI::Option& option) {
    OptionText text;
    for (const std::string& name : option.get_snames()) text.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) text.names.push_back("--" + name);
    text.about = option.get_description();
    text.is_required = option.get_required();
    text.is_list = option.get_expected_max() == CLI::detail::expected_max_vector_size;
    if (option.get_type_size() != 0) describe_value(option, text);
    return text;
}

}  // namespace

bool OptionText::takes_file() const {
    return std::ranges::any_of(std::initializer_list<const char*>{"FILE", "SCENE", "TILE", "DIR"},
                               [&](const char* form) { return value.starts_with(form); });
}

CommandText table_of(const CLI::App& app) {
    CommandText table;
    table.name = app.get_name();
    table.about = app.get_description();
    table.footer = app.get_footer();
    for (const CLI::Option* option : app.get_options())
        if (!option->get_group().empty())
            (option->get_positional() ? table.words : table.options).push_back(text_of(*option));
    for (const CLI::App* command : app.get_subcommands(nullptr)) table.commands.push_back(table_of(*command));
    return table;
}

std::string brief(const std::string& about) {
    size_t end = about.size();
    for (const char* mark : {";", ", one of:", " (", "\n", ": "}) end = std::min(end, about.find(mark));
    return about.substr(0, end);
}

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
    return text;
}

}  // namespace trapeze
