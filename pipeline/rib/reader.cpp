#include "pipeline/rib/reader.h"

#include <algorithm>
#include <filesystem>

#include "pipeline/rib/source_text.h"

namespace trapeze::rib {
namespace {

constexpr size_t kDeepestInclude = 64;
constexpr size_t kDeepestBlock = 10000;

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
        case Block::Archive:
            return "ArchiveBegin";
    }
    return "";
}

std::shared_ptr<const AttributeState> default_attributes() {
    auto state = std::make_shared<AttributeState>();
    state->u_basis = state->v_basis = M44f(-1, 3, -3, 1, 3, -6, 3, 0, -3, 3, 0, 0, 1, 0, 0, 0);  // bezier
    return state;
}

}  // namespace

Reader::Reader(const ReadOptions& options, Diagnostics& diagnostics,
               const std::function<void(Scene&&)>& on_world)
    : read_options_(options), diagnostics_(diagnostics), on_world_(on_world) {
    state_.attributes = default_attributes();
}

void Reader::error(SourceLocation at, const std::string& text) {
    diagnostics_.error(at.line ? at : at_, request_name_ + ": " + text);
}

void Reader::warn_once(const std::string& text, const std::string& kind) {
    diagnostics_.warning(at_, request_name_ + ": " + text, kind);
}

AttributeState& Reader::change_attributes() {
    if (state_.attributes.use_count() > 1)
        state_.attributes = std::make_shared<AttributeState>(*state_.attributes);
    return const_cast<AttributeState&>(*state_.attributes);
}

// --- streams
// -------------------------------------------------------------------------------------------------------------

void Reader::read_file(const std::string& path) {
    std::string problem;
    auto source = read_source(path, read_options_.max_source_bytes, &problem);
    if (!source) {
        diagnostics_.error(at_, "cannot read \"" + path + "\": " + problem);
        return;
    }
    const uint32_t id =
        diagnostics_.add_source(path == "-" ? "<stdin>" : path, open_files_.empty() ? SourceLocation{} : at_);
    if (!source->problem.empty()) diagnostics_.error({id, 0, 0}, source->problem);
    ++summary_.files;
    summary_.bytes += source->text.size();
    open_files_.push_back(path);
    read_text(source->text, id);
    open_files_.pop_back();
}

void Reader::read_text(std::string_view text, uint32_t source) {
    Scanner scanner(text, source);
    RequestText request;
    const SourceLocation at = at_;
    const std::string name = request_name_;
    while (read_request(scanner, request, diagnostics_)) {
        const char* const begin = scanner.token_begin();
        if (request.name == "ArchiveBegin" && recording_archive(request, scanner, text, begin - text.data()))
            continue;
        execute(request);
    }
    at_ = at, request_name_ = name;
}

bool Reader::recording_archive(RequestText& request, Scanner& scanner, std::string_view text, size_t begin) {
    at_ = request.at, request_name_ = request.name;
    ++summary_.requests[request.name];
    std::string handle;
    try {
        handle = ArgumentCursor(request).handle("the archive's name");
    } catch (const RequestError& problem) {
        error(problem.at, problem.text + "; the archive is read past");
    }
    const SourceLocation opened = request.at;
    int depth = 1;
    while (true) {
        const size_t end = static_cast<size_t>(scanner.token_begin() - text.data());
        if (!read_request(scanner, request, diagnostics_)) {
            error(opened, "ArchiveEnd is missing; the archive ends with the file");
            inline_archives_[handle] = {std::make_shared<const std::string>(text.substr(begin)), opened};
            return true;
        }
        depth += request.name == "ArchiveBegin" ? 1 : request.name == "ArchiveEnd" ? -1 : 0;
        if (depth > 0) continue;
        if (!handle.empty())
            inline_archives_[handle] = {std::make_shared<const std::string>(text.substr(begin, end - begin)),
                                        opened};
        return true;
    }
}

void Reader::execute(RequestText& request) {
    at_ = request.at, request_name_ = request.name;
    const auto handler = find_request(request.name);
    if (!handler) {
        const std::string like = suggestion_for(request.name);
        diagnostics_.error(at_, request.name + ": no such request" +
                                    (like.empty() ? "" : " (did you mean " + like + "?)") +
                                    "; skipped to the next one");
        return;
    }
    ++summary_.requests[request.name];
    if (!*handler) {
        ++summary_.unsupported[request.name];
        diagnostics_.warning(at_, request.name + " is not supported yet; skipped",
                             "unsupported-" + request.name);
        return;
    }
    if (!request.problem.empty()) {
        error(request.problem_at, request.problem + "; request skipped");
        return;
    }
    try {
        ArgumentCursor cursor(request);
        (*handler)(*this, cursor);
        if (!cursor.done())
            error(cursor.peek()->at, "more arguments than the request has; the rest is ignored");
    } catch (const RequestError& problem) {
        error(problem.at, problem.text + "; request skipped");
    }
}

std::string Reader::current_file() const {
    for (size_t i = open_files_.size(); i-- > 0;)
        if (open_files_[i] != "-" && open_files_[i][0] != '<') return open_files_[i];
    return {};
}

std::optional<std::string> Reader::find_archive(const std::string& name) const {
    namespace fs = std::filesystem;
    std::error_code ignored;
    const fs::path path(name);
    if (path.is_absolute()) return fs::exists(path, ignored) ? std::optional(name) : std::nullopt;
    std::vector<std::string> folders;
    folders.push_back(fs::path(current_file()).parent_path());
    if (const auto paths = options_.search_paths.find("archive"); paths != options_.search_paths.end())
        folders.insert(folders.end(), paths->second.begin(), paths->second.end());
    folders.push_back("");
    for (const std::string& folder : folders)
        if (const fs::path candidate = fs::path(folder) / path; fs::is_regular_file(candidate, ignored))
            return candidate.string();
    return {};
}

void Reader::read_archive(const std::string& name) {
    if (open_files_.size() >= kDeepestInclude) {
        error("archives are nested more than " + std::to_string(kDeepestInclude) + " deep; \"" + name +
              "\" not read");
        return;
    }
    if (const auto archive = inline_archives_.find(name); archive != inline_archives_.end()) {
        const std::string key = "<archive " + name + ">";
        if (std::find(open_files_.begin(), open_files_.end(), key) != open_files_.end()) {
            error("the archive \"" + name + "\" reads itself; not read again");
            return;
        }
        const auto text = archive->second.text;  // stays while it is read, whatever is defined meanwhile
        const uint32_t id = diagnostics_.add_source(key, at_);
        open_files_.push_back(key);
        read_text(*text, id);
        open_files_.pop_back();
        return;
    }
    const auto path = find_archive(name);
    if (!path) {
        error("\"" + name + "\" is not found; nothing read");
        return;
    }
    if (std::find(open_files_.begin(), open_files_.end(), *path) != open_files_.end()) {
        error("\"" + name + "\" reads itself; not read again");
        return;
    }
    read_file(*path);
}

void Reader::finish() {
    close_all_blocks();
}

void Reader::close_all_blocks() {
    while (!blocks_.empty()) {
        const OpenBlock& block = blocks_.back();
        diagnostics_.error(
            block.at, std::string(block_name(block.kind)) + ": never closed; closed at the end of the input");
        switch (block.kind) {
            case Block::World:
                end_world();
                break;
            case Block::Frame:
                end_frame();
                break;
            case Block::Motion:
                end_motion();
                break;
            case Block::Object:
                end_object();
                break;
            default:
                end_block(block.kind, "");
        }
    }
}

// --- blocks
// --------------------------------------------------------------------------------------------------------------

void Reader::begin_block(Block kind) {
    if (blocks_.size() >= kDeepestBlock) throw RequestError{"blocks are nested more than 10000 deep", {}};
    OpenBlock& block = blocks_.emplace_back();
    block.kind = kind, block.at = at_, block.saved = state_;
}

bool Reader::end_block(Block kind, const char* request) {
    if (blocks_.empty() || blocks_.back().kind != kind) {
        const bool open =
            std::any_of(blocks_.begin(), blocks_.end(), [&](const OpenBlock& b) { return b.kind == kind; });
        if (!open) {
            error(std::string("no ") + block_name(kind) + " is open; ignored");
            return false;
        }
        // Close what was left open within.
        while (blocks_.back().kind != kind) {
            const Block inner = blocks_.back().kind;
            if (inner == Block::World && kind != Block::Frame) {
                error(std::string("no ") + block_name(kind) + " is open in this world; ignored");
                return false;
            }
            error(std::string(block_name(inner)) + " of line " + std::to_string(blocks_.back().at.line) +
                  " is still open; closed here");
            if (inner == Block::Motion)
                end_motion();
            else if (inner == Block::Object)
                end_object();
            else if (inner == Block::Transform)
                end_transform();
            else if (inner == Block::World)
                end_world();
            else
                end_block(inner, request);
        }
    }
    if (kind != Block::Motion && kind != Block::Solid) state_ = blocks_.back().saved;
    blocks_.pop_back();
    return true;
}

void Reader::end_transform() {
    // TransformBegin saves the transformation alone; attributes that changed since stay.
    const auto attributes = state_.attributes;
    if (end_block(Block::Transform, "TransformEnd")) state_.attributes = attributes;
}

void Reader::begin_frame(int number) {
    if (in_world_) throw RequestError{"inside a world", {}};
    begin_block(Block::Frame);
    blocks_.back().saved_options = options_;
    options_.frame = number;
    ++summary_.frames;
    frame_wanted_ = !read_options_.wants_frame || read_options_.wants_frame(number);
}

void Reader::end_frame() {
    Options saved;
    for (const OpenBlock& block : blocks_)
        if (block.kind == Block::Frame) saved = block.saved_options;
    if (!end_block(Block::Frame, "FrameEnd")) return;
    options_ = std::move(saved);
    frame_wanted_ = true;
}

void Reader::begin_world() {
    if (in_world_) throw RequestError{"a world is open already", {}};
    begin_block(Block::World);
    blocks_.back().saved_options = options_;
    camera_ = state_.transform;
    in_world_ = true;
    scene_ = Scene();
    named_spaces_["world"] = camera_;
}

void Reader::end_world() {
    Options saved;
    for (const OpenBlock& block : blocks_)
        if (block.kind == Block::World) saved = block.saved_options;
    if (!end_block(Block::World, "WorldEnd")) return;
    in_world_ = false;
    ++summary_.worlds;
    scene_.options = options_;
    const std::string folder = std::filesystem::path(current_file()).parent_path().string();
    for (const char* category : {"archive", "shader", "texture"})
        scene_.options.search_paths[category].insert(scene_.options.search_paths[category].end(),
                                                     {folder.empty() ? "." : folder, ""});
    scene_.camera_from_world = M44f(camera_.at(options_.shutter_open));
    for (const auto& [name, space] : named_spaces_)
        scene_.camera_from_named[name] = M44f(space.at(options_.shutter_open));
    const bool wanted =
        frame_wanted_ && (options_.frame != 0 || !read_options_.wants_frame || read_options_.wants_frame(0));
    if (wanted) on_world_(std::move(scene_));
    scene_ = Scene();
    options_ = std::move(saved);
    lights_.clear();
}

// --- motion
// --------------------------------------------------------------------------------------------------------------

void Reader::begin_motion(std::vector<float> times) {
    if (motion_) throw RequestError{"motion blocks do not nest", {}};
    if (times.empty()) throw RequestError{"no times", {}};
    for (size_t i = 1; i < times.size(); ++i)
        if (!(times[i] > times[i - 1])) throw RequestError{"times must grow", {}};
    begin_block(Block::Motion);
    motion_.emplace();
    motion_->at = at_;
    motion_->times = std::move(times);
}

void Reader::end_motion() {
    if (!motion_) {
        error("no MotionBegin is open; ignored");
        return;
    }
    MotionBlock block = std::move(*motion_);
    motion_.reset();
    if (!end_block(Block::Motion, "MotionEnd")) return;
    const size_t given = std::max(block.transforms.size(), block.shapes.size());
    if (given == 0) return;
    const bool complete = given == block.times.size();
    if (!complete)
        error(block.request + " occurs " + std::to_string(given) + " times for " +
              std::to_string(block.times.size()) + " times of the motion; the first is used");
    if (!block.transforms.empty()) {
        if (block.absolute) state_.transform = in_world_ ? camera_ : MovingTransform();
        if (complete)
            state_.transform.concat(
                MovingFactor{block.transform_kind, std::move(block.times), std::move(block.transforms)});
        else
            state_.transform.concat(transform_matrix(block.transform_kind, block.transforms[0]));
        return;
    }
    if (!complete) block.shapes.resize(1), block.times.resize(1);
    const SourceLocation now = at_;
    at_ = block.at;
    if (object_being_defined_)
        objects_[*object_being_defined_].push_back(
            {block.request, block.shapes, block.times, state_.transform, state_.attributes, block.at});
    else
        emit(block.request, block.shapes, block.times, state_.transform, *state_.attributes, block.at);
    at_ = now;
}

// --- transforms
// ----------------------------------------------------------------------------------------------------------

void Reader::transform(TransformKind kind, TransformArguments arguments) {
    if (!motion_) {
        state_.transform.concat(transform_matrix(kind, arguments));
        return;
    }
    if (motion_->request.empty()) motion_->request = request_name_, motion_->transform_kind = kind;
    if (motion_->request != request_name_ || !motion_->shapes.empty())
        throw RequestError{"a motion block of " + motion_->request, {}};
    motion_->transforms.push_back(std::move(arguments));
}

void Reader::set_transform(const TransformArguments* matrix) {
    if (motion_) {
        motion_->absolute = true;
        transform(TransformKind::Matrix,
                  matrix ? *matrix : TransformArguments{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
        return;
    }
    state_.transform = in_world_ ? camera_ : MovingTransform();
    if (matrix) state_.transform.concat(transform_matrix(TransformKind::Matrix, *matrix));
}

void Reader::name_coordinate_system(const std::string& name) {
    named_spaces_[name] = state_.transform;
}

void Reader::use_coordinate_system(const std::string& name) {
    const auto space = named_spaces_.find(name);
    if (name == "camera")
        state_.transform = MovingTransform();
    else if (space == named_spaces_.end())
        throw RequestError{"no coordinate system \"" + name + "\"", {}};
    else
        state_.transform = space->second;
}

M44f Reader::camera_from_current() const {
    return M44f(state_.transform.at(options_.shutter_open));
}

}  // namespace trapeze::rib

namespace trapeze {

ReadSummary read_rib(std::span<const std::string> files, const ReadOptions& options, Diagnostics& diagnostics,
                     const std::function<void(Scene&&)>& on_world) {
    rib::Reader reader(options, diagnostics, on_world);
    for (const std::string& file : files) reader.read_file(file);
    reader.finish();
    return std::move(reader.summary());
}

}  // namespace trapeze
