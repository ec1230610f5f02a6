/// The table of commands and options behind `--help`, as values for manual pages and completions.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace trapeze {

/// An option, or a word that stands for a file or a name.
struct OptionText {
    std::vector<std::string> names;    ///< "-t", "--threads"; none: a word by its place
    std::string value;                 ///< what --help puts for the value, such as "N"; empty: a flag
    std::string example;               ///< of a value, as "1-10,20"; may be empty
    std::string limits;                ///< of a value, as "[1, 64]"; may be empty
    std::vector<std::string> choices;  ///< the values there are, where they are few
    std::string by_default;            ///< may be empty
    std::string about;
    bool is_required = false, is_list = false;

    bool is_flag() const { return value.empty(); }
    /// Whether the value names a file or a folder.
    bool takes_file() const;
};

/// A command, or the whole program.
struct CommandText {
    std::string name;  ///< of the program, for the whole table
    std::string about, footer;
    std::vector<OptionText> words, options;  ///< arguments by place, and options by name
    std::vector<CommandText> commands;       ///< of the program; a command has none
};

/// The table of a program or of one command, made from the parser. Options that --help hides are left out.
CommandText table_of(const CLI::App& app);

/// The first words of a help text, as a shell shows them beside a name.
std::string brief(const std::string& about);

/// `words` with `separator` between them.
std::string joined(const std::vector<std::string>& words, const std::string& separator);

}  // namespace trapeze
