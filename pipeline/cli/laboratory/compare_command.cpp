#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/simd/simd_limit.h"
#include "pipeline/cli/laboratory/laboratory.h"
#include "pipeline/cli/laboratory/recorded_comparison.h"
#include "pipeline/cli/support/exit_codes.h"
#include "pipeline/cli/support/interrupt.h"
#include "pipeline/cli/support/on_threads.h"
#include "pipeline/cli/support/read_settings.h"
#include "pipeline/cli/support/revision.h"
#include "pipeline/cli/support/text_files.h"
#include "pipeline/compare/record/replay.h"
#include "pipeline/compare/report/html_report.h"
#include "pipeline/compare/results_json.h"
#include "pipeline/compare/table.h"
#include "pipeline/compare/write_pictures.h"
#include "pipeline/frame/frame_memory.h"
#include "pipeline/frame/json_text.h"
#include "pipeline/frame/version.h"
#include "pipeline/rib/read_rib.h"
#include "sample/sampler_list.h"

namespace trapeze {
namespace {

namespace fs = std::filesystem;

/// Brute force is compared by default where its tests, all micropolygons for every sample, are so few.
constexpr double kFewTests = 2e9;

/// Compares methods on the first world of the input.
class CompareJob {
  public:
    CompareJob(const Arguments& arguments, Terminal& terminal, Diagnostics& diagnostics)
        : arguments_(arguments),
          options_(arguments.compare),
          terminal_(terminal),
          diagnostics_(diagnostics),
          access_(scene_access(arguments)),
          interrupt_(arguments.time_limit) {
        access_.record_reads(reads_);
    }

    int run();
    /// The comparison, after run(); empty where none was made.
    const std::optional<Comparison>& result() const { return result_; }

  private:
    bool outputs_are_possible();
    void take_world(Scene&& scene);
    CompareSettings settings_for(const SharedFrame& frame);
    std::vector<InputFile> files_read() const;
    void write_outputs(const Comparison& comparison, const SharedFrame& frame);
    void print(const Comparison& comparison) const;
    int exit_code() const;

    const Arguments& arguments_;
    const CompareArguments& options_;
    Terminal& terminal_;
    Diagnostics& diagnostics_;
    Access access_;
    Interrupt interrupt_;
    std::shared_ptr<ReadNames> reads_ = std::make_shared<ReadNames>();
    std::string defaults_file_;
    int worlds_ = 0, frame_number_ = 0;
    std::optional<Comparison> result_;
    bool output_failed_ = false;
};

/// Before minutes are spent on figures that cannot be written.
bool CompareJob::outputs_are_possible() {
    if (!can_write({options_.report, options_.json, options_.csv}, diagnostics_)) return false;
    return options_.folder.empty() || make_folder(options_.folder, diagnostics_);
}

CompareSettings CompareJob::settings_for(const SharedFrame& frame) {
    CompareSettings settings;
    for (const auto& [x, y] : options_.samples) settings.rates.push_back({x, y});
    if (settings.rates.empty()) settings.rates = {{frame.context.samples_x, frame.context.samples_y}};
    if (options_.samplers.empty()) {
        double samples = 0;
        for (const SampleRate& rate : settings.rates)
            samples += static_cast<double>(rate.per_pixel()) * frame.pixels.width() * frame.pixels.height();
        const double tests = samples * static_cast<double>(frame.grids.micropolygon_count());
        settings.samplers = default_samplers(arguments_.pattern, tests <= kFewTests);
    } else {
        std::string error;  // the command line was checked
        settings.samplers = *parse_samplers(options_.samplers, arguments_.pattern, &error);
    }
    settings.measure.rounds = options_.rounds;
    settings.measure.variance = arguments_.variance.value_or(0);
    settings.reference_side = options_.reference_side;
    settings.on_stage = [this](const std::string& what) {
        terminal_.begin_progress(what, {arguments_.inputs.front(), what, frame_number_});
    };
    settings.on_progress = [this](double part) { terminal_.progress(part); };
    return settings;
}

void CompareJob::take_world(Scene&& scene) {
    if (interrupt_.requested() || ++worlds_ > 1) return;
    Options& options = scene.options;
    if (arguments_.resolution) std::tie(options.width, options.height) = *arguments_.resolution;
    if (arguments_.crop) options.crop_window = *arguments_.crop;
    options.exposure_gamma = 1;  // errors are of linear values

    RenderSettings settings;
    settings.memory_bytes = arguments_.memory_bytes;
    settings.seed = arguments_.seed;
    settings.cancelled = &interrupt_.requested();
    settings.access = &access_;
    settings.on_progress = [this](double part) { terminal_.progress(part); };
    frame_number_ = options.frame;
    terminal_.begin_progress("shading", {arguments_.inputs.front(), "shading", frame_number_});
    const auto frame = share_frame(std::move(scene), settings, diagnostics_);
    if (!frame) return terminal_.end_progress();
    const CompareSettings what = settings_for(*frame);
    result_ = compare(*frame, what);
    terminal_.end_progress();
    if (!result_) return;
    Comparison& comparison = *result_;
    comparison.scene = arguments_.inputs.front(), comparison.scenes = arguments_.inputs;
    comparison.machine.trapeze = kVersion, comparison.machine.revision = revision();
    comparison.command = arguments_.words, comparison.seed = arguments_.seed;
    comparison.options = recorded_options(arguments_, what);
    comparison.inputs = files_read();
    print(comparison);
    write_outputs(comparison, *frame);
}

std::vector<InputFile> CompareJob::files_read() const {
    std::set<std::string> names = reads_->names();
    names.insert(arguments_.inputs.begin(), arguments_.inputs.end());
    names.insert(arguments_.plugins.begin(), arguments_.plugins.end());
    std::vector<InputFile> files = hashed_inputs(names);
    if (defaults_file_.empty()) return files;
    files.push_back(hashed_inputs({defaults_file_}).front());
    files.back().name = kUserDefaults;
    return files;
}

void CompareJob::print(const Comparison& comparison) const {
    fmt::print("{}\n", table_text(comparison));
    for (const std::string& sentence : comparison.verdict) fmt::print("{}\n", sentence);
}

void CompareJob::write_outputs(const Comparison& comparison, const SharedFrame& frame) {
    bool good = true;
    if (!options_.json.empty())
        good =
            write_text(options_.json, json_text(to_json(comparison)) + "\n", terminal_, diagnostics_) && good;
    if (!options_.csv.empty())
        good = write_text(options_.csv, comparison_csv(comparison), terminal_, diagnostics_) && good;
    if (!options_.report.empty())
        good = write_text(options_.report, html_report(comparison), terminal_, diagnostics_) && good;
    if (!options_.folder.empty())
        good =
            write_pictures(comparison, frame, options_.folder, std::string("Trapeze ") + kVersion,
                           [this](const std::string& file) { terminal_.say_on_terminal("wrote " + file); }) &&
            good;
    output_failed_ = !good;
}

int CompareJob::exit_code() const {
    if (interrupt_.requested()) return interrupt_.exit_code();
    if (output_failed_) return kExitNoOutput;
    const auto kinds = diagnostics_.kinds();
    if (kinds.contains(kTooLittleMemory) || kinds.contains(kPictureTooLarge)) return kExitNoMemory;
    if (!result_) return kExitNothingRendered;
    const bool warned = diagnostics_.count(Severity::Warning) > 0;
    return diagnostics_.count(Severity::Error) > 0 || (arguments_.strict && warned) ? kExitErrors : kExitOk;
}

int CompareJob::run() {
    if (!outputs_are_possible()) return kExitNoOutput;
    ReadOptions options = read_options(arguments_, access_);
    options.cancelled = &interrupt_.requested();
    defaults_file_ = options.defaults_file;
    options.shading_rate = arguments_.shading_rate;
    on_threads(arguments_.threads, [&] {
        read_rib(arguments_.inputs, options, diagnostics_,
                 [&](Scene&& scene) { take_world(std::move(scene)); });
    });
    if (!interrupt_.requested()) {
        if (worlds_ == 0) diagnostics_.error({}, "no WorldBegin block was found in the input");
        if (worlds_ > 1) diagnostics_.note({}, fmt::format("the first of {} worlds was compared", worlds_));
    }
    return exit_code();
}

/// The arguments of a replay as those of the comparison that was recorded; empty, and reported, where that
/// cannot be repeated.
std::optional<Arguments> replayed_arguments(const Arguments& given, const RecordedComparison& recorded,
                                            Diagnostics& diagnostics) {
    Arguments arguments = given;
    arguments.compare.replay.clear();
    arguments.inputs = recorded.scenes;
    std::string error;
    if (std::ranges::find(recorded.scenes, "-") != recorded.scenes.end())
        error = "its scene was standard input, which is not here";
    if (const auto words = error.empty() ? words_of(recorded.options, &error) : std::nullopt)
        error = parse_more_of_compare(*words, arguments);
    // Who wrote the file may be a stranger; what RIB before the scenes searches is open to them.
    if (error.empty() && arguments.safe && !arguments.first_rib.empty())
        error = "it has RIB of --option, which --safe does not take from a file";
    std::string no_simd;
    if (error.empty() && !limit_simd(arguments.simd, &no_simd))
        diagnostics.note({}, fmt::format("{}: counts of tests and nodes may differ", no_simd));
    if (error.empty()) return arguments;
    diagnostics.error({}, fmt::format("cannot replay \"{}\": {}", given.compare.replay, error));
    return {};
}

/// Reports what is not as it was. Returns whether all is.
bool report_differences(const RecordedComparison& recorded, const Comparison& comparison,
                        const std::string& file, Diagnostics& diagnostics) {
    const ReplayOutcome outcome =
        compare_figures(recorded.whole, nlohmann::json::parse(json_text(to_json(comparison))));
    const std::vector<std::string> inputs = changed_inputs(recorded.inputs, comparison.inputs);
    for (const std::string& sentence : inputs) diagnostics.error({}, sentence);
    for (const std::string& sentence : outcome.differences) diagnostics.error({}, sentence);
    if (recorded.version != kVersion)
        diagnostics.note({}, fmt::format("Trapeze {} recorded it, this is {}", recorded.version, kVersion));
    const size_t different = outcome.differences.size();
    fmt::print("\nReplay of {}: of {} figures {} {} as recorded; times are not compared.\n", file,
               outcome.compared, different == 0 ? "all" : fmt::format("{}", different),
               different == 0 ? "are" : "are not");
    return different == 0 && inputs.empty();
}

int replay(const Arguments& given, Terminal& terminal, Diagnostics& diagnostics) {
    constexpr size_t kMostBytes = size_t{64} << 20;
    const std::string& file = given.compare.replay;
    std::string text, error;
    if (!inputs_exist({file}, diagnostics)) return kExitNoInput;
    if (!kEverything.read(file, kMostBytes, &text)) {
        diagnostics.error({}, fmt::format("cannot read \"{}\", or it has more than 64 MiB", file));
        return kExitNoInput;
    }
    const auto recorded = read_recorded(text, &error);
    if (!recorded) {
        diagnostics.error({}, fmt::format("cannot replay \"{}\": {}", file, error));
        return kExitNoInput;
    }
    const auto arguments = replayed_arguments(given, *recorded, diagnostics);
    if (!arguments || !inputs_exist(arguments->inputs, diagnostics)) return kExitNoInput;
    CompareJob job(*arguments, terminal, diagnostics);
    const int code = job.run();
    if (!job.result()) return code;
    const bool same = report_differences(*recorded, *job.result(), file, diagnostics);
    return same || code != kExitOk ? code : kExitErrors;
}

}  // namespace

int compare_command(const Arguments& arguments, Terminal& terminal, Diagnostics& diagnostics) {
    if (!arguments.compare.replay.empty()) return replay(arguments, terminal, diagnostics);
    if (!inputs_exist(arguments.inputs, diagnostics)) return kExitNoInput;
    return CompareJob(arguments, terminal, diagnostics).run();
}

}  // namespace trapeze
