#include "pipeline/compare/report/html_page.h"

#include <fmt/format.h>

#include "pipeline/compare/report/encoded_text.h"

namespace trapeze {

extern const char* const kReportStyle;  // report.css, embedded by CMake

std::string html_head(const std::string& title) {
    // The policy keeps the promise that nothing is loaded from anywhere.
    return fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<meta name=\"color-scheme\" content=\"light dark\">\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
        "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n"
        "<title>{}</title>\n<style>\n{}</style>\n</head>\n<body>\n",
        escaped(title), kReportStyle);
}

std::string html_fact(const std::string& value, const std::string& name) {
    return fmt::format("<div><strong>{}</strong><span>{}</span></div>\n", escaped(value), escaped(name));
}

std::string html_entry(const std::string& name, const std::string& value) {
    return fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", escaped(name), escaped(value));
}

std::string html_machine(const Machine& machine) {
    return html_entry("Processor", machine.cpu) + html_entry("Threads", std::to_string(machine.threads)) +
           html_entry("Vector instructions", machine.simd) + html_entry("System", machine.system) +
           html_entry("Compiler", machine.compiler) +
           html_entry("Trapeze", machine.trapeze + " (" + machine.revision + ")");
}

}  // namespace trapeze
