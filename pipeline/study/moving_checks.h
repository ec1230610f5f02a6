/// What papers on trees for what moves claim of them, as checks.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "pipeline/study/moving_figures.h"
#include "pipeline/study/study_result.h"

namespace trapeze {

/// Checks what spatial splits gain and cost beside interpolated boxes.
std::vector<StudyCheck> checks_of_spatial_splits(const std::string& scene, const paper::TreeRatios& here,
                                                 const paper::TreeRatios& paper);

/// Pixels of a picture that are not as they should be.
struct WrongPixels {
    size_t naive, others;  ///< with naive clipping, and with whatever tree has most
    size_t all;
};
/// Checks that naive clipping loses hits, and that no other form does [Gruenschloss11 figure 3].
StudyCheck check_of_naive_clipping(const std::string& scene, const WrongPixels& wrong);

/// Checks what a k-d tree gains and costs beside interpolated boxes, and whether it renders faster than the
/// MSBVH.
std::vector<StudyCheck> checks_of_kd_tree(const std::string& scene, const paper::TreeRatios& here,
                                          const paper::TreeRatios& msbvh_here, const paper::TreeRatios& paper,
                                          const paper::TreeRatios& msbvh_of_paper);

/// A k-d tree's figures with one choice made otherwise.
struct KdVariants {
    double tests, tests_at_opening, tests_at_closing;  ///< a ray, with planes for the middle, and the ends
    double duplicates, duplicates_unweighted;          ///< of what moves across planes
};
/// Checks that planes for the middle of the shutter, and the weight by time, are worth what the paper says.
std::vector<StudyCheck> checks_of_kd_variants(const std::string& scene, const KdVariants& here);

/// Checks that a tree that is refitted from frame to frame becomes worse beside one that is built anew: costs
/// by the surface area heuristic, a frame [Gruenschloss11 figure 5].
StudyCheck check_of_refitting(const std::string& scene, std::span<const double> refitted,
                              std::span<const double> rebuilt);

/// Checks what updates gain over inserting all anew each frame. Costs are in the order of the report's.
std::vector<StudyCheck> checks_of_updates(const std::string& scene, const paper::SequenceCosts (&here)[3],
                                          const paper::SequenceClaims& report);

}  // namespace trapeze
