#include "pipeline/cli/support/modern_spelling.h"

#include <algorithm>

#include "pipeline/cli/support/arguments.h"

namespace trapeze {
namespace {

bool is_number(const std::string& text) {
    return !text.empty() && text.find_first_not_of("0123456789.+-eE") == std::string::npos;
}

/// Takes the words after args[i] that belong to it.
std::vector<std::string> take(std::vector<std::string>& args, size_t i, size_t count) {
    count = std::min(count, args.size() - i - 1);
    const auto begin = args.begin() + static_cast<std::ptrdiff_t>(i) + 1;
    std::vector<std::string> taken(begin, begin + static_cast<std::ptrdiff_t>(count));
    args.erase(begin, begin + static_cast<std::ptrdiff_t>(count));
    return taken;
}

}  // namespace

std::vector<std::string> modern_spelling(std::vector<std::string> args) {
    for (size_t i = 0; i < args.size(); ++i) {
        std::string& arg = args[i];
        if (arg == "-progress") {
            arg = "--progress=auto";
        } else if (arg == "-Progress") {
            arg = "--progress=prman";
        } else if (arg.starts_with("-t:")) {
            arg = "--threads=" + (arg == "-t:all" ? "0" : arg.substr(3));
        } else if (arg == "-res" || arg == "--res") {
            const auto size = take(args, i, 2);
            args[i] = "--resolution=" + (size.size() == 2 ? size[0] + "x" + size[1] : std::string());
        } else if (arg == "-crop") {
            arg = "--crop";
        } else if (arg == "-recover") {
            take(args, i, 1);
            args.erase(args.begin() + static_cast<std::ptrdiff_t>(i--));
        } else if (arg == "-frames" || arg == "-framelist") {
            const bool pair = i + 2 < args.size() && is_number(args[i + 1]) && is_number(args[i + 2]);
            const auto frames = take(args, i, pair ? 2 : 1);
            args[i] = "--frames=" + (frames.empty() ? std::string()
                                     : pair         ? frames[0] + "-" + frames[1]
                                                    : frames[0]);
        }
    }
    if (!args.empty() && args[0] == "help") {
        args.erase(args.begin());
        args.emplace_back("--help");
    }
    const bool asks_for_program =
        !args.empty() && (args[0] == "--help" || args[0] == "-h" || args[0] == "--version");
    if (!args.empty() && !is_command(args[0]) && !asks_for_program) args.insert(args.begin(), "render");
    return args;
}

}  // namespace trapeze
