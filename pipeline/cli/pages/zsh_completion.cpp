#include <sstream>

#include "core/shell_word.h"
#include "pipeline/cli/pages/completions.h"

namespace trapeze {
namespace {

/// "[TEXT]" of _arguments.
std::string zsh_explanation(const OptionText& option) {
    std::string text = "[";
    for (const char c : brief(option.about)) {
        if (c == '[' || c == ']' || c == '\\') text += '\\';
        text += c;
    }
    return text + "]";
}

/// ":MESSAGE:ACTION" of _arguments, for each value that an option takes.
std::string zsh_value(const OptionText& option) {
    if (option.is_flag()) return {};
    std::string action = option.takes_file() ? "_files" : " ";
    if (!option.choices.empty()) action = "(" + joined(option.choices, " ") + ")";
    std::string text;
    std::istringstream values(option.value);
    for (std::string value; values >> value;) text += ":" + value + ":" + action;
    return text;
}

/// An option as _arguments takes it, such as '(-t --threads)'{-t+,--threads=}'[threads]:N: '.
std::string zsh_option(const OptionText& option) {
    std::vector<std::string> names = option.names;
    for (std::string& name : names)
        if (!option.is_flag()) name += name.starts_with("--") ? "=" : "+";
    const bool repeats = option.about.find("may be repeated") != std::string::npos;
    const std::string forms = names.size() > 1 ? "{" + joined(names, ",") + "}" : names.front();
    return (repeats ? "'*'" : "'(" + joined(option.names, " ") + ")'") + forms +
           shell_word(zsh_explanation(option) + zsh_value(option));
}

}  // namespace

std::string zsh_completion(const CommandText& program) {
    std::string commands, cases;
    for (const CommandText& command : program.commands) {
        commands += "        " + shell_word(command.name + ":" + brief(command.about)) + "\n";
        cases += "    " + command.name + ")\n        _arguments -s";
        for (const OptionText& option : command.options) cases += " \\\n            " + zsh_option(option);
        for (const OptionText& word : command.words)
            cases += " \\\n            " + shell_word((word.is_list ? "*" : "1") + zsh_value(word));
        cases += " ;;\n";
    }
    return "#compdef " + program.name + "\n# Completions for zsh. Made by `" + program.name +
           " help --completions zsh`.\n"
           "_" +
           program.name +
           "() {\n"
           "    local -a commands\n"
           "    commands=(\n" +
           commands +
           "        'help:says how to use a command'\n"
           "    )\n"
           "    if (( CURRENT == 2 )); then\n"
           "        _describe command commands\n"
           "        _files\n"
           "        return\n"
           "    fi\n"
           "    (( ${commands[(I)${(b)words[2]}:*]} )) || words[2,1]=(render) CURRENT=$(( CURRENT + 1 ))\n"
           "    shift words\n"
           "    (( CURRENT-- ))\n"
           "    case $words[1] in\n" +
           cases +
           "    help) _describe command commands ;;\n"
           "    esac\n"
           "}\n"
           "_" +
           program.name + " \"$@\"\n";
}

}  // namespace trapeze
