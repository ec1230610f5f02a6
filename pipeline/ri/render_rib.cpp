#include "pipeline/ri/render_rib.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

#include "pipeline/frame/make_context.h"
#include "pipeline/frame/make_map.h"
#include "pipeline/frame/render_frame.h"
#include "pipeline/frame/safe_mode.h"
#include "pipeline/frame/write_frame.h"
#include "pipeline/rib/read_rib.h"
#include "pipeline/rib/state/user_defaults.h"

namespace trapeze::ri {
namespace {

/// A message of the renderer as one of the interface.
Message message_of(const Diagnostic& diagnostic) {
    RtInt severity = RIE_ERROR;
    if (diagnostic.severity == Severity::Warning) severity = RIE_WARNING;
    if (diagnostic.severity == Severity::Note) severity = RIE_INFO;
    const RtInt code = diagnostic.kind.starts_with("missing-shader") ? RIE_NOSHADER : RIE_SYSTEM;
    return {code, severity, to_string(diagnostic)};
}

/// Asks for the end of the work after some seconds; the process is not ended, as it is the caller's.
class TimeLimit {
  public:
    TimeLimit(double seconds, std::atomic<bool>& cancelled)
        : thread_([seconds, &cancelled](const std::stop_token& stop) {
              std::mutex mutex;
              std::unique_lock lock(mutex);
              std::condition_variable_any wakes;
              const auto time = std::chrono::duration<double>(seconds);
              cancelled = !wakes.wait_for(lock, stop, time, [&] { return stop.stop_requested(); });
          }) {}

  private:
    std::jthread thread_;
};

void render(Scene&& scene, const RenderSettings& settings, KeptPictures& kept, Diagnostics& diagnostics) {
    if (scene.options.displays.empty()) scene.options.displays.push_back({"ri.exr", "file", "rgba", {}, {}});
    const RenderContext context = make_context(scene, settings, diagnostics);
    if (std::optional<FrameResult> frame = render_frame(context, settings))
        write_frame(*frame, context, *settings.access, {}, &kept);
}

}  // namespace

std::vector<Message> render_rib(const std::string& text, bool may_run_programs) {
    std::vector<Message> messages;
    std::mutex mutex;  // grids are shaded in parallel
    Diagnostics diagnostics([&](const Diagnostic& diagnostic) {
        const std::lock_guard lock(mutex);
        messages.push_back(message_of(diagnostic));
    });
    ReadOptions options;
    options.defaults_file = user_defaults_file();
    const bool safe = safe_by_environment();
    options.allow_programs = may_run_programs && !safe;
    Access access = safe ? Access::confined() : Access();
    options.access = &access;
    RenderSettings settings;
    settings.access = &access;
    std::atomic<bool> cancelled = false;
    std::optional<TimeLimit> time_limit;
    if (safe) {
        options.max_source_bytes = options.most_scene_bytes = settings.memory_bytes = safe_memory_budget();
        options.cancelled = settings.cancelled = &cancelled;
        time_limit.emplace(kSafeSeconds, cancelled);
    }
    KeptPictures kept(diagnostics);
    options.on_map = [&](const MapRequest& request) {
        make_map(request, access, diagnostics);
        for (const std::string& picture : request.pictures) kept.forget(picture);
    };
    read_rib_text(text, "ri", options, diagnostics,
                  [&](Scene&& scene) { render(std::move(scene), settings, kept, diagnostics); });
    if (cancelled) diagnostics.error({}, "the time limit is reached; what was not done is left out");
    return messages;
}

}  // namespace trapeze::ri
