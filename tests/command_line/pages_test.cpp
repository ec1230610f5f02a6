/// Manual pages and completions: all that --help names is in them, and who reads them has no complaint.
#include <regex>

#include "tests/command_line/command_line_harness.h"

namespace trapeze::testing {
namespace {

using Names = std::vector<std::string>;

bool is_installed(const std::string& program) {
    return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}

/// Of a command line in bash, in a folder.
int status_of(const WorkFolder& folder, const std::string& script, const std::string& arguments) {
    folder.write("script", script);
    const std::string go = "cd '" + folder.path().string() + "' && bash script ";
    return std::system((go + arguments + " >.stdout 2>.stderr").c_str());
}

/// The first words of indented lines that are in a section of a help text.
Names names_in(const std::string& help, const std::string& section) {
    static const std::regex first_word(R"(^  ([^\s]+).*)");
    Names names;
    std::istringstream text(help);
    bool inside = false;
    std::smatch match;
    for (std::string line; std::getline(text, line);) {
        if (!line.starts_with(" ")) inside = line == section;
        if (inside && std::regex_match(line, match, first_word)) names.push_back(match[1]);
    }
    return names;
}

/// "-t" and "--threads" of "-t,--threads" and "--no-color{false}".
Names options_of(const std::string& help) {
    Names options;
    for (const std::string& forms : names_in(help, "Options:")) {
        std::istringstream text(forms.substr(0, forms.find('{')));
        for (std::string name; std::getline(text, name, ',');) options.push_back(name);
    }
    return options;
}

Names commands_of(const WorkFolder& folder) {
    return names_in(run_program(folder, "--help").out, "Subcommands:");
}

/// A page without roff's own marks.
std::string plain(std::string roff) {
    roff = std::regex_replace(roff, std::regex(R"(\\f[BIR]|\\:)"), "");
    return std::regex_replace(roff, std::regex(R"(\\-)"), "-");
}

TEST(CommandLinePages, ManualPagesHaveAllThatHelpHas) {
    const WorkFolder folder;
    const Names commands = commands_of(folder);
    ASSERT_GT(commands.size(), 8u);
    const std::string whole = plain(run_program(folder, "help --man").out);
    for (const std::string& command : commands) {
        EXPECT_NE(whole.find("trapeze-" + command + "(1)"), std::string::npos) << command;
        const std::string page = plain(run_program(folder, "help --man " + command).out);
        EXPECT_TRUE(page.starts_with(".TH TRAPEZE-")) << page.substr(0, 80);
        const Names options = options_of(run_program(folder, command + " --help").out);
        EXPECT_GT(options.size(), 2u) << command;
        for (const std::string& option : options)
            EXPECT_TRUE(std::regex_search(page, std::regex("\n(-., )?" + option + "[ ,\n]")))
                << command << " " << option;
    }
}

TEST(CommandLinePages, ManualPagesAreShownWithoutWarnings) {
    const WorkFolder folder;
    Names commands = commands_of(folder);
    commands.emplace_back("");
    const std::string reader = is_installed("man")      ? "man --warnings -l"
                               : is_installed("mandoc") ? "mandoc -Tlint -Werror"
                                                        : "";
    static const std::regex known(R"(^(\.(TH|SH|TP|BR|br|ad|nh)( .*)?|[^.'].*)$)");
    for (const std::string& command : commands) {
        const std::string page = run_program(folder, "help --man " + command).out;
        folder.write("page.1", page);
        std::istringstream text(page);
        for (std::string line; std::getline(text, line);) EXPECT_TRUE(std::regex_match(line, known)) << line;
        for (const char* section :
             {"\n.SH NAME\n", "\n.SH SYNOPSIS\n", "\n.SH OPTIONS\n", "\n.SH EXIT STATUS\n"})
            EXPECT_NE(page.find(section), std::string::npos) << command << section;
        if (reader.empty()) continue;
        EXPECT_EQ(status_of(folder, "export LC_ALL=C.UTF-8 MANWIDTH=80; " + reader + " page.1", ""), 0);
        EXPECT_EQ(file_text(folder / ".stderr"), "") << command;
    }
}

/// Words that bash offers after a command line; the last one is being written.
std::string offered(const WorkFolder& folder, const std::string& line) {
    const int status = status_of(folder,
                                 "source trapeze.bash || exit 1\n"
                                 "COMP_WORDS=(\"$@\") COMP_CWORD=$(($# - 1))\n"
                                 "_trapeze && echo \" ${COMPREPLY[*]} \"\n",
                                 line);
    EXPECT_EQ(status, 0) << line << file_text(folder / ".stderr");
    EXPECT_EQ(file_text(folder / ".stderr"), "") << line;
    return file_text(folder / ".stdout");
}

TEST(CommandLinePages, BashOffersAllThatHelpHas) {
    const WorkFolder folder;
    folder.write("trapeze.bash", run_program(folder, "help --completions bash").out);
    const std::string first = offered(folder, "trapeze ''");
    for (const std::string& command : commands_of(folder)) {
        EXPECT_NE(first.find(" " + command + " "), std::string::npos) << first;
        const std::string words = offered(folder, "trapeze " + command + " -");
        for (const std::string& option : options_of(run_program(folder, command + " --help").out))
            EXPECT_NE(words.find(" " + option + " "), std::string::npos) << command << " " << option;
    }
    EXPECT_EQ(offered(folder, "trapeze re"), " render \n");
    EXPECT_EQ(offered(folder, "trapeze help ch"), " check \n");
    EXPECT_EQ(offered(folder, "trapeze render --progress j"), " json \n");
    EXPECT_EQ(offered(folder, "trapeze render a.rib --progress = pr"), " prman \n");
    EXPECT_EQ(offered(folder, "trapeze render --sampler rayt"), " raytrace \n");
    EXPECT_EQ(offered(folder, "trapeze a.rib --thr"), " --threads \n") << "render is left out";
    EXPECT_EQ(offered(folder, "trapeze study tab"), " table1 table2 table3 table4 table5 \n");
    EXPECT_EQ(offered(folder, "trapeze render sc"), "  \n") << "files, which bash finds";
}

TEST(CommandLinePages, OtherShellsTakeTheirScripts) {
    const WorkFolder folder;
    const Names commands = commands_of(folder);
    for (const std::string shell : {"zsh", "fish"}) {
        const std::string script = run_program(folder, "help --completions " + shell).out;

        for (const std::string& command : commands)
            for (const std::string& option : options_of(run_program(folder, command + " --help").out)) {
                const std::string name = option.substr(option.find_first_not_of('-'));
                const std::string mark =
                    shell == "zsh" ? option : (option[1] == '-' ? " -l " : " -s ") + name;
                EXPECT_NE(script.find(mark), std::string::npos) << shell << " " << command << " " << option;
            }
        if (!is_installed(shell)) continue;
        folder.write("completion", script);
        EXPECT_EQ(status_of(folder, shell + " -n completion", ""), 0) << file_text(folder / ".stderr");
    }
    EXPECT_EQ(run_program(folder, "help --completions csh").exit_code, 2);
    EXPECT_EQ(run_program(folder, "help --man rendr").exit_code, 2);
}

}  // namespace
}  // namespace trapeze::testing
