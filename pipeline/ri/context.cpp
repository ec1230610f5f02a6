#include "pipeline/ri/context.h"

#include <algorithm>

namespace trapeze::ri {
namespace {

/// All contexts of the process, and which of them calls go to.
struct Contexts {
    std::vector<std::unique_ptr<Context>> all;
    Context* current = nullptr;
    RibFormat next_format;
};

/// RISpec's calls name no context: which one they mean is the process's.
Contexts& contexts() {
    static Contexts the;
    return the;
}

const char* name_of(BlockKind block) {
    constexpr const char* kNames[rib::kBlockKinds] = {"Frame",  "World",  "Attribute", "Transform",
                                                      "Motion", "Object", "Solid"};
    return kNames[static_cast<size_t>(block)];
}

}  // namespace

void Context::open(BlockKind block) {
    const bool in_motion = !blocks_.empty() && blocks_.back().kind == BlockKind::Motion;
    const bool is_frame = block == BlockKind::Frame, is_world = block == BlockKind::World;
    const bool too_late = is_open(BlockKind::World) || (is_frame && is_open(BlockKind::Frame));
    if (in_motion || ((is_frame || is_world) && too_late))
        throw CallError{RIE_NESTING, std::string("not within Ri") + name_of(blocks_.back().kind) + "Begin"};
    blocks_.push_back({block, counting, spaces.current(), spaces.camera});
}

void Context::close(BlockKind block) {
    if (blocks_.empty()) throw CallError{RIE_NESTING, "no block is open"};
    const BlockOfCalls& innermost = blocks_.back();
    if (innermost.kind != block)
        throw CallError{RIE_NESTING,
                        std::string("the innermost block is Ri") + name_of(innermost.kind) + "Begin"};
    if (block == BlockKind::World) spaces.end_world();
    if (block != BlockKind::Motion) spaces.restore(innermost.current);
    if (block != BlockKind::Motion && block != BlockKind::Transform) counting = innermost.counting;
    if (block == BlockKind::Frame) spaces.camera = innermost.camera;
    blocks_.pop_back();
}

bool Context::is_open(BlockKind block) const {
    return std::any_of(blocks_.begin(), blocks_.end(),
                       [&](const BlockOfCalls& open) { return open.kind == block; });
}

void Context::expect_options() const {
    if (is_open(BlockKind::World)) throw CallError{RIE_NOTOPTIONS, "options cannot change within a world"};
}

bool Context::counts() {
    return blocks_.empty() || blocks_.back().kind != BlockKind::Motion || blocks_.back().calls++ == 0;
}

void Context::complain(RtInt code, RtInt severity, std::string text) {
    messages_.push_back({code, severity, std::move(text)});
}

std::vector<Message> Context::take_messages() {
    return std::exchange(messages_, {});
}

Context* current_context() {
    return contexts().current;
}

void begin_context(const std::string& name, RibFormat format) {
    contexts().all.push_back(std::make_unique<Context>(name, format));
    contexts().current = contexts().all.back().get();
}

std::unique_ptr<Context> take_current_context() {
    auto& all = contexts().all;
    const auto place =
        std::find_if(all.begin(), all.end(), [](const auto& one) { return one.get() == contexts().current; });
    if (place == all.end()) return {};
    std::unique_ptr<Context> taken = std::move(*place);
    all.erase(place);
    contexts().current = nullptr;
    return taken;
}

bool select_context(const void* handle) {
    for (const auto& one : contexts().all)
        if (one.get() == handle) {
            contexts().current = one.get();
            return true;
        }
    return false;
}

RibFormat& next_format() {
    return contexts().next_format;
}

}  // namespace trapeze::ri
