/// What studies work with: scenes made to measure, and times and counts of methods on them.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/compare/measure.h"
#include "pipeline/study/scenes/scenes.h"
#include "pipeline/study/study.h"

namespace trapeze {

/// Our counterpart of one of the paper's scenes.
struct StudyScene {
    std::string label;  ///< the paper's name
    std::string name;   ///< of scene_names()
    SceneParameters parameters;
};

/// Thrown to end a study: it was cancelled, or a scene (reported) could not be had.
struct StudyStopped {};

/// Makes scenes and measures methods on them, and keeps all figures in the study's result. Throws
/// StudyStopped.
class StudyBench {
  public:
    /// Writes scenes and figures into `result`. All must outlive this.
    StudyBench(const StudySettings& settings, Diagnostics& diagnostics, StudyResult& result);

    int rounds() const { return settings_.rounds; }
    bool quick() const { return settings_.quick; }
    const std::string& bart_folder() const { return settings_.bart_folder; }
    /// The rate of pictures that the paper supersamples 13x13 or finer.
    SampleRate reference_rate() const { return settings_.quick ? SampleRate{8, 8} : SampleRate{13, 13}; }

    /// Tells which scenes the study has, before it makes the first: those that the settings ask for are
    /// measured alone. Where they ask for one that is not among them, or of a study that does not tell, an
    /// error says so and the study stops.
    void offer_scenes(const std::vector<std::string>& labels);
    /// Whether a scene that has been offered is to be measured.
    bool takes(const std::string& label) const;

    /// A scene at the size that a study of this kind (quick or not) is measured at; `micropolygons`
    /// multiplies the scene's own at full size.
    StudyScene scene(const std::string& label, const std::string& name, double micropolygons) const;

    /// Reads, dices and shades the scene, and notes its facts.
    SharedFrame frame(const StudyScene& scene);
    /// Renders the scene to a picture, which is let go, by ray tracing; the total is from its text on. Its
    /// facts have no blur.
    FrameStats render(const StudyScene& scene, const SampleRate& rate);
    /// The context of a text that has options alone; and what it is the context of.
    std::pair<std::unique_ptr<const Scene>, RenderContext> empty_scene(const std::string& rib);
    /// The facts of the scene that frame() or render() made last.
    const StudySceneFacts& last_facts() const { return result_.scenes.back(); }

    /// Measures methods, which are separated by spaces; the results are by rate, then by method.
    /// The settings' rounds and progress are the study's own.
    std::vector<MethodResult> measure(const SharedFrame& frame, const StudyScene& scene,
                                      const std::string& methods, const std::vector<SampleRate>& rates,
                                      MeasureSettings settings = {});

    /// Who watches the part of a stage that is done; may be empty.
    const std::function<void(double)>& on_progress() const { return settings_.on_progress; }
    /// Ends the study when it was cancelled.
    void go_on() const;
    /// Tells who watches what is done now.
    void stage(const std::string& what) const;
    /// Tells who watches a figure that measure() has no part in.
    void figure(const std::string& line) const {
        if (settings_.on_figure) settings_.on_figure(line);
    }

  private:
    RenderSettings render_settings() const;
    void begin_scene(const std::string& stage) const;
    StudySceneFacts& note_facts(const StudyScene& scene, const FrameStats& stats);

    const StudySettings& settings_;
    Diagnostics& diagnostics_;
    StudyResult& result_;
    bool has_offered_ = false;
};

/// "trapeze scene NAME ..." as one would write it to get this scene.
std::string scene_command_line(const StudyScene& scene);

}  // namespace trapeze
