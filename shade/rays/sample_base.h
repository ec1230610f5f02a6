/// Where the rays of a point begin: at the point, or spread over the micropolygon that it stands for
/// ("samplebase"), so that neighbouring points do not all miss the same.
#pragma once

#include "shade/rays/ray_arguments.h"
#include "shade/rays/ray_asker.h"

namespace trapeze {

class SampleBase {
  public:
    explicit SampleBase(const vm::Run& run) : batch_(run.context().batch) {}

    /// The origin of a lane's ray: P, moved along the sides of its micropolygon by up to half of the part
    /// that "samplebase" asks for.
    V3f origin(const V3f& P, const RayArguments& arguments, const RayLane& lane, int sample) const;

  private:
    const vm::Batch* batch_;
};

}  // namespace trapeze
