#include "pipeline/cli/pages/completions.h"

namespace trapeze {
namespace {

std::string fish_quoted(const std::string& text) {
    std::string quoted = "'";
    for (const char c : text) quoted += (c == '\'' || c == '\\' ? "\\" : "") + std::string(1, c);
    return quoted + "'";
}

std::string fish_choices(const OptionText& option) {
    if (option.choices.empty()) return option.takes_file() ? " -r -F" : " -x";
    return " -x -a " + fish_quoted(joined(option.choices, " "));
}

std::string fish_option(const std::string& begin, const OptionText& option) {
    std::string line = begin;
    for (const std::string& name : option.names)
        line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    return line + (option.is_flag() ? "" : fish_choices(option)) + " -d " + fish_quoted(brief(option.about)) +
           "\n";
}

}  // namespace

std::string fish_completion(const CommandText& program) {
    const std::string begin = "complete -c " + program.name + " -n ";
    const std::string first = begin + "__fish_use_subcommand";
    std::string text = "# Completions of " + program.name + " for fish. Made by `" + program.name +
                       " help --completions fish`.\n";
    std::vector<std::string> names;
    for (const OptionText& option : program.options) text += fish_option(first, option);
    for (const CommandText& command : program.commands) {
        names.push_back(command.name);
        text += first + " -a " + command.name + " -d " + fish_quoted(brief(command.about)) + "\n";
        const std::string within = begin + "'__fish_seen_subcommand_from " + command.name + "'";
        for (const OptionText& option : command.options) text += fish_option(within, option);
        for (const OptionText& word : command.words)
            if (!word.choices.empty()) text += within + " -f" + fish_choices(word) + "\n";
    }
    text += first + " -a help -d 'says how to use a command'\n";
    return text + begin + "'__fish_seen_subcommand_from help' -f -a " + fish_quoted(joined(names, " ")) +
           "\n";
}

}  // namespace trapeze
