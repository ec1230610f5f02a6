/// Requests about the state that RISpec 3.2 does not have, and ErrorHandler (RISpec 3).
#include "pipeline/rib/requests/request_table.h"
#include "pipeline/rib/requests/ri_values.h"

namespace trapeze::rib {
namespace {

/// "attributes" are saved and restored. Of the subsets of PRMan's, "transform" and all others are told apart:
/// of several names, with commas, the attributes are restored, and the transformation if it is one of them.
void resource(StateContext& r, ArgumentCursor& c) {
    const std::string name = c.handle("the resource's name"), type = c.string("the type");
    const ParameterList parameters = r.parameters(c, Undeclared::Guess);
    const std::string operation = parameters.string_or("operation", ""),
                      subset = parameters.string_or("subset", "all");
    if (type != "attributes") {
        r.report.count_unsupported();
        r.report.warn_once(in_quotes(type) + " is not supported; skipped", "resource-" + type);
    } else if (operation == "save") {
        r.state.saved_states().save(name, r.state.current());
    } else if (operation == "restore") {
        const bool all = subset.find("all") != std::string::npos;
        const bool transform = subset.find("transform") != std::string::npos;
        if (!r.state.restore(name, all || !transform || subset.find(',') != std::string::npos,
                             all || transform))
            throw RequestError{"no resource " + in_quotes(name), {}};
    } else {
        throw RequestError{"\"operation\" is neither save nor restore", {}};
    }
}

/// RISpec's handlers by their names; others, which only a program could have, are passed over. Holds from
/// here to the end of the reading: no block restores it.
void error_handler(StateContext& r, ArgumentCursor& c) {
    const std::string name = c.string("the handler");
    r.parameters(c, Undeclared::Guess);
    if (name == "ignore")
        r.report.set_error_handler(RequestReport::OnError::Ignore);
    else if (name == "abort" || name == "abortall")
        r.report.set_error_handler(RequestReport::OnError::Abort);
    else if (name == "print" || name == "printonce" || name == "default")
        r.report.set_error_handler(RequestReport::OnError::Print);
    else
        r.report.warn_once(in_quotes(name) + " is not known; ignored", "error-handler-" + name);
}

/// The space that the world is seen from, which its coordinate system is named for. Later versions keep the
/// window and the planes of clipping with it.
void camera(OptionContext& r, ArgumentCursor& c) {
    r.state.name_coordinate_system(c.string("the name"));
    const ParameterList parameters = r.parameters(c, Undeclared::Guess);
    if (r.state.in_world()) return;
    constexpr std::string_view kRi = "Ri:";
    for (Parameter value : parameters.values)
        if (value.name.starts_with(kRi)) {
            value.name.erase(0, kRi.size());
            execute_ri_value(r, value);
        }
    const float near = parameters.float_or("nearClip", 0), far = parameters.float_or("farClip", 0);
    if (near > 0 && near < far) r.state.options().near_clip = near, r.state.options().far_clip = far;
}

/// Commands of strangers are not run.
void system(StateContext& r, ArgumentCursor& c) {
    c.skip_rest();
    r.report.count_unsupported();
    r.report.warn_once("commands in files are never run; skipped", "unsupported-System");
}

/// VolumePixelSamples x y: volumes are sampled like surfaces here.
void volume_pixel_samples(StateContext& r, ArgumentCursor& c) {
    c.numbers(2, "the samples");
    r.report.count_without_effect();
}

/// Structure, as far as motion blocks go: none of these is held back by one.
constexpr RequestRow kStateRequests[] = {
    {"Resource", resource},
    {"ResourceBegin", [](StateContext& r, ArgumentCursor&) { r.state.saved_states().begin_block(); }},
    {"ResourceEnd", [](StateContext& r, ArgumentCursor&) { r.state.saved_states().end_block(); }},
    {"ErrorHandler", error_handler},
    {"ScopedCoordinateSystem",
     [](StateContext& r, ArgumentCursor& c) { r.state.name_scoped_coordinate_system(c.string("the name")); }},
    {"Camera", camera},
    {"System", system},
    {"VolumePixelSamples", volume_pixel_samples},
    {"ArchiveRecord", [](StateContext&, ArgumentCursor& c) { c.skip_rest(); }},  // a comment
};

}  // namespace

std::span<const RequestRow> state_requests() {
    return kStateRequests;
}

}  // namespace trapeze::rib
