/// The reader's state and what requests do to it. Requests are rows of tables (request_table.h), grouped by
/// file.
#pragma once

#include <map>
#include <set>

#include "pipeline/rib/arguments.h"
#include "pipeline/rib/declarations.h"
#include "pipeline/rib/graphics_state.h"
#include "pipeline/rib/read_rib.h"

namespace trapeze::rib {

class Reader {
  public:
    Reader(const ReadOptions& options, Diagnostics& diagnostics,
           const std::function<void(Scene&&)>& on_world);

    void read_file(const std::string& path);
    void finish();
    ReadSummary& summary() { return summary_; }

    // --- what requests use
    // -------------------------------------------------------------------------------------------
    SourceLocation at() const { return at_; }
    void error(const std::string& text) { error(at_, text); }
    void error(SourceLocation at, const std::string& text);
    void warn_once(const std::string& text, const std::string& kind);

    Options& options() { return options_; }
    bool in_world() const { return in_world_; }
    Declarations& declarations() { return declarations_; }

    const AttributeState& attributes() const { return *state_.attributes; }
    AttributeState& change_attributes();
    GraphicsState& state() { return state_; }

    /// Name and value pairs to the end of the request; wrong ones are reported and left out.
    ParameterList parameters(ArgumentCursor& cursor);

    void begin_block(Block kind);
    /// False, with an error, when the innermost block is another.
    bool end_block(Block kind, const char* request);
    void end_transform();

    void begin_frame(int number);
    void end_frame();
    void begin_world();
    void end_world();
    void begin_motion(std::vector<float> times);
    void end_motion();
    void begin_object(const std::string& handle);
    void end_object();
    void instance(const std::string& handle);
    void read_archive(const std::string& name);

    void transform(TransformKind kind, TransformArguments arguments);
    /// Identity and Transform: relative to the world (or to the camera before it).
    void set_transform(const TransformArguments* matrix);
    void name_coordinate_system(const std::string& name);
    void use_coordinate_system(const std::string& name);
    M44f camera_from_current() const;

    void add_shape(std::string request, Shape shape, uint64_t faces);
    void add_light(std::shared_ptr<const LightInstance> light);
    std::shared_ptr<const LightInstance> light(const std::string& handle) const;
    std::shared_ptr<const ShaderInstance> shader(ArgumentCursor& cursor, const char* kind);

    void set_search_path(const std::string& category, const std::string& path);

  private:
    void read_text(std::string_view text, uint32_t source);
    void execute(RequestText& request);
    bool recording_archive(RequestText& request, Scanner& scanner, std::string_view text, size_t begin);
    void emit(const std::string& request, const std::vector<std::shared_ptr<const Shape>>& shapes,
              const std::vector<float>& times, const MovingTransform& transform,
              const AttributeState& attributes, SourceLocation at);
    void close_all_blocks();
    float displacement_length(const AttributeState& attributes, const M44f& camera_from_object) const;
    std::string current_file() const;  ///< the innermost that is a file on disk; may be empty
    std::optional<std::string> find_archive(const std::string& name) const;

    const ReadOptions& read_options_;
    Diagnostics& diagnostics_;
    const std::function<void(Scene&&)>& on_world_;
    ReadSummary summary_;
    Declarations declarations_;

    SourceLocation at_;  ///< of the request being executed
    std::string request_name_;
    Options options_;
    GraphicsState state_;
    std::vector<OpenBlock> blocks_;
    std::optional<MotionBlock> motion_;
    MovingTransform camera_;  ///< camera_from_world
    bool in_world_ = false, frame_wanted_ = true;
    Scene scene_;
    std::map<std::string, MovingTransform> named_spaces_;
    std::map<std::string, std::shared_ptr<const LightInstance>> lights_;

    std::map<std::string, std::vector<ObjectPrimitive>> objects_;
    std::optional<std::string> object_being_defined_;
    std::shared_ptr<const AttributeState> object_attributes_;  ///< at its beginning

    struct InlineArchive {
        std::shared_ptr<const std::string> text;
        SourceLocation at;
    };
    std::map<std::string, InlineArchive> inline_archives_;
    std::vector<std::string> open_files_;  ///< for recursion; the last is being read
};

/// Requests by name. Null for the known ones that are not supported; nothing for unknown names.
using RequestHandler = void (*)(Reader& reader, ArgumentCursor& cursor);
std::optional<RequestHandler> find_request(const std::string& name);
/// The known request most like a misspelt name, or nothing.
std::string suggestion_for(const std::string& name);

}  // namespace trapeze::rib
