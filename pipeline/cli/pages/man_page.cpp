#include "pipeline/cli/pages/man_page.h"

#include <algorithm>
#include <cctype>

namespace trapeze {
namespace {

std::string bold(const std::string& text) {
    return "\\fB" + roff_text(text) + "\\fR";
}

std::string italic(const std::string& text) {
    return "\\fI" + roff_text(text) + "\\fR";
}

std::string in_capitals(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::toupper(c); });
    return text;
}

/// Lines of a text that is indented as paragraphs of their own; the rest flows.
std::string paragraphs(const std::string& text) {
    std::string roff;
    for (size_t begin = 0; begin < text.size();) {
        const size_t end = std::min(text.find('\n', begin), text.size());
        const size_t first = std::min(text.find_first_not_of(' ', begin), end);
        if (first > begin && !roff.empty()) roff += ".br\n";
        roff += roff_text(text.substr(first, end - first)) + "\n";
        begin = end + 1;
    }
    return roff;
}

std::string title(const std::string& name, const std::string& about, const std::string& version) {
    return ".TH " + in_capitals(roff_text(name)) + " 1 \"\" \"Trapeze " + version +
           "\" \"User Commands\"\n.ad l\n.nh\n.SH NAME\n" + roff_text(name) + " \\- " + roff_text(about) +
           "\n";
}

std::string roff_value(const OptionText& option) {
    return option.is_flag() ? "" : " " + italic(option.value);
}

/// An entry of a list: what is written, and below it what it means.
std::string entry(const OptionText& option) {
    std::string names;
    for (const std::string& name : option.names) names += (names.empty() ? "" : ", ") + bold(name);
    std::string text = ".TP\n" + (names.empty() ? italic(option.value) : names + roff_value(option)) + "\n";
    text += paragraphs(option.about);
    const auto add = [&](const std::string& what, const std::string& value) {
        if (!value.empty()) text += ".br\n" + what + roff_text(value) + "\n";
    };
    add("Such as: ", option.example);
    add("In ", option.limits);
    if (option.about.find("one of:") == std::string::npos) add("One of: ", joined(option.choices, ", "));
    add("Default: ", option.by_default);
    return text;
}

std::string options_of(const CommandText& table) {
    std::string text = ".SH OPTIONS\n";
    for (const OptionText& option : table.options) text += entry(option);
    return text;
}

/// "Exit codes: 0 ok; 1 ..." as a list, and what follows its full stop as a section of its own.
std::string footer_of(const CommandText& table) {
    const std::string begin = "Exit codes:";
    if (!table.footer.starts_with(begin))
        return table.footer.empty() ? "" : ".SH NOTES\n" + paragraphs(table.footer);
    const size_t end = std::min(table.footer.find(".\n"), table.footer.size() - 1);
    std::string text = ".SH EXIT STATUS\n";
    for (size_t at = begin.size(); at < end;) {
        const size_t stop = std::min(table.footer.find(';', at), end);
        const size_t code = table.footer.find_first_not_of(" \n", at);
        const size_t space = table.footer.find(' ', code);
        text += ".TP\n" + bold(table.footer.substr(code, space - code)) + "\n" +
                roff_text(table.footer.substr(space + 1, stop - space - 1)) + "\n";
        at = stop + 1;
    }
    if (end + 1 < table.footer.size()) text += ".SH NOTES\n" + paragraphs(table.footer.substr(end + 2));
    return text;
}

std::string page_of(const CommandText& program, const CommandText& command) {
    return program.name + "-" + command.name;
}

}  // namespace

std::string roff_text(std::string_view text) {
    std::string roff;
    for (size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        const bool begins_line = roff.empty() || roff.back() == '\n';
        if (begins_line && (c == '.' || c == '\'')) roff += "\\&";
        switch (c) {
            case '\\':
                roff += "\\e";
                break;
            case '-':
                roff += "\\-";
                break;
            case '\'':
                roff += "\\(aq";
                break;
            case '`':
                roff += "\\(ga";
                break;
            case '^':
                roff += "\\(ha";
                break;
            case '~':
                roff += "\\(ti";
                break;
            default:
                roff += c;
        }
        // Long words, as lists of a method's options, may be broken there.
        if ((c == ',' || c == '|') && i + 1 < text.size() && text[i + 1] != ' ' && text[i + 1] != '\n')
            roff += "\\:";
    }
    return roff;
}

std::string man_page(const CommandText& program, const std::string& version) {
    const std::string about = program.about.substr(0, program.about.find('\n'));
    const size_t colon = about.find(": ");
    std::string text =
        title(program.name, colon == std::string::npos ? about : about.substr(colon + 2), version);
    text += ".SH SYNOPSIS\n" + bold(program.name) + " " + italic("COMMAND") + " [" + italic("OPTIONS") +
            "] ...\n.br\n" + bold(program.name + " help") + " [" + italic("COMMAND") + "]\n";
    text += ".SH DESCRIPTION\n" + paragraphs(program.about) + ".SH COMMANDS\n";
    for (const CommandText& command : program.commands)
        text += ".TP\n" + bold(page_of(program, command)) + "(1)\n" + paragraphs(command.about);
    text += options_of(program) + footer_of(program) + ".SH SEE ALSO\n";
    for (const CommandText& command : program.commands)
        text += ".BR " + roff_text(page_of(program, command)) +
                (&command == &program.commands.back() ? " (1)\n" : " (1),\n");
    return text;
}

std::string man_page(const CommandText& program, const CommandText& command, const std::string& version) {
    std::string text = title(page_of(program, command), command.about, version);
    text += ".SH SYNOPSIS\n" + bold(program.name + " " + command.name) + " [" + italic("OPTIONS") + "]";
    for (const OptionText& word : command.words) text += roff_value(word) + (word.is_list ? "..." : "");
    text +=
        "\n.SH DESCRIPTION\n" + bold(program.name + " " + command.name) + "\n" + paragraphs(command.about);
    for (const OptionText& word : command.words) text += entry(word);
    text += options_of(command) + footer_of(command);
    return text + ".SH SEE ALSO\n.BR " + roff_text(program.name) + " (1)\n";
}

}  // namespace trapeze
