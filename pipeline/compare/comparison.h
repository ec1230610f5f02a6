/// All that there is to say about visibility methods on one frame: a value for the terminal's table, the JSON
/// and the HTML report.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/checkpoint/run_record.h"
#include "pipeline/compare/blur.h"
#include "pipeline/compare/machine.h"
#include "pipeline/compare/measure.h"
#include "pipeline/compare/pictures.h"

namespace trapeze {

/// A method at a sample rate.
struct ComparedMethod {
    MethodResult result;
    double ratio = 0;  ///< of its median total to the baseline's at the same rate
    double rmse = 0;   ///< root mean square difference to the reference, linear light
    double flip = 0;   ///< flip_difference() to the reference, as the report shows both
    MethodPicture picture;
};

/// The figures and pictures of all methods on one frame.
struct Comparison {
    std::string scene;                 ///< as the user named it
    std::vector<std::string> command;  ///< the command line's words, without the program's name
    uint32_t seed = 0;
    std::vector<std::string> scenes;      ///< all files of the input, as the user named them
    std::vector<RecordedOption> options;  ///< that the figures follow from, defaults filled in
    std::vector<InputFile> inputs;        ///< what was read
    Machine machine;
    FrameStats frame;  ///< of tessellation and shading
    FrameBlur blur;
    int rounds = 0;
    int reference_side = 0;  ///< samples of the reference's pixels along each axis
    std::string baseline;    ///< the method that ratios are to
    std::vector<SampleRate> rates;
    std::vector<ComparedMethod> methods;  ///< by rate, then in the order asked for
    Image reference;
    std::vector<std::string> verdict;                ///< sentences
    std::vector<std::string> verdict_without_times;  ///< those that follow from nothing that a clock said

    std::vector<const ComparedMethod*> at(SampleRate rate) const;
};

/// What is compared, and who is told how far it is.
struct CompareSettings {
    std::vector<Sampler> samplers;  ///< in the order in which they are shown
    std::vector<SampleRate> rates;  ///< each sampler is measured at each of these
    MeasureSettings measure;        ///< its on_progress is not used
    int reference_side = 32;
    std::function<void(const std::string& what)> on_stage = {};
    std::function<void(double)> on_progress = {};  ///< of the stage
};

/// Measures the methods, makes their pictures and the reference, and judges. Empty when cancelled.
std::optional<Comparison> compare(const SharedFrame& frame, const CompareSettings& settings);

/// The method that ratios are to: "raytrace" as it is by default, else the first of its kind, else the first.
std::string baseline_of(const std::vector<Sampler>& samplers);

/// Whether a method is a ray tracer, a rasterizer or a reference, as its row of the table says.
MethodKind kind_of(const MethodResult& result);

/// "8x8"
std::string rate_text(SampleRate rate);

}  // namespace trapeze
