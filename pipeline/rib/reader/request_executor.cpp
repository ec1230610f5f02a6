/// Errors of requests end here: a handler throws, and the request is left out with a message. What it did
/// before it threw stays, so handlers read all of their arguments first.
#include "pipeline/rib/reader/request_executor.h"

#include "pipeline/rib/reader/conditional_blocks.h"
#include "pipeline/rib/reader/motion_collector.h"
#include "pipeline/rib/reader/scene_builder.h"

namespace trapeze::rib {
namespace {

/// Exporters write objects without points as shapes of an empty "P". Looked for before the handler is called,
/// which would make an error of it.
bool has_no_points(const RequestText& text) {
    for (size_t i = 0; i + 1 < text.arguments.size(); ++i) {
        const Argument& name = text.arguments[i];
        const Argument& value = text.arguments[i + 1];
        if (value.kind == Argument::Kind::Array && value.strings.empty() && value.floats.empty() &&
            name.kind == Argument::Kind::String &&
            (name.strings[0] == "P" || name.strings[0].ends_with(" P")))
            return true;
    }
    return false;
}

/// Gives a handler the context that it names. A visitor: the type of the stored function pointer picks the
/// member of the tuple, so that a handler with a context that nobody made does not compile.
struct HandlerCall {
    RequestContexts& contexts;
    ArgumentCursor& cursor;

    template <class Context>
    void operator()(HandlerWith<Context> handler) const {
        handler(std::get<Context>(contexts), cursor);
    }
    void operator()(std::monostate) const {}
};

}  // namespace

/// The summary's entries stay where they are.
uint64_t& RequestExecutor::count_of(const Request& request) {
    if (request.number >= counts_.size()) counts_.resize(request.number + 1);
    uint64_t*& count = counts_[request.number];
    if (!count) count = &report_.summary().requests[request.name];
    return *count;
}

/// The order counts: a request is counted before anything of it is judged; variables are replaced before
/// others are told of it, and these may refuse it.
void RequestExecutor::execute(RequestText& text) {
    const Request* const request = find_request(text.name);
    if (!request) {
        report_.set_request(text.at, clipped(text.name));
        report_.report_unknown_request(text.name);
        return;
    }
    report_.set_known_request(text.at, request->name);
    ++count_of(*request);
    if (request->group == RequestGroup::Unsupported) {
        if (text.problem.empty()) hands_on(text);
        report_.count_unsupported();
        report_.diagnostics().warning(text.at, text.name + " is not supported yet; skipped",
                                      "unsupported-" + text.name);
        return;
    }
    if (!text.problem.empty()) {
        // A stray character must not take a whole block with it.
        const bool is_block = request->group == RequestGroup::Structure && text.arguments.empty();
        report_.error(text.problem_at, text.problem + (is_block ? "; ignored" : "; request skipped"));
        if (!is_block) return;
    }
    try {
        conditions_.substitute(text);
        if (!hands_on(text)) return;
        const bool moves =
            request->group != RequestGroup::Attribute && request->group != RequestGroup::Option;
        if (motion_.is_open() && !moves)
            motion_.hold(std::move(text));
        else
            carry_out(*request, text);
    } catch (const RequestError& problem) {
        const bool is_shape = request->group == RequestGroup::Geometry;
        report_.error(problem.at, problem.text + (is_shape ? "; primitive skipped" : "; request skipped"));
    }
}

/// Not told to ReadOptions::on_request again: that was done where it stood. Errors are about the first of its
/// places.
void RequestExecutor::execute_held(const std::vector<RequestText>& keys, const std::vector<float>& times) {
    const OtherRequest held(report_, keys[0].at, keys[0].name);
    RequestText text = motion_.as_shutter_opens(keys, times);
    try {
        carry_out(*find_request(text.name), text);
    } catch (const RequestError& problem) {
        report_.error(problem.at, problem.text + "; request skipped");
    }
}

/// The handler's own name for what is wrong is enough: place and request are added where it is caught.
void RequestExecutor::carry_out(const Request& request, RequestText& text) {
    if (request.group == RequestGroup::Geometry && has_no_points(text)) {
        report_.warn_once("\"P\" is empty; there is nothing to draw", "empty-" + text.name);
        return;
    }
    ArgumentCursor cursor(text);
    std::visit(HandlerCall{contexts_, cursor}, request.handler);
    if (!cursor.done())
        report_.error(cursor.peek()->at, "more arguments than the request has; the rest is ignored");
}

/// Conditions are resolved for the listener, and frames that are not wanted are not for it.
bool RequestExecutor::hands_on(const RequestText& text) const {
    if (!read_options_.on_request || ConditionalBlocks::is_conditional(text.name) ||
        !scene_.frame_is_wanted())
        return true;
    return read_options_.on_request(text);
}

}  // namespace trapeze::rib
