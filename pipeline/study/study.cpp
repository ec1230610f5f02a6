#include "pipeline/study/study.h"

#include <chrono>

#include "pipeline/study/studies.h"

namespace trapeze {
namespace {

struct StudyRow {
    std::string_view name, title, about;
    void (*run)(StudyBench& bench, StudyResult& result);
    std::string_view paper =
        "Hou, Qin, Li, Guo, Zhou: Micropolygon Ray Tracing with Defocus and Motion Blur, 2010";
};

constexpr StudyRow kStudies[] = {
    {"table1", "Table 1: effects", "sampling time of the Car with defocus, motion blur, and both",
     study_table1},
    {"table2", "Table 2: sampling time", "four scenes at the reference sample rate", study_table2},
    {"table3", "Table 3: whole frames", "four frames as large as the paper's, from RIB to picture",
     study_table3},
    {"table4", "Table 4: acceleration structures",
     "build and trace time with other bounds, and without each idea", study_table4},
    {"table5", "Table 5: sample rates and shading rates",
     "four scenes from 1x1 to the reference, and with larger micropolygons", study_table5},
    {"fig6", "Figure 6: render quality",
     "errors of the Car's pictures with defocus, with motion blur, and with both, and their structure",
     study_fig6},
    {"fig9", "Figure 9: parametric splits against greedy SAH",
     "relative difference in SAH cost, grid by grid", study_fig9},
    {"fig10", "Figure 10: time against blur",
     "the halberd at motions of 0 to 190 pixels, defocus of 0 to 9.5 times", study_fig10},
    {"growth", "Cost against micropolygons", "the halberd diced ever finer, ray tracing only", study_growth},
    {"msbvh", "Spatial splits for motion blur",
     "interpolated boxes, the MSBVH and others, on hair, a building and falling flakes", study_msbvh,
     "Gruenschloss, Stich, Nawaz, Keller: MSBVH, an efficient acceleration data structure for ray traced motion "
     "blur, 2011"},
    {"mbkd", "A k-d tree for motion blur",
     "the MBKD and its choices beside interpolated boxes and the MSBVH, on the same", study_mbkd,
     "Yang, Liu, Yin, Zhang, Zhou, Wei: k-d tree construction designed for motion blur, 2017"},
    {"dynamic", "Trees updated from frame to frame",
     "sequences of falling flakes, a kitchen, a museum: trees that are updated, refitted, and built anew",
     study_dynamic, "a report on dynamic updates of bounding volume hierarchies, 2006 or later"},
    {"structures", "Which structure is for what",
     "all trees on six scenes, still, moving and out of focus, and on one from few micropolygons to many",
     study_structures,
     "Hou et al. 2010, Gruenschloss et al. 2011, Yang et al. 2017, and the report on dynamic updates"},
};

}  // namespace

std::vector<StudyName> study_names() {
    std::vector<StudyName> names;
    for (const StudyRow& row : kStudies) names.push_back({row.name, row.about});
    return names;
}

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
