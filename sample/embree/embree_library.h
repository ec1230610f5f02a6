/// What the method "embree" asks of Embree, in the module "embree".
#pragma once

#include <memory>
#include <span>
#include <string>

#include "core/files/module.h"
#include "core/grid.h"
#include "core/simd/simd_limit.h"
#include "core/stats.h"
#include "sample/visibility.h"

namespace trapeze {

/// How much work Embree puts into its tree, in its own three steps.
enum class EmbreeQuality { Low, Medium, High };

/// How rays are handed to Embree: one at a time, in packets of 8 or 16 that its kernels trace together, or in
/// streams of any number, which it makes packets of itself. Fastest: what was measured to be the fastest with
/// the geometry and the motion at hand.
enum class EmbreeMode { Fastest, Single, Packet8, Packet16, Stream };

/// What the method's options and the scene decide. Clipping planes are in camera-space z, like hits' depths.
struct EmbreeChoices {
    bool quads = false;  ///< else grids
    EmbreeQuality quality = EmbreeQuality::Medium;
    EmbreeMode mode = EmbreeMode::Fastest;
    bool motion = false;                ///< some grid moves
    std::string device;                 ///< the device's configuration, in Embree's words
    float near_clip = 0, far_clip = 0;  ///< hits are between, the far end included
};

/// The device's configuration: Embree is held to what our own vector code may use, so that both can be
/// compared. Threads are those of the calling task arena.
inline std::string embree_device() {
    const std::string_view limit = simd_limit();
    if (limit == "sse4") return "isa=sse4.2";
    if (limit == "avx2") return "isa=avx2";
    return "";
}

/// A tree of Embree's over grids, which outlive it.
class EmbreeTracer {
  public:
    virtual ~EmbreeTracer() = default;

    /// Traces samples in an order: scratch.nearest[sample] becomes the nearest opaque hit where there is one;
    /// the others before it, in any order and some more than once, come to the end of `layers`. Thread-safe.
    virtual void trace(const SampleTile& samples, std::span<const uint32_t> order, SampleScratch& scratch,
                       std::vector<LooseHits::Entry>& layers) const = 0;
    /// As the library's structure was built; holds as long as the tracer.
    virtual const BuildStats& stats() const = 0;
};

/// What the module offers: the program itself is not linked with Embree.
class EmbreeLibrary {
  public:
    /// Throws where Embree does not run or memory does not suffice.
    virtual std::unique_ptr<EmbreeTracer> build(const Grids& grids, const EmbreeChoices& choices) const = 0;

  protected:
    ~EmbreeLibrary() = default;
};

/// Null, with *problem set, where the module cannot be opened.
const EmbreeLibrary* embree_library(std::string* problem);

}  // namespace trapeze

extern "C" {
[[gnu::visibility("default")]] extern const trapeze::ModuleEntry trapeze_embree_module;
}
