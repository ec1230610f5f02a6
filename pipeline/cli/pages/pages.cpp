#include "pipeline/cli/pages/pages.h"

#include "pipeline/cli/pages/completions.h"
#include "pipeline/cli/pages/man_page.h"

namespace trapeze {
namespace {

std::string manual_page(const CommandText& program, const std::string& name, const std::string& version,
                        std::string* problem) {
    if (name.empty()) return man_page(program, version);
    for (const CommandText& command : program.commands)
        if (command.name == name) return man_page(program, command, version);
    *problem = "there is no command \"" + name + "\"";
    return {};
}

std::string completion(const CommandText& program, const std::string& shell, std::string* problem) {
    if (shell == "bash") return bash_completion(program);
    if (shell == "zsh") return zsh_completion(program);
    if (shell == "fish") return fish_completion(program);
    *problem = "--completions: bash, zsh or fish";
    return {};
}

}  // namespace

bool asks_for_page(const std::vector<std::string>& words) {
    return words.size() > 1 && words[0] == "help" && (words[1] == "--man" || words[1] == "--completions");
}

std::string page_for(const std::vector<std::string>& words, const CLI::App& app, const std::string& version,
                     std::string* problem) {
    const CommandText program = table_of(app);
    if (words.size() > 3) {
        *problem = words[1] + " takes one word";
        return {};
    }
    const std::string word = words.size() == 3 ? words[2] : "";
    return words[1] == "--man" ? manual_page(program, word, version, problem)
                               : completion(program, word, problem);
}

}  // namespace trapeze
