/// Requests about the state that RISpec 3.2 does not have, and ErrorHandler (RISpec 3).
#include "pipeline/rib/requests/request_table.h"
#include "pipeline/rib/requests/ri_values.h"

namespace trapeze::rib {
namespace {

void skip_rest(ArgumentCursor& c) {
    while (!c.done()) c.take("");
}

/// "attributes" are saved and restored. Of the subsets of PRMan's, "transform" and all others are told apart.
void resource(Reader& r, ArgumentCursor& c) {
    const std::string name = c.handle("the resource's name"), type = c.string("the type");
    const ParameterList parameters = r.parameters(c, Undeclared::Guess);
    const std::string operation = parameters.string_or("operation", ""),
                      subset = parameters.string_or("subset", "all");
    if (type != "attributes") {
        r.count_unsupported();
        r.warn_once(in_quotes(type) + " is not supported; skipped", "resource-" + type);
    } else if (operation == "save") {
        r.save_state(name);
    } else if (operation == "restore") {
        const bool all = subset.find("all") != std::string::npos;
        const bool transform = subset.find("transform") != std::string::npos;
        if (!r.restore_state(name, all || !transform || subset.find(',') != std::string::npos,
                             all || transform))
            throw RequestError{"no resource " + in_quotes(name), {}};
    } else {
        throw RequestError{"\"operation\" is neither save nor restore", {}};
    }
}

void error_handler(Reader& r, ArgumentCursor& c) {
    const std::string name = c.string("the handler");
    r.parameters(c, Undeclared::Guess);
    if (name == "ignore")
        r.set_error_handler(Reader::OnError::Ignore);
    else if (name == "abort" || name == "abortall")
        r.set_error_handler(Reader::OnError::Abort);
    else if (name == "print" || name == "printonce" || name == "default")
        r.set_error_handler(Reader::OnError::Print);
    else
        r.warn_once(in_quotes(name) + " is not known; ignored", "error-handler-" + name);
}

/// The space that the world is seen from, which its coordinate system is named for. Later versions keep the
/// window and the planes of clipping with it.
void camera(Reader& r, ArgumentCursor& c) {
    r.name_coordinate_system(c.string("the name"));
    const ParameterList parameters = r.parameters(c, Undeclared::Guess);
    if (r.in_world()) return;
    constexpr std::string_view kRi = "Ri:";
    for (Parameter value : parameters.values)
        if (value.name.starts_with(kRi)) {
            value.name.erase(0, kRi.size());
            execute_ri_value(r, value);
        }
    const float near = parameters.float_or("nearClip", 0), far = parameters.float_or("farClip", 0);
    if (near > 0 && near < far) r.options().near_clip = near, r.options().far_clip = far;
}

/// Commands of strangers are not run.
void system(Reader& r, ArgumentCursor& c) {
    skip_rest(c);
    r.count_unsupported();
    r.warn_once("commands in files are never run; skipped", "unsupported-System");
}

void volume_pixel_samples(Reader& r, ArgumentCursor& c) {
    c.numbers(2, "the samples");
    r.count_without_effect();
}

constexpr RequestRow kStateRequests[] = {
    {"Resource", resource},
    {"ResourceBegin", [](Reader& r, ArgumentCursor&) { r.begin_resources(); }},
    {"ResourceEnd", [](Reader& r, ArgumentCursor&) { r.end_resources(); }},
    {"ErrorHandler", error_handler},
    {"ScopedCoordinateSystem",
     [](Reader& r, ArgumentCursor& c) { r.name_scoped_coordinate_system(c.string("the name")); }},
    {"Camera", camera},
    {"System", system},
    {"VolumePixelSamples", volume_pixel_samples},
    {"ArchiveRecord", [](Reader&, ArgumentCursor& c) { skip_rest(c); }},  // a comment
};

}  // namespace

std::span<const RequestRow> state_requests() {
    return kStateRequests;
}

}  // namespace trapeze::rib
