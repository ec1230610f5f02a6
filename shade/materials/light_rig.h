/// The lights that shine on a grid, each run once for the grid's points, when first asked for.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "shade/materials/area_samples.h"
#include "shade/materials/lamp.h"

namespace trapeze {

/// Runs lights for one grid after another and keeps what arrives, so that several illuminance loops over the
/// same points cost one run of each light. An area light counts as many lights, each of them at another place
/// of its shape, and what arrives from each is divided by their number [decision 0030]. Where a surface turns
/// and its rays have times of their own, each sample sees it as it lies then: what arrives is turned back to
/// how it is shaded, as the shutter opens. A light that is given values runs for itself each time, and what
/// is kept of it stays. One per thread.
class LightRig : public vm::Lights {
  public:
    /// Begins with the lights of a grid, which are all that light it, or some of these: they then shine as
    /// they do together. `surroundings` is the surface's context; `N` are its normals (3 planes of `lanes`
    /// lanes, or none); `seed` that of the render; `held` is Scene::held_from_camera. All must outlive the
    /// use.
    void start(vm::Machine& machine, const std::vector<const Lamp*>& lamps,
               const std::vector<const Lamp*>& all, const vm::Context& surroundings, size_t lanes,
               const Plane3& N, uint32_t seed = 0, std::span<const M44f> held = {});

    size_t count() const override { return turns_.size(); }
    Task<const Arriving*> arriving(size_t light, const vm::LightRequest& request) override;
    bool in_category(const Arriving& light, std::string_view wanted) override;
    bool in_loop(const Arriving& light, std::string_view wanted) override;

    const Lamp& lamp(size_t light) const { return *(*lamps_)[turns_[light].lamp]; }

    /// All lights of a surface together run so often for a point: area lights take fewer samples than asked
    /// for where there are more, in proportion.
    static constexpr int kMostTurns = 2048;

  private:
    /// What counts as a light: a lamp, or one sample of an area light.
    using Turn = AreaSamples::Turn;
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
    static bool is_of_sample(vm::Predefined variable);
    void set_variables(vm::Registers& registers, const Lamp& lamp, const vm::Operand& P) const;
    std::optional<float> number_of(vm::Predefined variable) const;
    std::optional<vm::Operand> footprint_plane(vm::Predefined variable) const;
    void set_ray(const vm::Operand& out, bool way, const vm::Operand& P) const;

    vm::Machine* machine_ = nullptr;
    const std::vector<const Lamp*>* lamps_ = nullptr;
    const vm::Context* surroundings_ = nullptr;
    size_t lanes_ = 0;
    Plane3 N_;
    std::vector<Turn> turns_;
    std::deque<Slot> slots_;
    std::deque<Slot> told_;  ///< of lights that are given values, by the depth of the block that does so
    AreaSamples samples_;    ///< of the turn that is run
};

}  // namespace trapeze
