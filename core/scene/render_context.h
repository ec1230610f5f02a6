/// What every stage of a render may read; nothing is global [decision 0021].
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

#include "core/diagnostics.h"
#include "core/scene/camera.h"
#include "core/scene/layer_limit.h"
#include "core/scene/scene.h"

namespace trapeze {

class ColorManagement;

/// Values that hold for one render. Copied freely; the scene and the diagnostics must outlive all copies.
struct RenderContext {
    const Scene* scene = nullptr;
    Camera camera;
    int samples_x = 2, samples_y = 2;  ///< of a pixel along each axis, at least 1
    int sample_levels = 1;             ///< above 1: pixels may stop at a quarter, at most so often less one
    float pixel_variance = 0;          ///< at which they stop
    uint32_t seed = 0;
    uint32_t most_layers = kAllLayers;              ///< that a sample sees, the nearest
    bool float_colors = false;                      ///< a picture holds more of colours than halves do
    bool motion = false;                            ///< the shutter is open for some time and something moves
    std::shared_ptr<const ColorManagement> colors;  ///< null: files are as Option "color" "transfer" says
    bool lacks_colors = false;  ///< they were asked for in vain, which is reported: nothing is rendered
    Diagnostics* diagnostics = nullptr;  ///< the one thing here that is written to; thread-safe
    const std::atomic<bool>* cancelled = nullptr;

    bool is_cancelled() const { return cancelled && cancelled->load(std::memory_order_relaxed); }
};

}  // namespace trapeze
