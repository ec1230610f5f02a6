#include "pipeline/ri/render_rib.h"

#include <mutex>

#include "pipeline/frame/make_map.h"
#include "pipeline/frame/render_frame.h"
#include "pipeline/frame/write_frame.h"
#include "pipeline/rib/read_rib.h"
#include "pipeline/rib/user_defaults.h"

namespace trapeze::ri {
namespace {

Message message_of(const Diagnostic& diagnostic) {
    RtInt severity = RIE_ERROR;
    if (diagnostic.severity == Severity::Warning) severity = RIE_WARNING;
    if (diagnostic.severity == Severity::Note) severity = RIE_INFO;
    const RtInt code = diagnostic.kind.starts_with("missing-shader") ? RIE_NOSHADER : RIE_SYSTEM;
    return {code, severity, to_string(diagnostic)};
}

void render(Scene&& scene, KeptPictures& kept, Diagnostics& diagnostics) {
    if (scene.options.displays.empty()) scene.options.displays.push_back({"ri.exr", "file", "rgba", {}, {}});
    const RenderSettings settings;
    const RenderContext context = make_context(scene, settings, diagnostics);
    if (std::optional<FrameResult> frame = render_frame(context, settings))
        write_frame(*frame, context, {}, &kept);
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
    options.allow_programs = may_run_programs;
    KeptPictures kept(diagnostics);
    options.on_map = [&](const MapRequest& request) {
        make_map(request, diagnostics);
        for (const std::string& picture : request.pictures) kept.forget(picture);
    };
    read_rib_text(text, "ri", options, diagnostics,
                  [&](Scene&& scene) { render(std::move(scene), kept, diagnostics); });
    return messages;
}

}  // namespace trapeze::ri
