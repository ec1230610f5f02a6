/// Figure 6: what the methods' pictures are like with defocus, with motion blur, and with both [Hou10
/// sec. 5.1].
#include <fmt/format.h>

#include "pipeline/compare/comparison.h"
#include "pipeline/compare/error_structure.h"
#include "pipeline/compare/report/worst_places.h"
#include "pipeline/compare/value_text.h"
#include "pipeline/study/paper_figures.h"
#include "pipeline/study/shape_checks.h"
#include "pipeline/study/studies.h"
#include "pipeline/study/study_scenes.h"

namespace trapeze {
namespace {

constexpr const char* kEffects[] = {"defocus", "motion blur", "both"};
/// Blocks that errors are averaged over: as large as the largest tile of INTERLEAVEUVT here, twice over.
constexpr int kBlockSide = 8;
/// Close-ups of an effect, and the pixels of their sides.
constexpr size_t kCloseUps = 2;
constexpr int kCloseUpSide = 64;

SampleRate rate_of_references(const StudyBench& bench) {
    return bench.quick() ? SampleRate{16, 16} : SampleRate{32, 32};
}

Image reference_of(const StudyBench& bench, const SharedFrame& frame, const std::string& label) {
    bench.stage("reference of " + label);
    auto reference = make_reference(frame, rate_of_references(bench).x, bench.on_progress());
    if (!reference) throw StudyStopped();
    return std::move(*reference);
}

/// The methods' pictures, in the order of paper::kMethods.
std::vector<Image> pictures_of(const StudyBench& bench, const SharedFrame& frame, const std::string& label) {
    std::vector<Image> pictures;
    for (const std::string_view method : paper::kMethods) {
        bench.stage(fmt::format("{}: {}", label, method));
        std::string error;
        const auto sampler = choose_sampler(method, "", &error);
        auto picture = make_picture(frame, sampler.value(), bench.reference_rate(), bench.on_progress());
        if (!picture) throw StudyStopped();
        pictures.push_back(std::move(picture->image));
    }
    return pictures;
}

/// The same places of the reference and of all pictures: where means over blocks differ most, of whatever
/// picture.
void add_close_ups(StudyResult& result, const std::string& effect, const Image& reference,
                   const std::vector<Image>& pictures) {
    std::vector<Image> means;
    for (const Image& picture : pictures) means.push_back(block_means(picture, kBlockSide));
    std::vector<const Image*> judged;
    for (const Image& picture : means) judged.push_back(&picture);
    for (const PixelRect& place :
         worst_places(block_means(reference, kBlockSide), judged, kCloseUpSide, kCloseUps)) {
        StudyCloseUps& row = result.close_ups.emplace_back();
        row.title = fmt::format("{}: x {} to {}, y {} to {}", effect, place.x0, place.x1, place.y0, place.y1);
        row.about = "Where means over some pixels are farthest from the reference.";
        row.pictures.emplace_back("reference", part_of(reference, place));
        for (size_t m = 0; m < pictures.size(); ++m)
            row.pictures.emplace_back(paper::kMethods[m], part_of(pictures[m], place));
    }
}

/// Figures by method, then by effect.
using Figures = std::vector<std::vector<double>>;

StudyTable table_of(const std::string& title, const Figures& figures) {
    StudyTable table{title, {"method", kEffects[0], kEffects[1], kEffects[2]}, {}};
    for (size_t m = 0; m < figures.size(); ++m) {
        auto& row = table.rows.emplace_back(1, std::string(paper::kMethods[m]));
        for (const double figure : figures[m]) row.push_back(number_text(figure));
    }
    return table;
}

}  // namespace

void study_fig6(StudyBench& bench, StudyResult& result) {
    result.notes.push_back(fmt::format(
        "At {} samples a pixel; references have {} stratified ones, ray traced with other random numbers. "
        "Times are table 1's.",
        rate_text(bench.reference_rate()), rate_text(rate_of_references(bench))));
    result.notes.push_back(fmt::format(
        "Pixels that err as one: how many times the mean squared error of means over {}x{} pixels is what it "
        "would be were every pixel's error its own. The filter, which is wider than a pixel, adds to all rows.",
        kBlockSide, kBlockSide));
    Figures rmse(paper::kMethods.size()), together(paper::kMethods.size());
    for (size_t effect = 0; effect < std::size(kEffects); ++effect) {
        const StudyScene scene = car_scene_with(bench, effect != 0, effect != 1);
        const SharedFrame frame = bench.frame(scene);
        const Image reference = reference_of(bench, frame, scene.label);
        const std::vector<Image> pictures = pictures_of(bench, frame, scene.label);
        for (size_t m = 0; m < pictures.size(); ++m) {
            const PictureError error = picture_error(pictures[m], reference, kBlockSide);
            rmse[m].push_back(error.rmse), together[m].push_back(error.pixels_together);
            result.figures.push_back({{"scene", scene_command_line(scene)},
                                      {"stands_for", scene.label},
                                      {"method", paper::kMethods[m]},
                                      {"samples", rate_text(bench.reference_rate())},
                                      {"rmse", error.rmse},
                                      {"pixels_together", error.pixels_together}});
        }
        add_close_ups(result, kEffects[effect], reference, pictures);
    }
    result.tables.push_back(table_of("Root mean square difference to the reference", rmse));
    result.tables.push_back(table_of("Pixels that err as one, of a block's 64", together));
    result.checks = checks_of_structure(rmse, together);
}

}  // namespace trapeze
