/// The rays of a gather block: traced for all lanes together, told turn by turn.
#pragma once

#include <string>
#include <vector>

#include "shade/rays/ray_arguments.h"
#include "shade/rays/ray_asker.h"
#include "shade/rays/sample_base.h"

namespace trapeze {

/// One gather block that is being run, in one thread. Rays are diffuse where they are spread by the cosine,
/// else specular. All it refers to must outlive it.
class GatherCall final : public vm::GatherTurns {
  public:
    GatherCall(const RayAsker& asker, RayGrounds& grounds, std::vector<RayLane> lanes, vm::Run& run,
               const vm::Step& step, std::span<const vm::Operand> operands);

    Task<bool> next(vm::Run& run, const uint32_t* live) override;
    const float* hits() const override { return hits_.data(); }
    const float* misses() const override { return misses_.data(); }

  private:
    /// What an output is filled with.
    enum class From : uint8_t { Color, Opacity, Answer, Origin, Direction, Length };
    struct Output {
        From from;
        int width;  ///< numbers
        vm::Operand operand;
        size_t answer = 0;  ///< of Answer: index in asked_
    };
    static constexpr size_t kNone = ~size_t{0};

    void add_output(std::string_view name, int width, const vm::Operand& operand, vm::Run& run,
                    const vm::Step& step);
    Task<> send(const uint32_t* live);
    void add_rays(size_t number, int first, int count);
    bool asks_distance() const { return !colors_ && asked_.empty(); }
    Task<> follow();
    void tell(const RayLane& lane, const WalkedRay& ray) const;

    const RayAsker& asker_;
    RayGrounds& grounds_;
    const std::vector<RayLane> lanes_;
    const RayArguments arguments_;
    const SampleBase base_;
    bool traces_ = true;  ///< else all rays miss: "samplepattern"
    std::vector<Output> outputs_;
    HitOutputs asked_;
    bool colors_ = false;  ///< outputs ask what rays see
    RayKind kind_ = RayKind::Specular;

    // Turns turn_ .. sent_ - 1 have been traced, for the lanes that were live then.
    int turn_ = 0, sent_ = 0, most_ = 0, first_sent_ = 0;
    std::vector<size_t> first_rays_;  ///< of lanes_: the ray of turn first_sent_; kNone: it sends none
    std::vector<WalkedRay> rays_;
    RayStarts starts_;
    std::vector<float> answers_;
    std::vector<float> sent_numbers_;  ///< of all lanes_, arguments_.sent.size() each
    std::vector<float> hits_, misses_;
};

}  // namespace trapeze
