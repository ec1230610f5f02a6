#include "pipeline/cli/pages/completions.h"

namespace trapeze {
namespace {

/// A line of the script: candidates for the word that follows `previous` in a command.
std::string bash_candidates(const std::string& command, const OptionText& option) {
    std::vector<std::string> patterns;
    for (const std::string& name : option.names) patterns.push_back("'" + command + " " + name + "'");
    const std::string head = "        " + joined(patterns, " | ") + ") ";
    if (!option.choices.empty()) return head + "words='" + joined(option.choices, " ") + "' ;;\n";
    return head +
           (option.takes_file() ? "return ;;\n" : "compopt +o default +o bashdefault 2>/dev/null ;;\n");
}

std::string bash_names(const CommandText& table) {
    std::string text;
    for (const OptionText& option : table.options) text += joined(option.names, " ") + " ";
    return text.substr(0, text.size() - 1);
}

}  // namespace

std::string bash_completion(const CommandText& program) {
    std::string values, names, choices, commands;
    for (const CommandText& command : program.commands) {
        commands += command.name + " ";
        names += "            " + command.name + ") words='" + bash_names(command) + "' ;;\n";
        for (const OptionText& option : command.options)
            if (!option.is_flag()) values += bash_candidates(command.name, option);
        for (const OptionText& word : command.words)
            if (!word.choices.empty())
                choices += "            " + command.name + ") words='" + joined(word.choices, " ") + "' ;;\n";
    }
    commands += "help";
    // Without words bash offers files, unless compopt tells it not to.
    return "# Completions of " + program.name + " for bash. Made by `" + program.name +
           " help --completions bash`.\n"
           "_" +
           program.name +
           "() {\n"
           "    local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}\n"
           "    local command=render words=\n"
           "    COMPREPLY=()\n"
           "    [ \"$current\" = = ] && current=\n"
           "    [ \"$previous\" = = ] && previous=${COMP_WORDS[COMP_CWORD - 2]}\n"
           "    case \" " +
           commands +
           " \" in *\" ${COMP_WORDS[1]} \"*) command=${COMP_WORDS[1]} ;; esac\n"
           "    case \"$command $previous\" in\n" +
           values +
           "        *)\n"
           "        if [ \"$COMP_CWORD\" = 1 ]; then\n"
           "            words='" +
           commands +
           "'\n"
           "            [[ $current == -* ]] && words='" +
           bash_names(program) +
           "'\n"
           "        elif [[ $current == -* ]]; then\n"
           "            case $command in\n" +
           names +
           "            esac\n"
           "        else\n"
           "            case $command in\n"
           "            help) words='" +
           commands + "' ;;\n" + choices +
           "            esac\n"
           "        fi ;;\n"
           "    esac\n"
           "    [ -n \"$words\" ] && COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n"
           "    return 0\n"
           "}\n"
           "complete -o bashdefault -o default -F _" +
           program.name + " " + program.name + "\n";
}

}  // namespace trapeze
