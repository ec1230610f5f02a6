#include "pipeline/study/study.h"

#include <chrono>

#include "pipeline/study/studies.h"

namespace trapeze {
namespace {

struct StudyRow {
    std::string_view name, title, paper;
    void (*run)(StudyBench& bench, StudyResult& result);
};

constexpr std::string_view kHou2010 =
    "Hou, Qin, Li, Guo, Zhou: Micropolygon Ray Tracing with Defocus and Motion Blur, 2010";

constexpr StudyRow kStudies[] = {
#define TRAPEZE_STUDY(name, title, about, paper) {#name, title, paper, study_##name},
#include "pipeline/study/studies.def"
#undef TRAPEZE_STUDY
};

}  // namespace

std::optional<StudyResult> run_study(std::string_view name, const StudySettings& settings,
                                     Diagnostics& diagnostics) {
    for (const StudyRow& row : kStudies) {
        if (row.name != name) continue;
        StudyResult result;
        result.name = row.name, result.title = row.title, result.paper = row.paper;
        result.machine = this_machine();
        result.quick = settings.quick, result.rounds = settings.rounds;
        const auto start = std::chrono::steady_clock::now();
        try {
            StudyBench bench(settings, diagnostics, result);
            row.run(bench, result);
        } catch (const StudyStopped&) {
            return {};
        }
        result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        return result;
    }
    return {};
}

}  // namespace trapeze
