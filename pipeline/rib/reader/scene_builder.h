/// What is read becomes Scenes: worlds, their primitives and lights, objects and solids.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pipeline/rib/reader/file_search.h"
#include "pipeline/rib/reader/motion_collector.h"
#include "pipeline/rib/reader/name_counts.h"
#include "pipeline/rib/reader/request_report.h"
#include "pipeline/rib/state/graphics_state_stack.h"
#include "pipeline/rib/state/ready_archive.h"

namespace trapeze::rib {

enum class FarShape;

/// Owns the Scene that is being made, and the object that is being defined. Geometry that a handler has
/// checked comes in by one door, add_shape(): from there it goes into the open motion block, into the object,
/// or into the Scene, with the current attributes and at the motion keys of the shutter.
class SceneBuilder {
  public:
    /// Called within the reading, once for each world that is wanted; the Scene is the receiver's to keep.
    using OnWorld = std::function<void(Scene&&)>;

    /// `place`: where the stream of requests stands. All are kept by reference.
    SceneBuilder(const ReadOptions& options, RequestReport& report, GraphicsStateStack& state,
                 MotionCollector& motion, ArchivePlace& place, const FileSearch& search,
                 const OnWorld& on_world)
        : read_options_(options),
          report_(report),
          state_(state),
          motion_(motion),
          place_(place),
          search_(search),
          on_world_(on_world) {}

    // --- frames and worlds ---
    void begin_frame(int number);
    void end_frame() { frame_is_wanted_ = true; }
    /// Whether the worlds and maps of the open frame are to be made, and programs run for them.
    bool frame_is_wanted() const { return frame_is_wanted_; }
    void begin_world();
    /// Completes the Scene and hands it to on_world. To be called as the world ends, while its options and
    /// names are still there.
    void deliver_world();
    /// Hands on a request that is complete but for its place and folders.
    void make_map(MapRequest request);

    // --- objects (RISpec 5.9) and solids (5.7) ---
    void begin_object(const std::string& handle);
    void end_object();
    void instance(const std::string& handle);
    void begin_solid(Solid::Operation operation);
    void end_solid();

    // --- geometry ---
    /// Whether a world or an object is open to take it. What stands before all worlds may be an archive,
    /// which is said at the end of the input; geometry between worlds is a RequestError.
    bool takes_geometry();
    /// Says what takes_geometry() has turned away, now that the first world begins, or none came.
    void report_turned_away();
    /// A primitive of `faces` faces, counted under the name of its request.
    void add_shape(const std::string& request, Shape&& shape, uint64_t faces);
    /// The primitive of a motion block that ended.
    void add_moving_shape(MovingShape moving);

    // --- lights ---
    /// Adds a light that shines on the primitives to come.
    void add_light(std::shared_ptr<const LightInstance> light);
    /// Adds a light that shines on all of the world, or on where its object is placed (RIS). False, and said,
    /// where there are too many.
    bool add_world_light(std::shared_ptr<const LightInstance> light);
    /// What the camera sees of a light that was added to the world, if Attribute "visibility" lets it.
    void add_light_surface(const LightInstance& light);
    /// Geometry too far away to be seen, for the light that waits for its shape, if one does. `angle`: that
    /// which a FarShape::Direction takes in the sky, in degrees; 0 if unknown.
    void place_far_emitter(FarShape shape, float angle = 0);
    /// Null when there is none of that handle.
    std::shared_ptr<const LightInstance> light(const std::string& handle) const;

  private:
    /// Solids within an object are numbered from 0 there, and get numbers of the scene when it is placed.
    SolidList& solids_here() { return object_ ? object_->solids : solids_; }
    int solid_of_surface(SolidList& list);
    int place_solids(const SolidList& object);
    void place_instance(ObjectPrimitive& primitive, GraphicsState state, int solid);

    /// By lights of an object: the emitters that stand for them in an instance.
    using PlacedEmitters = std::map<const LightInstance*, std::shared_ptr<Emitter>>;
    PlacedEmitters place_lights(const RetainedObject& object);
    void place_emitter(const AttributeState& state, const Shape& shape, const M44f& camera_from_shape);
    void add_strays(std::vector<std::shared_ptr<const LightInstance>>& lights);
    void light_world();
    void report_quantized();

    /// Else primitives are checked and counted, and their memory is given back at once.
    bool keeps_geometry() const { return read_options_.keep_geometry && frame_is_wanted_; }
    /// Estimates, since sharing and allocation are not seen exactly: a guard against files made to exhaust
    /// memory.
    bool has_room(uint64_t bytes);
    /// Archives that are read a thousand times have one set of points in memory this way, not a thousand.
    ShapePointer shared_or_new(Shape&& shape);
    void add_to_object(std::string request, std::vector<ShapePointer> shapes, std::vector<float> times,
                       SourceLocation at);
    void emit(const std::string& request, ShapeKeys shape_keys, const GraphicsState& state, SourceLocation at,
              int solid);
    std::shared_ptr<const Attributes> resolved_attributes(const GraphicsState& state,
                                                          std::span<const M44f> camera_from_object,
                                                          bool mirrored);
    float displacement_length(const GraphicsState& state, std::span<const M44f> camera_from_object);

    using SpacesPointer = std::shared_ptr<const NamedSpaces>;
    SpacesPointer placed_spaces(const RetainedObject& object, const SpacesPointer& of_primitive) const;
    bool remember_spaces(const SpacesPointer& spaces);
    void bind_spaces();

    const ReadOptions& read_options_;
    RequestReport& report_;
    GraphicsStateStack& state_;
    MotionCollector& motion_;
    ArchivePlace& place_;
    const FileSearch& search_;
    const OnWorld& on_world_;

    bool frame_is_wanted_ = true;
    Scene scene_;                             ///< of the open world
    SolidList solids_;                        ///< the scene's
    std::shared_ptr<RetainedObject> object_;  ///< being defined; null: none
    uint64_t instanced_primitives_ = 0;       ///< of this world
    int instances_ = 0;                       ///< of this world, so far
    int instance_ = -1;                       ///< the one whose primitives are emitted now; -1: none
    uint64_t scene_bytes_ = 0;                ///< of this world's primitives, and of objects before it

    /// Primitives before the first world.
    struct {
        uint64_t count = 0;
        SourceLocation first;
        std::string request;
    } turned_away_;

    /// Primitives of the scene in whose place coordinate systems hold that do not hold for all.
    std::vector<std::pair<size_t, std::shared_ptr<const NamedSpaces>>> in_spaces_;

    NameCounts primitive_counts_;

    /// Where a primitive is in the shutter.
    struct Place {
        SharedPoses poses;
        double determinant = 0;  ///< of the first; what is not finite has none
    };
    Place place_of(const MovingTransform& transform, const ShapeKeys& shape_keys);
    /// The last place that did not move, and the transformation that led there, which nobody changes from now
    /// on: this is a copy.
    struct {
        std::optional<MovingTransform> transform;
        float open = 0, close = 0;
        Place place;
    } last_place_;

    /// The last primitive's attributes, for the next ones that look alike.
    struct {
        std::shared_ptr<const AttributeState> state;
        std::shared_ptr<const Attributes> attributes;
    } resolved_;
};

}  // namespace trapeze::rib
