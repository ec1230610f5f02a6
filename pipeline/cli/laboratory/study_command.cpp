#include <fmt/format.h>

#include "composite/displays/write_displays.h"
#include "pipeline/cli/laboratory/laboratory.h"
#include "pipeline/cli/support/exit_codes.h"
#include "pipeline/cli/support/interrupt.h"
#include "pipeline/cli/support/on_threads.h"
#include "pipeline/cli/support/revision.h"
#include "pipeline/cli/support/text_files.h"
#include "pipeline/compare/shared_frame.h"
#include "pipeline/frame/json_text.h"
#include "pipeline/frame/version.h"
#include "pipeline/study/report/study_report.h"
#include "pipeline/study/study.h"

namespace trapeze {
namespace {

/// What the study's figures follow from.
std::vector<RecordedOption> study_options(const Arguments& arguments) {
    std::vector<RecordedOption> options = {{"repeat", {std::to_string(arguments.study.rounds)}}};
    if (arguments.study.quick) options.push_back({"quick", {}});
    if (!arguments.study.scenes.empty()) options.push_back({"scenes", arguments.study.scenes});
    if (!arguments.study.bart.empty()) options.push_back({"bart", {arguments.study.bart}});
    return options;
}

std::optional<StudyResult> run(const Arguments& arguments, const Interrupt& interrupt, Terminal& terminal,
                               Diagnostics& diagnostics) {
    StudySettings settings;
    settings.quick = arguments.study.quick;
    settings.rounds = arguments.study.rounds;
    settings.memory_bytes = arguments.memory_bytes;
    settings.scenes = arguments.study.scenes;
    settings.bart_folder = arguments.study.bart;
    settings.cancelled = &interrupt.requested();
    settings.on_stage = [&](const std::string& what) {
        terminal.begin_progress(what, {arguments.study.name, what});
    };
    settings.on_progress = [&](double part) { terminal.progress(part); };
    settings.on_figure = [&](const std::string& line) { terminal.say(line); };
    std::optional<StudyResult> result;
    on_threads(arguments.threads, [&] { result = run_study(arguments.study.name, settings, diagnostics); });
    terminal.end_progress();
    return result;
}

}  // namespace

int study_command(const Arguments& arguments, Terminal& terminal, Diagnostics& diagnostics) {
    const StudyArguments& study = arguments.study;
    if (!can_write({study.report, study.json, study.csv}, diagnostics)) return kExitNoOutput;
    const Interrupt interrupt;
    auto result = run(arguments, interrupt, terminal, diagnostics);
    if (interrupt.requested()) return interrupt.exit_code();
    if (!result)
        return diagnostics.kinds().contains(kNoSuchScene)       ? kExitUsage
               : diagnostics.kinds().contains(kTooLittleMemory) ? kExitNoMemory
                                                                : kExitInternal;
    result->machine.trapeze = kVersion, result->machine.revision = revision();
    result->command = arguments.words;
    result->options = study_options(arguments);
    fmt::print("{}", study_text(*result));
    bool good = true;
    if (!study.json.empty())
        good = write_text(study.json, json_text(study_json(*result)) + "\n", terminal, diagnostics) && good;
    if (!study.csv.empty()) good = write_text(study.csv, study_csv(*result), terminal, diagnostics) && good;
    if (!study.report.empty())
        good = write_text(study.report, study_html(*result), terminal, diagnostics) && good;
    return good ? kExitOk : kExitNoOutput;
}

}  // namespace trapeze
