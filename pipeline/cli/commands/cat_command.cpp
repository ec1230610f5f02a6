#include <fmt/format.h>

#include <optional>

#include "core/files/output_file.h"
#include "pipeline/cli/commands/commands.h"
#include "pipeline/cli/support/exit_codes.h"
#include "pipeline/cli/support/interrupt.h"
#include "pipeline/cli/support/read_settings.h"
#include "pipeline/cli/support/standard_streams.h"
#include "pipeline/rib/write/cat_rib.h"

namespace trapeze {
namespace {

/// A file that appears when all is written, or standard output, of which main() says what goes wrong.
class CatOutput {
  public:
    explicit CatOutput(const std::string& path) {
        if (!path.empty() && path != "-") file_.emplace(path);
    }
    bool is_file() const { return file_.has_value(); }
    bool open() { return !file_ || file_->open(); }
    void write(std::string_view bytes) {
        if (file_)
            good_ = good_ && file_->write(bytes.data(), bytes.size());
        else
            print_text(bytes);
    }
    bool close() { return !file_ || (good_ && file_->commit()); }
    std::string error() const { return file_ ? file_->error() : std::string(); }

  private:
    std::optional<OutputFile> file_;
    bool good_ = true;
};

}  // namespace

int cat_command(const Arguments& arguments, Terminal& terminal, Diagnostics& diagnostics) {
    const Interrupt interrupt(arguments.time_limit);
    if (!inputs_exist(arguments.inputs, diagnostics)) return kExitNoInput;
    const CatArguments& cat = arguments.cat;
    CatOutput output(arguments.output);
    const auto cannot_write = [&] {
        diagnostics.error({}, fmt::format("cannot write \"{}\": {}", arguments.output, output.error()));
        return kExitNoOutput;
    };
    if (!output.open()) return cannot_write();
    rib::CatOptions options;
    options.encoding = cat.binary ? rib::RibEncoding::Binary : rib::RibEncoding::Ascii;
    options.gzip = cat.gzip || arguments.output.ends_with(".gz");
    options.keep_archives = cat.keep_archives;
    Access access = scene_access(arguments);
    options.access = &access;
    options.max_source_bytes = read_options(arguments, access).max_source_bytes;
    options.cancelled = &interrupt.requested();
    const ReadSummary summary = rib::cat_rib(arguments.inputs, options, diagnostics,
                                             [&](std::string_view bytes) { output.write(bytes); });
    if (interrupt.requested()) return interrupt.exit_code();
    if (!output.close()) return cannot_write();
    if (output.is_file()) terminal.say_on_terminal("wrote " + arguments.output);
    uint64_t requests = 0;
    for (const auto& [name, count] : summary.requests) requests += count;
    terminal.say(fmt::format("{} requests, {} errors, {} warnings", requests,
                             diagnostics.count(Severity::Error), diagnostics.count(Severity::Warning)));
    return diagnostics.count(Severity::Error) > 0 ? kExitErrors : kExitOk;
}

}  // namespace trapeze
