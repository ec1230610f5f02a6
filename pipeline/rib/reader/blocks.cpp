/// Blocks: what they save and restore, and what becomes of unbalanced ones.
#include <algorithm>

#include "pipeline/rib/reader/reader.h"
#include "pipeline/rib/syntax/search_path.h"

namespace trapeze::rib {
namespace {

constexpr size_t kDeepestBlock = 10000;
constexpr float kMostSharpSamples = 4;  ///< along each side of a pixel

}  // namespace

const char* block_name(Block kind) {
    switch (kind) {
        case Block::Frame:
            return "FrameBegin";
        case Block::World:
            return "WorldBegin";
        case Block::Attribute:
            return "AttributeBegin";
        case Block::Transform:
            return "TransformBegin";
        case Block::Motion:
            return "MotionBegin";
        case Block::Object:
            return "ObjectBegin";
        case Block::Solid:
            return "SolidBegin";
    }
    return "";
}

void Reader::begin_block(Block kind) {
    if (motion_) throw RequestError{"inside a motion block", {}};
    if (blocks_.size() >= kDeepestBlock)
        throw RequestError{"blocks are nested more than " + std::to_string(kDeepestBlock) + " deep", {}};
    OpenBlock& block = blocks_.emplace_back();
    block.kind = kind, block.id = ++block_count_, block.at = at_, block.saved = state_;
}

bool Reader::is_open(Block kind) const {
    return std::any_of(blocks_.begin(), blocks_.end(), [&](const OpenBlock& b) { return b.kind == kind; });
}

void Reader::end_block(Block kind) {
    // Ends of blocks do not reach out of a world, but for FrameEnd.
    const auto begin = std::find_if(blocks_.rbegin(), blocks_.rend(), [&](const OpenBlock& block) {
        return block.kind == kind || (block.kind == Block::World && kind != Block::Frame);
    });
    if (begin == blocks_.rend() || begin->kind != kind) {
        error(std::string("no ") + block_name(kind) + " is open; ignored");
        return;
    }
    for (auto inner = blocks_.rbegin(); blocks_.back().kind != kind; inner = blocks_.rbegin()) {
        error(std::string(block_name(inner->kind)) + " of line " + std::to_string(inner->at.line) +
              " is still open; closed here");
        close_block();
    }
    close_block();
}

void Reader::close_block() {
    if (blocks_.back().kind == Block::World) deliver_world();
    OpenBlock block = std::move(blocks_.back());
    blocks_.pop_back();
    if (block.scope) scope_ = std::move(*block.scope);
    switch (block.kind) {
        case Block::Motion: {
            MotionBlock motion = std::move(*motion_);
            motion_.reset();
            finish_motion(std::move(motion));
            return;
        }
        case Block::Transform:  // attributes that changed since stay
            state_.transform = std::move(block.saved.transform);
            return;
        case Block::Frame:
            frame_wanted_ = true;
            break;
        case Block::World:
            in_world_ = false;
            break;
        case Block::Object:
            object_ = nullptr;
            break;
        case Block::Solid:
            close_solid();
            break;
        case Block::Attribute:
            break;
    }
    state_ = std::move(block.saved);
}

void Reader::open_scope() {
    blocks_.back().scope = std::make_unique<Scope>(scope_);
}

void Reader::begin_frame(int number) {
    if (in_world_) throw RequestError{"inside a world", {}};
    if (is_open(Block::Frame)) throw RequestError{"a frame is open already", {}};
    begin_block(Block::Frame);
    open_scope();
    scope_.options.frame = number;
    ++summary_.frames;
    frame_wanted_ = !read_options_.wants_frame || read_options_.wants_frame(number);
}

void Reader::begin_world() {
    if (in_world_) throw RequestError{"a world is open already", {}};
    begin_block(Block::World);
    open_scope();
    // Without it, as for shadow maps, all is seen as the shutter opens.
    if (scope_.options.hider_parameters.float_or("samplemotion", 1) == 0)
        scope_.options.shutter_close = scope_.options.shutter_open;
    camera_ = state_.transform;
    in_world_ = true;
    world_depth_ = open_files_.size();
    report_homeless();
    scene_ = Scene();
    solids_ = {};
    instanced_primitives_ = 0;
    scope_.named_spaces["world"] = camera_;
}

std::vector<std::string> Reader::folders(const std::string& category) const {
    const auto path = scope_.options.search_paths.find(category);
    std::vector<std::string> all;
    if (path != scope_.options.search_paths.end()) all = path->second;
    const std::string folder = current_folder().empty() ? "." : current_folder();
    all.insert(all.end(), {folder, ""});
    // Projects keep their scenes in a folder of their own, and name files from the one above.
    all.insert(all.end(), {folder + "/..", folder + "/../.."});
    const std::vector<std::string> usual = usual_folders(category, folder, access_);
    all.insert(all.end(), usual.begin(), usual.end());
    return all;
}

void Reader::make_map(MapRequest request) {
    if (in_world_) throw RequestError{"inside a world", {}};
    if (!frame_wanted_ || !read_options_.on_map) return;
    request.location = at_;
    request.folders = folders("texture");
    request.transfer = transfer_of(scope_.options);
    read_options_.on_map(request);
}

void Reader::deliver_world() {
    ++summary_.worlds;
    Options& options = scope_.options;
    const float open = options.shutter_open;
    // A hider's counts are of paths: where nothing is blurred, edges need fewer.
    if (!scope_.has_pixel_samples && options.f_stop >= kInfinity && options.shutter_close <= open) {
        options.samples_x = std::min(options.samples_x, kMostSharpSamples);
        options.samples_y = std::min(options.samples_y, kMostSharpSamples);
    }
    scene_.camera_from_world = M44f(camera_.at(open));
    for (const auto& [name, space] : scope_.named_spaces)
        scene_.camera_from_named[name] = M44f(space.at(open));
    for (const char* category : {"archive", "shader", "texture"})
        options.search_paths[category] = folders(category);
    const bool wanted = frame_wanted_ && (is_open(Block::Frame) || !read_options_.wants_frame ||
                                          read_options_.wants_frame(options.frame));
    scene_.solids = std::move(solids_.solids);
    scene_.options = std::move(options);
    scene_.clipping_planes = scope_.clipping_planes;
    resolved_ = {};
    light_world();
    if (wanted) on_world_(std::move(scene_));
    scene_ = Scene();
    scene_bytes_ = 0;
}

}  // namespace trapeze::rib
