/// The lights that shine on a grid, each run once for the grid's points, when first asked for.
#pragma once

#include <deque>
#include <memory>
#include <vector>

#include "shade/materials/bound_shader.h"
#include "shade/materials/scene_spaces.h"

namespace trapeze {

/// A light of the scene, ready to run.
struct Lamp {
    std::unique_ptr<SceneSpaces> spaces;  ///< spaces by name, as the light's shader sees them
    std::unique_ptr<BoundShader> shader;
    V3f position;               ///< the origin of its shader space, in camera space: P of the light shader
    bool asks_surface = false;  ///< by surface(): for variables of the surface that it shines on
};

/// Runs lights for one grid after another and keeps what arrives, so that several illuminance loops over the
/// same points cost one run of each light. One per thread.
class LightRig : public vm::Lights {
  public:
    /// Begins with the lights of a grid. `surroundings` is the surface's context; `N` are its normals (3
    /// planes of `lanes` lanes, or none). All must outlive the use.
    void start(vm::Machine& machine, const std::vector<const Lamp*>& lamps, const vm::Context& surroundings,
               size_t lanes, const Plane3& N);

    size_t count() const override { return lamps_ ? lamps_->size() : 0; }
    const Arriving& arriving(size_t light, const vm::Operand& P, bool lasting) override;
    bool in_category(size_t light, std::string_view wanted) override;

    /// The light's variables, for lightsource(), once it has run; null before.
    const vm::Registers* registers(size_t light) const;
    const Lamp& lamp(size_t light) const { return *(*lamps_)[light]; }

  private:
    /// What one light sends to the grid's points.
    struct Slot {
        Arriving arriving;
        bool lasts = false;   ///< `arriving` holds until the next start()
        size_t capacity = 0;  ///< lanes that `planes` have room for
        std::unique_ptr<float, void (*)(void*)> planes{nullptr, nullptr};
    };
    void run(size_t light, Slot& slot, const vm::Operand& P);
    void set_variables(vm::Registers& registers, const Lamp& lamp, const vm::Operand& P) const;

    vm::Machine* machine_ = nullptr;
    const std::vector<const Lamp*>* lamps_ = nullptr;
    const vm::Context* surroundings_ = nullptr;
    size_t lanes_ = 0;
    Plane3 N_;
    std::deque<Slot> slots_;
};

}  // namespace trapeze
