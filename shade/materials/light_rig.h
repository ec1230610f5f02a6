/// The lights that shine on a grid, each run once for the grid's points, when first asked for.
#pragma once

#include <deque>
#include <memory>
#include <vector>

#include "core/scene/light_shape.h"
#include "core/scene/motion_turn.h"
#include "shade/lights/light_sampler.h"
#include "shade/materials/bound_shader.h"
#include "shade/materials/scene_spaces.h"

namespace trapeze {

/// A light of the scene, ready to run.
struct Lamp {
    std::unique_ptr<SceneSpaces> spaces;  ///< spaces by name, as the light's shader sees them
    std::unique_ptr<BoundShader> shader;
    /// The same with varying parameters where illuminance of any shader of the scene may send values for
    /// them ("send:light:NAME"); null where there are none.
    std::unique_ptr<BoundShader> told;
    V3f position;               ///< the origin of its shader space, in camera space: P of the light shader
    bool asks_surface = false;  ///< by surface(): for variables of the surface that it shines on
    /// What it shines from, where its shader asks for points of that; else null.
    const LightInstance* area = nullptr;
    /// Of that: at shutter open, and of a light that moves in the middles of equal parts of the shutter, too
    /// (middle_of_part()). Null where it is nothing: the light is dark then.
    std::vector<std::unique_ptr<LightSampler>> samplers;

    bool moves() const { return samplers.size() > 1; }
    /// The nearest time at which its sampler has the light just where rays meet it; 0, shutter open, is one.
    float time_near(float time) const;
    const LightSampler* sampler_at(float time) const;
    size_t parts() const { return samplers.size() - 1; }

    /// How often the light's shader is run for a point, each time from another place.
    int turns() const;
};

/// Runs lights for one grid after another and keeps what arrives, so that several illuminance loops over the
/// same points cost one run of each light. An area light counts as many lights, each of them at another place
/// of its shape, and what arrives from each is divided by their number [decision 0030]. Where a surface turns
/// and its rays have times of their own, each sample sees it as it lies then: what arrives is turned back to
/// how it is shaded, as the shutter opens. A light that is given values runs for itself each time, and what
/// is kept of it stays. One per thread.
class LightRig : public vm::Lights {
  public:
    /// Begins with the lights of a grid. `surroundings` is the surface's context; `N` are its normals (3
    /// planes of `lanes` lanes, or none); `seed` that of the render; `held` is Scene::held_from_camera. All
    /// must outlive the use.
    void start(vm::Machine& machine, const std::vector<const Lamp*>& lamps, const vm::Context& surroundings,
               size_t lanes, const Plane3& N, uint32_t seed = 0, std::span<const M44f> held = {});

    size_t count() const override { return turns_.size(); }
    Task<const Arriving*> arriving(size_t light, const vm::LightRequest& request) override;
    bool in_category(const Arriving& light, std::string_view wanted) override;

    const Lamp& lamp(size_t light) const { return *(*lamps_)[turns_[light].lamp]; }

    /// All lights of a surface together run so often for a point: area lights take fewer samples than asked
    /// for where there are more, in proportion.
    static constexpr int kMostTurns = 2048;

  private:
    /// What counts as a light: a lamp, or one sample of an area light.
    struct Turn {
        uint32_t lamp = 0;
        int sample = 0, samples = 1;
    };
    /// What one light sends to the grid's points.
    struct Slot {
        Arriving arriving;
        bool lasts = false;   ///< `arriving` holds until the next start()
        size_t capacity = 0;  ///< lanes that `planes` have room for
        std::unique_ptr<float, void (*)(void*)> planes{nullptr, nullptr};
    };
    /// A parameter of a light and the value that it is given.
    struct Taken {
        size_t parameter = 0;  ///< index in the program's
        const vm::SentValue* value = nullptr;
    };
    std::vector<Taken> taken_by(const Lamp& lamp, const vm::LightRequest& request) const;
    void give(vm::Registers& registers, std::span<const Taken> taken, const uint32_t* lanes) const;
    Task<> run(size_t light, Slot& slot, const vm::LightRequest& request, std::span<const Taken> taken);
    void tell(const Turn& turn, const vm::LightOutput& output, const vm::Registers& registers, Slot& slot);
    void set_variables(vm::Registers& registers, const Lamp& lamp, const vm::Operand& P) const;
    V3f eye_way(const V3f& point) const;
    void set_ray(const vm::Operand& out, bool way, const vm::Operand& P) const;
    void find_surface_motion(std::span<const M44f> held);
    std::vector<float> sample(const Turn& turn, const Lamp& lamp, const vm::Operand& P);
    void turn_back(float* L) const;
    void set_sample(vm::Registers& registers, const Lamp& lamp) const;

    vm::Machine* machine_ = nullptr;
    const std::vector<const Lamp*>* lamps_ = nullptr;
    const vm::Context* surroundings_ = nullptr;
    size_t lanes_ = 0;
    Plane3 N_;
    uint32_t seed_ = 0;
    std::vector<Turn> turns_;
    std::deque<Slot> slots_;
    bool has_times_ = false;                 ///< some surface's rays have times of their own
    std::vector<MotionTurn> surface_turns_;  ///< of each grid, where it has
    std::deque<Slot> told_;       ///< of lights that are given values, by the depth of the block that does so
    std::vector<float> samples_;  ///< of the turn that is run: places, normals, solid angles and radiances
    std::vector<float>
        turned_;  ///< of the turn that is run: at which time each vertex' surface lies as sampled
};

}  // namespace trapeze
