#include "pipeline/study/moving_checks.h"

#include <fmt/format.h>

#include <algorithm>

#include "pipeline/compare/value_text.h"

namespace trapeze {
namespace {

using paper::TreeRatios;

/// Ratios that a claim holds up to.
constexpr double kMuchLessTime = .8, kBuildTwice = 2, kFewBytes = 1.5;
/// As far as a gain holds: halfway from what a paper measured to none.
double half_gained(double paper) {
    return .5 * (1 + paper);
}
/// Half of what the paper says that a choice is worth.
constexpr double kHalf = .5;

/// Checks that ratios are at most a limit, with figures as ".85x"; none where the paper has no figure.
class Limits {
  public:
    void at_most(const std::string& claim, double here, double paper, double limit) {
        if (std::isnan(paper)) return;
        const auto text = [](double ratio) { return std::isnan(ratio) ? "-" : number_text(ratio) + "x"; };
        checks_.push_back({fmt::format("{} (at most {}x)", claim, number_text(limit)), text(paper),
                           text(here), here <= limit});
    }
    std::vector<StudyCheck> take() { return std::move(checks_); }

  private:
    std::vector<StudyCheck> checks_;
};

double total(const paper::SequenceCosts& costs) {
    return costs.update + costs.trace;
}

}  // namespace

std::vector<StudyCheck> checks_of_spatial_splits(const std::string& scene, const TreeRatios& here,
                                                 const TreeRatios& paper) {
    Limits limits;
    limits.at_most(scene + ": spatial splits test fewer primitives a ray than interpolated boxes", here.tests,
                   paper.tests, half_gained(paper.tests));
    limits.at_most(scene + ": they render faster", here.time, paper.time, half_gained(paper.time));
    limits.at_most(scene + ": the tree costs less by the surface area heuristic", here.sah, paper.sah,
                   half_gained(paper.sah));
    limits.at_most(scene + ": they are built in less than twice the time", here.build, paper.build,
                   kBuildTwice);
    return limits.take();
}

StudyCheck check_of_naive_clipping(const std::string& scene, const WrongPixels& wrong) {
    return {scene + ": naive clipping loses hits, all else shows the same picture", "hits are lost",
            fmt::format("{} of {} pixels are wrong, {} of any other tree's", wrong.naive, wrong.all,
                        wrong.others),
            wrong.naive > 0 && wrong.others == 0};
}

std::vector<StudyCheck> checks_of_kd_tree(const std::string& scene, const TreeRatios& here,
                                          const TreeRatios& msbvh_here, const TreeRatios& paper,
                                          const TreeRatios& msbvh_of_paper) {
    Limits limits;
    limits.at_most(scene + ": the k-d tree renders much faster than interpolated boxes", here.time,
                   paper.time, kMuchLessTime);
    limits.at_most(scene + ": it renders faster than the MSBVH", here.time / msbvh_here.time,
                   paper.time / msbvh_of_paper.time, 1);
    limits.at_most(scene + ": it is built in less than twice the time", here.build, paper.build, kBuildTwice);
    limits.at_most(scene + ": it needs little more memory", here.bytes, paper.bytes, kFewBytes);
    return limits.take();
}

std::vector<StudyCheck> checks_of_kd_variants(const std::string& scene, const KdVariants& here) {
    const double fewer = 1 - here.tests / std::min(here.tests_at_opening, here.tests_at_closing);
    const double saved = 1 - here.duplicates / here.duplicates_unweighted;
    const auto text = [](double part) { return fmt::format("{:.1f} % fewer", 100 * part); };
    return {{scene + ": planes for the middle of the shutter save tests (at least 6 %)",
             text(paper::kMiddlePlanesSave), text(fewer), fewer >= kHalf * paper::kMiddlePlanesSave},
            {scene + ": the weight by time saves duplicates of what moves across planes (at least 3.5 %)",
             text(paper::kTimeWeightSaves), text(saved), saved >= kHalf * paper::kTimeWeightSaves}};
}

StudyCheck check_of_refitting(const std::string& scene, std::span<const double> refitted,
                              std::span<const double> rebuilt) {
    std::string text;
    bool grows = refitted.size() > 1 && refitted.size() == rebuilt.size();
    double before = 0;
    constexpr size_t kLooks = 4;  // the first frame, the last, and some between
    for (size_t i = 0; grows && i < kLooks; ++i) {
        const size_t frame = i * (refitted.size() - 1) / (kLooks - 1);
        const double ratio = refitted[frame] / rebuilt[frame];
        grows = ratio > before;
        text += fmt::format("{}{}x", text.empty() ? "" : ", ", number_text(ratio));
        before = ratio;
    }
    return {
        scene + ": what refitting costs beside rebuilding, by the surface area heuristic, grows gradually",
        "a curve", text, grows && before > 1};
}

std::vector<StudyCheck> checks_of_updates(const std::string& scene, const paper::SequenceCosts (&here)[3],
                                          const paper::SequenceClaims& report) {
    enum { kAnew, kDynamic, kLoose };
    const auto update = [](const paper::SequenceCosts& costs) { return costs.update; };
    std::vector<StudyCheck> checks;
    const auto check = [&](const std::string& claim, double (*cost)(const paper::SequenceCosts&), size_t row,
                           double least) {
        if (!(least > 0)) return;
        const double of_here = cost(here[kAnew]) / cost(here[row]),
                     of_paper = cost(report.costs[kAnew]) / cost(report.costs[row]);
        checks.push_back({fmt::format("{}: {} (at least {}x)", scene, claim, number_text(least)),
                          number_text(of_paper) + "x", number_text(of_here) + "x", of_here >= least});
    };
    check("updating is faster than inserting all anew", update, kDynamic, report.least_dynamic_update);
    check("the loose tree is made faster than that", update, kLoose, report.least_loose_update);
    check("updated, a frame's total is less", total, kDynamic, report.least_dynamic_total);
    check("loose, a frame's total is less", total, kLoose, report.least_loose_total);
    return checks;
}

}  // namespace trapeze
