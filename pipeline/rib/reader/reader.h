/// The reader's state and what requests do to it. Requests are rows of tables (request_table.h), grouped by
/// file. The members are in reader.cpp (streams), archives.cpp, blocks.cpp, conditional_blocks.cpp,
/// motion_blocks.cpp, objects.cpp, parameters.cpp, reader_scene.cpp and world_lights.cpp.
#pragma once

#include <map>
#include <set>

#include "pipeline/rib/programs/programs.h"
#include "pipeline/rib/read_rib.h"
#include "pipeline/rib/state/declarations.h"
#include "pipeline/rib/state/deforming_shape.h"
#include "pipeline/rib/state/graphics_state.h"
#include "pipeline/rib/state/ready_archive.h"
#include "pipeline/rib/syntax/arguments.h"
#include "pipeline/rib/syntax/conditions.h"

namespace trapeze::rib {

/// What becomes of parameters that nobody declared: primitives leave them out, options and attributes keep
/// them as what they look like; so do shaders, which know better what they are and say what they do not have.
enum class Undeclared { LeaveOut, Guess };

struct Request;
enum class FarShape;

class Reader {
  public:
    Reader(const ReadOptions& options, Diagnostics& diagnostics,
           const std::function<void(Scene&&)>& on_world);

    /// A file that an archive request names, under what it may reach.
    void read_file(const std::string& path) { read_file(path, access_); }
    void read_file(const std::string& path, const Access& access);
    void read_memory(std::string_view text, const std::string& name);
    /// Whether what is read now is the user's own, and not a scene.
    void set_trusted(bool is_trusted) { trusted_ = is_trusted; }
    void finish();
    ReadSummary& summary() { return summary_; }

    // --- what requests use ---
    SourceLocation at() const { return at_; }
    void error(const std::string& text) { error(at_, text); }
    void error(SourceLocation at, const std::string& text);
    void warn_once(const std::string& text, const std::string& kind);

    Scope& scope() { return scope_; }
    Options& options() { return scope_.options; }
    bool in_world() const { return in_world_; }
    /// In a world that another file opened: what is read now may be a whole scene of its own.
    bool in_archive_of_world() const { return in_world_ && open_files_.size() > world_depth_; }
    bool in_motion() const { return motion_.has_value(); }
    std::map<std::string, DisplayChannel>& display_channels() { return scope_.display_channels; }
    Declarations& declarations() { return declarations_; }

    const AttributeState& attributes() const { return *state_.attributes; }
    AttributeState& change_attributes();
    GraphicsState& state() { return state_; }

    /// Name and value pairs to the end of the request; wrong ones are reported and left out.
    ParameterList parameters(ArgumentCursor& cursor, Undeclared undeclared = Undeclared::LeaveOut);
    /// Those of a shader: each has one value (which may be an array).
    ParameterList shader_parameters(ArgumentCursor& cursor);

    /// Colours as the file gives them, as RGB (ColorSamples).
    std::vector<float> rgb(std::vector<float> samples) const;
    size_t samples_per_color() const { return scope_.color_samples ? scope_.color_samples->samples : 3; }

    void begin_block(Block kind);
    void end_block(Block kind);

    void begin_frame(int number);
    void begin_world();
    void begin_motion(std::vector<float> times);
    void begin_object(const std::string& handle);
    void begin_solid(Solid::Operation operation);
    void instance(const std::string& handle);
    void read_archive(const std::string& name);

    void transform(TransformKind kind, TransformArguments arguments);
    /// Identity and Transform: relative to the world, to the camera before it, to the object in its
    /// definition.
    void set_transform(const TransformArguments* matrix);
    void name_coordinate_system(const std::string& name);
    /// The name ends with the block.
    void name_scoped_coordinate_system(const std::string& name);
    void use_coordinate_system(const std::string& name);
    M44f camera_from_current() const;
    /// The current coordinate system, as the shutter opens. Camera space is left-handed.
    bool is_right_handed() const;

    void add_shape(std::string request, Shape shape, uint64_t faces);
    void add_light(std::shared_ptr<const LightInstance> light);
    /// One that shines on all of the world, or on where its object is placed (RIS).
    void add_world_light(std::shared_ptr<const LightInstance> light);
    /// Geometry too far away to be seen, for the light that waits for its shape, if one does.
    void place_far_emitter(FarShape shape, float angle = 0);
    std::shared_ptr<const LightInstance> light(const std::string& handle) const;
    /// The name of a shader, placed in the current space; its other arguments are still to come.
    ShaderInstance shader(ArgumentCursor& cursor, const char* kind);

    /// The request is complete but for its place and folders.
    void make_map(MapRequest request);

    // --- procedurals ---
    void delayed_archive(const std::string& name);
    /// A command: words apart by spaces. The bound may be empty: not known.
    void run_program(const std::string& command, const std::string& data, const std::vector<float>& bound);
    void load_procedural(const std::string& library, const std::string& data,
                         const std::vector<float>& bound);
    /// Reads the answer; `kind` and `shown` are what messages call it.
    void ask_program_for_rib(const char* kind, const std::string& shown,
                             const std::vector<std::string>& command, const std::string& data,
                             const std::vector<float>& bound);

    /// Of a box in the current space: xmin xmax ymin ymax zmin zmax.
    void set_detail(const std::vector<float>& bound);

    // --- saved attributes (PRMan's Resource), which no block but their own restores ---
    void save_state(const std::string& name);
    /// False when there is none of that name.
    bool restore_state(const std::string& name, bool attributes, bool transform);
    void begin_resources();
    void end_resources();

    /// ErrorHandler (RISpec 3): Print is the default.
    enum class OnError { Print, Ignore, Abort };
    void set_error_handler(OnError handler);

    /// The request was understood as one that is not honoured.
    void count_unsupported() { ++summary_.unsupported[request_name_]; }
    /// It was understood, but changes nothing; `what` follows the request's name.
    void count_without_effect(const std::string& what = {}) {
        ++summary_.without_effect[request_name_ + what];
    }

    /// It asks for what is so in any case; `what` says why.
    void count_settled(const std::string& what) { ++summary_.settled[request_name_ + what]; }

    void set_search_path(const std::string& category, const std::string& path);

    // --- parts of a stream that are read but not executed ---
    void if_begin(const std::string& expression);
    /// Else: null.
    void else_if(const std::string* expression);
    void if_end();
    /// Begins or ends a block that is skipped whole; the request's name says which.
    void skip_block();
    /// What `name` stands for in conditions: an attribute or option, "Attribute:" or "Option:" before it or
    /// not, else a variable of the environment.
    ConditionValue variable(const std::string& name) const;

  private:
    struct Conditional {
        std::string_view name;  ///< of the request that opened it
        SourceLocation at;
        bool outer_skips;  ///< nothing in it is executed, whatever its conditions say
        bool active;       ///< what comes now is executed
        bool taken;        ///< a branch has been
        bool had_else;
    };
    static bool is_conditional(std::string_view request);
    bool is_skipping() const { return !conditionals_.empty() && !conditionals_.back().active; }
    bool holds(const std::string& expression);
    void push_conditional(std::string_view name, bool active);
    Conditional& open_conditional(std::string_view name);
    void close_conditionals();
    void substitute(RequestText& request) const;

    /// `ready`: an archive, for the next time; null when it is no archive.
    void read_text(std::string_view text, SourceLocation first, EncodedNames names = {},
                   ReadyArchive* ready = nullptr);
    /// The same of a text that was read before.
    void read_again(ReadyArchive& ready, uint32_t source);
    template <class Read>
    void in_stream(ReadyArchive* ready, Read&& read);
    bool reads_next(Lexer& lexer, RequestText& request, ReadyArchive* ready);
    std::shared_ptr<ReadyArchive> ready_archive(const std::string& path);
    std::shared_ptr<const Shape> shared_or_new(Shape shape);
    void execute(RequestText& request);
    bool hands_on(const RequestText& request);
    std::string current_file() const;  ///< the innermost that is a file on disk; may be empty
    std::string current_folder() const;

    void record_archive(RequestText& request, Lexer& lexer, std::string_view text);
    std::optional<std::string> find_archive(const std::string& name);
    std::optional<std::string> find_archive_named(const std::string& name) const;
    /// An empty key: one that may read itself.
    bool may_read_archive(const std::string& name, const std::string& key);

    bool is_open(Block kind) const;
    /// Closes the innermost block.
    void close_block();
    void open_scope();
    void deliver_world();
    /// Those of the search path, and the file's.
    std::vector<std::string> folders(const std::string& category) const;

    /// Attributes and options in a motion block: carried out at its end, once, as the shutter opens.
    void hold_in_motion(RequestText text);
    void carry_out_held(std::vector<RequestText> keys, const std::vector<float>& times);
    void carry_out(const Request& request, RequestText& text);
    void finish_motion(MotionBlock block);
    MovingTransform root_transform() const;

    SolidList& solids_here() { return object_ ? object_->solids : solids_; }
    int solid_of_surface(SolidList& list);
    int place_solids(const SolidList& object);
    void place_instance(ObjectPrimitive& primitive, const std::shared_ptr<const AttributeState>& attributes,
                        int solid);
    void close_solid();
    void place_lights(const RetainedObject& object);
    void place_emitter(const Shape& shape);
    void add_strays(std::vector<std::shared_ptr<const LightInstance>>& lights);
    void light_world();

    /// `solid` is the scene's that the primitive bounds, or -1.
    bool takes_geometry();
    void report_homeless();
    /// Adds to what the world's primitives take; false, and an error, when that is too much.
    bool has_room(uint64_t bytes);
    bool keeps_geometry() const { return read_options_.keep_geometry && frame_wanted_; }
    void emit(const std::string& request, std::vector<ShapePointer> keys, const MovingTransform& transform,
              const std::shared_ptr<const AttributeState>& attributes, SourceLocation at, int solid);
    std::shared_ptr<const Attributes> resolved_attributes(const std::shared_ptr<const AttributeState>& state,
                                                          const std::vector<M44f>& camera_from_object);
    float raster_area(const std::vector<float>& bound) const;
    bool takes_procedural();
    template <class Read>
    void read_in_block(Read&& read);
    const MovingTransform* named_space(const std::string& name) const;
    bool is_stopped();
    Severity severity_of_errors() const {
        return on_error_ == OnError::Ignore ? Severity::Warning : Severity::Error;
    }
    void report(Severity severity, SourceLocation at, const std::string& text, const std::string& kind);
    void report_unknown(const std::string& request);
    float displacement_length(const AttributeState& attributes, const std::vector<M44f>& camera_from_object);

    const ReadOptions& read_options_;
    Access everything_;
    Access& access_;
    bool trusted_ = false;
    Diagnostics& diagnostics_;
    const std::function<void(Scene&&)>& on_world_;
    ReadSummary summary_;
    Declarations declarations_;

    SourceLocation at_;  ///< of the request being executed
    std::string request_name_;
    /// The last name looked up: requests mostly come in rows. `count` is in the summary.
    struct {
        std::string name;
        const Request* request = nullptr;
        uint64_t* count = nullptr;
    } last_request_;
    std::set<std::string> kinds_, unknown_requests_;  ///< of messages and of names that were shown
    Scope scope_;
    GraphicsState state_;
    std::vector<OpenBlock> blocks_;
    uint64_t block_count_ = 0;
    Programs programs_;
    std::optional<MotionBlock> motion_;
    MovingTransform camera_;  ///< camera_from_world
    bool in_world_ = false, frame_wanted_ = true;
    Scene scene_;
    SolidList solids_;                   ///< the scene's
    uint64_t instanced_primitives_ = 0;  ///< of this world
    uint64_t scene_bytes_ = 0;           ///< of this world's primitives, and of objects before it
    /// Primitives before the first world.
    struct {
        uint64_t count = 0;
        SourceLocation first;
        std::string request;
    } homeless_;
    std::shared_ptr<RetainedObject> object_;  ///< being defined

    /// The last primitive's, for the next ones that look alike.
    struct {
        std::shared_ptr<const AttributeState> state;
        std::shared_ptr<const Attributes> attributes;
    } resolved_;

    struct InlineArchive {
        std::shared_ptr<const std::string> text;
        SourceLocation first;  ///< the place of its first character
        EncodedNames names;    ///< what was defined before it
        std::shared_ptr<ReadyArchive> ready;
    };
    std::map<std::string, InlineArchive> inline_archives_;
    using SavedStates = std::map<std::string, GraphicsState>;
    std::shared_ptr<const SavedStates> saved_states_ = std::make_shared<SavedStates>();
    std::vector<std::shared_ptr<const SavedStates>> saved_states_blocks_;
    OnError on_error_ = OnError::Print;
    uint64_t errors_before_abort_ = 0;  ///< when ErrorHandler "abort" was read
    bool stopped_ = false;

    std::vector<Conditional> conditionals_;
    size_t first_conditional_ = 0;  ///< of the stream being read; those before it belong to outer streams
    std::vector<std::string> open_files_;  ///< for recursion; the last is being read
    size_t world_depth_ = 0;               ///< of them, as the world was opened
    uint64_t archives_read_ = 0;

    struct KnownFile {
        FileStamp stamp;
        std::shared_ptr<ReadyArchive> ready;
    };
    std::map<std::string, KnownFile> known_files_;  ///< archives, by path
    uint64_t ready_bytes_left_;                     ///< of what archives that are read again may take
    /// Where in archives the request stands that is carried out: of the stream being read.
    struct {
        ReadyArchive* archive = nullptr;
        size_t request = 0, shapes = 0;
    } place_;
};

/// Transforms and geometry have a motion of their own; attributes and options in a motion block have their
/// values as the shutter opens.
enum class RequestGroup { Structure, Option, Attribute, Transform, Geometry, Unsupported };

using RequestHandler = void (*)(Reader& reader, ArgumentCursor& cursor);

struct Request {
    RequestHandler handler = nullptr;  ///< null: known, not supported
    RequestGroup group = RequestGroup::Unsupported;
};

/// Null for unknown names.
const Request* find_request(std::string_view name);
bool is_request(std::string_view name);
/// All known ones, sorted.
std::vector<std::string> request_names();
/// The known request most like a misspelt name, or nothing.
std::string suggestion_for(const std::string& name);

}  // namespace trapeze::rib
