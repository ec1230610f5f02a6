/// RiBegin, RiEnd, contexts, declarations, frames and worlds (RISpec 3), and the error handler.
#include "pipeline/ri/call.h"
#include "pipeline/ri/pairs.h"
#include "pipeline/ri/render_rib.h"

namespace trapeze::ri {
namespace {

/// Ends a context: renders what it has in memory, or puts its file in place. Returns what is to be said of
/// it.
std::vector<Message> finish(Context& context) {
    std::vector<Message> messages;
    if (context.open_blocks() > 0)
        messages.push_back({RIE_NESTING, RIE_ERROR,
                            "RiEnd: " + std::to_string(context.open_blocks()) + " blocks are still open"});
    if (!context.output.is_file()) {
        std::vector<Message> said = render_rib(context.output.text(), context.may_run_programs);
        messages.insert(messages.end(), std::move_iterator(said.begin()), std::move_iterator(said.end()));
    } else if (!context.output.commit()) {
        messages.push_back({RIE_SYSTEM, RIE_ERROR,
                            "RiEnd: cannot write \"" + context.name() + "\": " + context.output.error()});
    }
    return messages;
}

/// Begins a context that writes to the file `name`, or, for an empty name, renders at RiEnd.
void begin(const std::string& name) {
    RibFormat format = next_format();
    if (name.ends_with(".gz")) format.gzip = true;
    if (name.empty()) format = {};
    begin_context(name, format);
    Context& context = *current_context();
    if (!context.output.error().empty())
        throw CallError{RIE_NOFILE, "cannot write \"" + name + "\": " + context.output.error()};
    if (!context.output.is_file()) return;
    context.writer().comment("##RenderMan RIB-Structure 1.0");
    context.writer().request("version");
    context.writer().number(3.03f);
}

void begin_block(const char* name, const char* request, BlockKind block) {
    call(name, [&](Context& context) {
        context.open(block);
        context.writer().request(request);
    });
}

void end_block(const char* name, const char* request, BlockKind block) {
    call(name, [&](Context& context) {
        context.close(block);
        context.writer().request(request);
    });
}

}  // namespace
}  // namespace trapeze::ri

using namespace trapeze::ri;

RtVoid RiBegin(RtToken name) {
    guarded("RiBegin", [&] { begin(name ? name : ""); });
}

RtVoid RiEnd() {
    const std::unique_ptr<Context> context = take_current_context();
    if (!context) return report({RIE_NOTSTARTED, RIE_ERROR, "RiEnd: RiBegin has not been called"});
    std::vector<Message> messages;
    guarded("RiEnd", [&] { messages = finish(*context); });
    for (Message& message : messages) report(std::move(message));
}

RtContextHandle RiGetContext() {
    return current_context();
}

RtVoid RiContext(RtContextHandle handle) {
    guarded("RiContext", [&] {
        if (!select_context(handle)) throw CallError{RIE_BADHANDLE, "no such context"};
    });
}

RtVoid RiErrorHandler(RtErrorHandler handler) {
    set_error_handler(handler);
    const char* name = nullptr;
    if (!handler || handler == RiErrorPrint) name = "print";
    if (handler == RiErrorIgnore) name = "ignore";
    if (handler == RiErrorAbort) name = "abort";
    if (!name || !current_context()) return;  // RIB has no name for a program's own
    call("RiErrorHandler", [&](Context& context) {
        context.writer().request("ErrorHandler");
        context.writer().string(name);
    });
}

RtVoid RiFrameBegin(RtInt frame) {
    call("RiFrameBegin", [&](Context& context) {
        context.open(BlockKind::Frame);
        context.writer().request("FrameBegin");
        context.writer().number(frame);
    });
}

RtVoid RiFrameEnd() {
    end_block("RiFrameEnd", "FrameEnd", BlockKind::Frame);
}

RtVoid RiWorldBegin() {
    call("RiWorldBegin", [&](Context& context) {
        context.open(BlockKind::World);
        context.spaces.begin_world();
        context.writer().request("WorldBegin");
    });
}

RtVoid RiWorldEnd() {
    end_block("RiWorldEnd", "WorldEnd", BlockKind::World);
}

RtToken RiDeclare(RtToken name, RtToken declaration) {
    RtToken declared = nullptr;
    call("RiDeclare", [&](Context& context) {
        required(name, "the name"), required(declaration, "the declaration");
        const auto parsed = trapeze::rib::parse_declaration(declaration);
        if (!parsed) throw CallError{RIE_SYNTAX, "\"" + std::string(declaration) + "\" is no declaration"};
        context.declarations.declare(name, *parsed);
        context.writer().request("Declare");
        context.writer().string(name);
        context.writer().string(declaration);
        declared = name;
    });
    return declared;
}

RtVoid RiAttributeBegin() {
    begin_block("RiAttributeBegin", "AttributeBegin", BlockKind::Attribute);
}

RtVoid RiAttributeEnd() {
    end_block("RiAttributeEnd", "AttributeEnd", BlockKind::Attribute);
}

RtVoid RiTransformBegin() {
    begin_block("RiTransformBegin", "TransformBegin", BlockKind::Transform);
}

RtVoid RiTransformEnd() {
    end_block("RiTransformEnd", "TransformEnd", BlockKind::Transform);
}

RtVoid RiSolidEnd() {
    end_block("RiSolidEnd", "SolidEnd", BlockKind::Solid);
}

RtVoid RiObjectEnd() {
    end_block("RiObjectEnd", "ObjectEnd", BlockKind::Object);
}

RtVoid RiMotionEnd() {
    end_block("RiMotionEnd", "MotionEnd", BlockKind::Motion);
}
