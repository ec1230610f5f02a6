#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "composite/output_file.h"
#include "composite/write_displays.h"
#include "pipeline/cli/commands.h"
#include "pipeline/cli/exit_codes.h"
#include "pipeline/cli/interrupt.h"
#include "pipeline/cli/version.h"
#include "pipeline/compare/shared_frame.h"
#include "pipeline/study/report/study_report.h"
#include "pipeline/study/study.h"

namespace trapeze {
namespace {

/// Reports what cannot be written.
bool write_file(const std::string& path, const std::string& text, Diagnostics& diagnostics) {
    OutputFile file(path);
    if (file.open() && file.write(text.data(), text.size()) && file.commit()) return true;
    diagnostics.error({}, fmt::format("cannot write \"{}\": {}", path, file.error()));
    return false;
}

/// Before an hour is spent on figures that cannot be written.
bool outputs_are_possible(const StudyArguments& study, Diagnostics& diagnostics) {
    for (const std::string& path : {study.report, study.json}) {
        if (path.empty()) continue;
        OutputFile file(path);
        if (file.open()) continue;
        diagnostics.error({}, fmt::format("cannot write \"{}\": {}", path, file.error()));
        return false;
    }
    return true;
}

std::optional<StudyResult> run(const Arguments& arguments, const Interrupt& interrupt, Terminal& terminal,
                               Diagnostics& diagnostics) {
    StudySettings settings;
    settings.quick = arguments.study.quick;
    settings.rounds = arguments.study.rounds;
    settings.memory_bytes = arguments.memory_bytes;
    settings.cancelled = &interrupt.requested();
    settings.on_stage = [&](const std::string& what) { terminal.begin_progress(what); };
    settings.on_progress = [&](double part) { terminal.progress(part); };
    const int threads = thread_count(arguments.threads);
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<size_t>(threads));
    tbb::task_arena arena(threads);
    std::optional<StudyResult> result;
    arena.execute([&] { result = run_study(arguments.study.name, settings, diagnostics); });
    terminal.end_progress();
    return result;
}

}  // namespace

int study_command(const Arguments& arguments, Terminal& terminal, Diagnostics& diagnostics) {
    const StudyArguments& study = arguments.study;
    if (!outputs_are_possible(study, diagnostics)) return kExitNoOutput;
    const Interrupt interrupt(remove_partial_outputs);
    auto result = run(arguments, interrupt, terminal, diagnostics);
    if (interrupt.requested()) return interrupt.exit_code();
    if (!result) return diagnostics.kinds().contains(kTooLittleMemory) ? kExitNoMemory : kExitInternal;
    result->machine.trapeze = kVersion;
    fmt::print("{}", study_text(*result));
    bool good = true;
    if (!study.json.empty())
        good = write_file(study.json, study_json(*result).dump(2) + "\n", diagnostics) && good;
    if (!study.report.empty()) good = write_file(study.report, study_html(*result), diagnostics) && good;
    return good ? kExitOk : kExitNoOutput;
}

}  // namespace trapeze
