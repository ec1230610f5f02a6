/// Unbalanced blocks: what is still open inside of a block that ends is closed with it, each with an error,
/// so that one missing AttributeEnd costs one message and not the rest of the scene.
#include "pipeline/rib/reader/block_ends.h"

#include <algorithm>

#include "pipeline/rib/reader/request_executor.h"

namespace trapeze::rib {
namespace {

/// What a procedural's block looks like to ReadOptions::on_request: no such request stands in the file. It
/// has the place of the procedural.
RequestText bare_request(const char* name, SourceLocation at) {
    RequestText request;
    request.name = name, request.at = at;
    return request;
}

/// The text of an error about it.
std::string still_open(const OpenBlock& block) {
    return std::string(block_name(block.kind)) + " of line " + std::to_string(block.at.line) +
           " is still open; closed here";
}

}  // namespace

/// A world is a wall for ends of blocks: one AttributeEnd too many in an archive must not close the block
/// around the world.
void BlockEnds::end(BlockKind kind) {
    const auto& blocks = state_.blocks();
    const auto begin = std::find_if(blocks.rbegin(), blocks.rend(), [&](const OpenBlock& block) {
        return block.kind == kind || (block.kind == BlockKind::World && kind != BlockKind::Frame);
    });
    if (begin == blocks.rend() || begin->kind != kind) {
        report_.error(std::string("no ") + block_name(kind) + " is open; ignored");
        return;
    }
    while (blocks.back().kind != kind) {
        report_.error(still_open(blocks.back()));
        close_innermost();
    }
    close_innermost();
}

/// Worlds that were never closed are delivered all the same: a file that was cut off shows what it has. From
/// the innermost outwards, as their ends would have come.
void BlockEnds::end_all() {
    while (!state_.blocks().empty()) {
        const OpenBlock& block = state_.blocks().back();
        report_.set_request(block.at, block_name(block.kind));
        report_.error("never closed; closed at the end of the input");
        close_innermost();
    }
}

/// The world is delivered before its options are restored; all else follows once the state is what it was.
void BlockEnds::close_innermost() {
    const BlockKind kind = state_.blocks().back().kind;
    if (kind == BlockKind::World) scene_.deliver_world();
    state_.close();
    if (kind == BlockKind::Motion) finish_motion();
    if (kind == BlockKind::Frame) scene_.end_frame();
    if (kind == BlockKind::Object) scene_.end_object();
    if (kind == BlockKind::Solid) scene_.end_solid();
}

/// Attributes first: the primitive of the block, if it has one, takes the state as it is then.
void BlockEnds::finish_motion() {
    MotionBlock block = motion_.take();
    for (const std::vector<RequestText>& keys : block.held) executor_.execute_held(keys, block.times);
    if (auto moving = motion_.resolve(std::move(block))) scene_.add_moving_shape(std::move(*moving));
}

/// Returns the depth of the block; with its id that tells later whether it is still open.
size_t BlockEnds::begin_attribute_block() {
    state_.open(BlockKind::Attribute, report_.at());
    executor_.hands_on(bare_request("AttributeBegin", report_.at()));
    return state_.blocks().size();
}

/// The id guards against a stream that closes the block itself and opens another at the same depth: that one
/// is not ours to close.
void BlockEnds::end_attribute_block(size_t depth, uint64_t id) {
    const auto& blocks = state_.blocks();
    while (blocks.size() > depth && blocks[depth - 1].id == id) {
        report_.error(still_open(blocks.back()));
        close_innermost();
    }
    executor_.hands_on(bare_request("AttributeEnd", report_.at()));
    // What was read may have closed this block too.
    if (blocks.size() >= depth && blocks[depth - 1].id == id) close_innermost();
}

}  // namespace trapeze::rib
