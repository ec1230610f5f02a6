/// How much memory a frame may take, what of it is for what, and whether its picture fits.
#pragma once

#include <cstddef>
#include <string>

#include "core/scene/render_context.h"
#include "pipeline/frame/render_settings.h"

namespace trapeze {

/// Three quarters of the machine's memory, in bytes.
size_t default_memory_budget();

/// A frame's memory budget in bytes, and its parts.
class MemoryBudget {
  public:
    explicit MemoryBudget(const RenderSettings& settings)
        : bytes_(settings.memory_bytes ? settings.memory_bytes : default_memory_budget()) {}

    size_t bytes() const { return bytes_; }
    /// For point clouds that shaders look up; small ones are read in any case.
    size_t for_clouds() const;
    /// For the grids and the tree of a region; what rays of shaders meet has the other half.
    size_t for_region(bool has_ray_world) const { return has_ray_world ? bytes_ / 2 : bytes_; }

  private:
    size_t bytes_;
};

/// For the lists of hits of all threads, in bytes, beside the grids and the tree of a region that may take
/// `region_bytes`.
size_t hit_list_bytes(size_t region_bytes);

/// "1.5 MiB", "240 MiB": small amounts to a tenth, so that none is said to be nothing.
std::string mebibytes_text(double bytes);

/// The Diagnostic::kind of the error that the machine's memory cannot hold the picture.
inline constexpr const char* kPictureTooLarge = "picture-too-large";

/// Whether the machine's memory can hold the picture, asked before it is made; if not, an error says what
/// would help.
bool picture_fits(const RenderContext& context, const RenderSettings& settings);

}  // namespace trapeze
