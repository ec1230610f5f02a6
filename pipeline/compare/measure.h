/// What visibility methods cost on the same grids: times of interleaved rounds, counts, bytes. Prints nothing
/// and writes no files.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pipeline/compare/shared_frame.h"
#include "sample/visibility.h"

namespace trapeze {

/// The middle value, or the mean of the two in the middle; 0 of none.
double median(std::vector<double> values);

/// What one method did at one sample rate. Sampling time is what the paper calls so: building what the method
/// needs, and resolving all samples; neither making the samples nor filtering them.
struct MethodResult {
    Sampler sampler;
    std::string method, pattern;  ///< as a user would name them
    SampleRate rate;              ///< of adaptive sampling: at most
    float variance = 0;           ///< that adaptive sampling is to reach; 0: all pixels have all samples
    std::vector<double> build_seconds, resolve_seconds;  ///< wall clock, by round
    /// Of the picture, in which the method fits the memory (frame_parts.h); times and counts are of all.
    size_t parts = 1;
    BuildStats build;    ///< its tree_bytes are of the part that has most
    SampleStats sample;  ///< counts of one round; every round's are the same
    uint64_t hits = 0;   ///< hits found and kept: up to the first opaque one of each sample
    /// Occlusion rays (occlusion_rays.h), where they were asked for and the method takes them, and has no
    /// parts, as they go anywhere: wall clock by round, counts of one round, and how many rays met something.
    std::vector<double> occlusion_seconds;
    SampleStats occlusion;
    uint64_t occluded = 0;
    uint64_t micropolygons = 0;
    uint64_t pixels = 0;        ///< that samples are of
    int tile_side = kTileSide;  ///< pixels

    /// Medians, in seconds; the total is the median of the rounds' sums.
    double build_median() const { return median(build_seconds); }
    double resolve_median() const { return median(resolve_seconds); }
    double occlusion_median() const { return median(occlusion_seconds); }
    double total_median() const;
    /// Least and largest of the rounds' sums of building and resolving, in seconds.
    struct Spread {
        double least = 0, most = 0;
    };
    Spread total_spread() const;

    double samples_per_pixel() const { return ratio(sample.rays, pixels); }
    double samples_per_second() const { return ratio(static_cast<double>(sample.rays), resolve_median()); }
    double tests_per_sample() const { return ratio(sample.predicate_tests, sample.rays); }
    /// Predicate tests for each one that the predicate answers with yes.
    double tests_per_hit() const { return ratio(sample.predicate_tests, sample.predicate_hits); }
    double nodes_per_sample() const { return ratio(sample.nodes_visited, sample.rays); }
    double tests_per_occlusion_ray() const { return ratio(occlusion.predicate_tests, occlusion.rays); }
    double nodes_per_occlusion_ray() const { return ratio(occlusion.nodes_visited, occlusion.rays); }
    double bytes_per_micropolygon() const { return ratio(build.tree_bytes, micropolygons); }

  private:
    std::vector<double> total_seconds() const;  ///< by round
    /// 0 where there is nothing to divide by.
    static double ratio(double a, double b) { return b > 0 ? a / b : 0; }
    static double ratio(uint64_t a, uint64_t b) {
        return ratio(static_cast<double>(a), static_cast<double>(b));
    }
};

/// How much is measured.
struct MeasureSettings {
    int rounds = 3;
    size_t sample_bytes = size_t{2} << 30;         ///< samples made ahead may take this much
    std::function<void(double)> on_progress = {};  ///< part done in [0, 1], after every turn
    /// Above 0: the first sampler that can takes adaptive samples, too, as a row of its own.
    float variance = 0;
    /// A method whose turn took longer, in seconds, takes no other one at that rate: its medians are of fewer
    /// rounds. 0: nothing is too long.
    double longest_turn = 0;
    /// Each turn traces occlusion rays, too, after its samples. They are the same for all methods.
    bool occlusion = false;
};

/// At each sample rate, `rounds` times: every sampler in turn prepares and resolves the whole picture, with
/// the threads of the calling task arena. The results are in the order of the rates, then of the samplers;
/// behind these, adaptive samples, whose time includes making them and deciding where. Empty when cancelled.
std::vector<MethodResult> measure(const SharedFrame& frame, const std::vector<Sampler>& samplers,
                                  const std::vector<SampleRate>& rates, const MeasureSettings& settings);

}  // namespace trapeze
