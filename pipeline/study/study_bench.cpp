#include "pipeline/study/study_bench.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>

#include "pipeline/compare/blur.h"
#include "pipeline/compare/comparison.h"
#include "pipeline/compare/results_json.h"
#include "pipeline/compare/value_text.h"
#include "pipeline/frame/make_context.h"
#include "pipeline/frame/render_frame.h"
#include "pipeline/rib/read_rib.h"
#include "sample/sampler_list.h"

namespace trapeze {

std::string scene_command_line(const StudyScene& scene) {
    const SceneParameters& p = scene.parameters;
    std::string text = fmt::format("trapeze scene {} -r {}x{}", scene.name, p.width, p.height);
    if (p.scale != 1) text += fmt::format(" --scale {:.4g}", p.scale);
    if (p.motion != 1) text += fmt::format(" --motion {:.4g}", p.motion);
    if (p.defocus != 1) text += fmt::format(" --defocus {:.4g}", p.defocus);
    if (p.shading_rate != 1) text += fmt::format(" --shading-factor {:.4g}", p.shading_rate);
    if (p.time > 0) text += fmt::format(" --time {:.4g}", p.time);
    return text;
}

namespace {

/// In any case of letters.
bool has_part(std::string_view text, std::string_view part) {
    const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
    const auto same = [&](char a, char b) { return lower(a) == lower(b); };
    return std::search(text.begin(), text.end(), part.begin(), part.end(), same) != text.end();
}

std::string figure_line(const StudyScene& scene, const MethodResult& result) {
    return fmt::format("{}, {} {}: build {}, trace {}", scene.label, rate_text(result.rate), result.method,
                       seconds_text(result.build_median()), seconds_text(result.resolve_median()));
}

}  // namespace

StudyBench::StudyBench(const StudySettings& settings, Diagnostics& diagnostics, StudyResult& result)
    : settings_(settings), diagnostics_(diagnostics), result_(result) {}

void StudyBench::go_on() const {
    if (settings_.cancelled && *settings_.cancelled) throw StudyStopped();
}

void StudyBench::stage(const std::string& what) const {
    if (settings_.on_stage) settings_.on_stage(what);
}

bool StudyBench::takes(const std::string& label) const {
    return settings_.scenes.empty() ||
           std::ranges::any_of(settings_.scenes, [&](const auto& name) { return has_part(label, name); });
}

void StudyBench::offer_scenes(const std::vector<std::string>& labels) {
    has_offered_ = true;
    for (const std::string& name : settings_.scenes) {
        if (std::ranges::any_of(labels, [&](const auto& label) { return has_part(label, name); })) continue;
        diagnostics_.error({},
                           fmt::format("study {} has no scene \"{}\"; it has: {}", result_.name, name,
                                       fmt::join(labels, ", ")),
                           kNoSuchScene);
        throw StudyStopped();
    }
}

void StudyBench::begin_scene(const std::string& stage) const {
    go_on();
    if (!has_offered_ && !settings_.scenes.empty()) {
        diagnostics_.error({}, fmt::format("the scenes of study {} cannot be chosen", result_.name),
                           kNoSuchScene);
        throw StudyStopped();
    }
    this->stage(stage);
}

StudyScene StudyBench::scene(const std::string& label, const std::string& name, double micropolygons) const {
    StudyScene scene{label, name, {}};
    scene.parameters.scale = micropolygons;
    if (settings_.quick) {
        scene.parameters.width /= 2, scene.parameters.height /= 2;
        // Where ShadingRate makes the micropolygons, fewer pixels have fewer; hairs and flowers are counted.
        if (name == "hair" || name == "flowers") scene.parameters.scale /= 4;
    }
    return scene;
}

RenderSettings StudyBench::render_settings() const {
    RenderSettings settings;
    settings.memory_bytes = settings_.memory_bytes;
    settings.seed = kStudySeed;
    settings.cancelled = settings_.cancelled;
    settings.on_progress = settings_.on_progress;
    return settings;
}

StudySceneFacts& StudyBench::note_facts(const StudyScene& scene, const FrameStats& stats) {
    StudySceneFacts& facts = result_.scenes.emplace_back();
    facts.label = scene.label, facts.command = scene_command_line(scene);
    facts.width = stats.width, facts.height = stats.height;
    facts.micropolygons = stats.tessellate.micropolygons;
    facts.grids = stats.tessellate.grids;
    return facts;
}

FrameStats StudyBench::render(const StudyScene& scene, const SampleRate& rate) {
    begin_scene("rendering " + scene.label);
    const RenderSettings settings = render_settings();
    std::optional<FrameResult> result;
    const std::string text = scene_text(scene.name, scene.parameters);
    const auto start = std::chrono::steady_clock::now();
    read_rib_text(text, scene.name, ReadOptions{}, diagnostics_, [&](Scene&& world) {
        world.options.samples_x = static_cast<float>(rate.x);
        world.options.samples_y = static_cast<float>(rate.y);
        const RenderContext context = make_context(world, settings, diagnostics_);
        result = render_frame(context, settings);
    });
    if (!result) throw StudyStopped();
    FrameStats& stats = result->stats;
    stats.seconds.total = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    StudySceneFacts& facts = note_facts(scene, stats);
    facts.largest_defocus = facts.largest_motion = std::numeric_limits<float>::quiet_NaN();
    return std::move(stats);
}

SharedFrame StudyBench::frame(const StudyScene& scene) {
    begin_scene("shading " + scene.label);
    const RenderSettings settings = render_settings();
    std::optional<SharedFrame> frame;
    const std::string text = scene_text(scene.name, scene.parameters);
    read_rib_text(text, scene.name, ReadOptions{}, diagnostics_,
                  [&](Scene&& world) { frame = share_frame(std::move(world), settings, diagnostics_); });
    if (!frame) throw StudyStopped();
    const FrameBlur blur = measure_blur(frame->context.camera, frame->grids);
    StudySceneFacts& facts = note_facts(scene, frame->stats);
    facts.micropolygons = frame->grids.micropolygon_count();
    facts.largest_defocus = blur.defocus.largest, facts.largest_motion = blur.motion.largest;
    return std::move(*frame);
}

std::pair<std::unique_ptr<const Scene>, RenderContext> StudyBench::empty_scene(const std::string& rib) {
    std::unique_ptr<const Scene> scene;
    read_rib_text(rib, "options", ReadOptions{}, diagnostics_,
                  [&](Scene&& world) { scene = std::make_unique<const Scene>(std::move(world)); });
    if (!scene) throw StudyStopped();
    RenderContext context = make_context(*scene, render_settings(), diagnostics_);
    return {std::move(scene), std::move(context)};
}

std::vector<MethodResult> StudyBench::measure(const SharedFrame& frame, const StudyScene& scene,
                                              const std::string& methods,
                                              const std::vector<SampleRate>& rates,
                                              MeasureSettings settings) {
    stage("sampling " + scene.label);
    std::string error;
    const auto samplers = parse_samplers(methods, "", &error);
    if (!samplers) {  // a study's own text: a mistake of ours
        diagnostics_.error({}, error);
        throw StudyStopped();
    }
    settings.rounds = settings_.rounds;
    settings.on_progress = settings_.on_progress;
    auto results = trapeze::measure(frame, *samplers, rates, settings);
    if (results.empty()) throw StudyStopped();
    for (const MethodResult& result : results) {
        if (settings_.on_figure) settings_.on_figure(figure_line(scene, result));
        nlohmann::ordered_json figure = to_json(result);
        figure["scene"] = scene_command_line(scene);
        figure["stands_for"] = scene.label;
        result_.figures.push_back(std::move(figure));
    }
    return results;
}

}  // namespace trapeze
