/// The imager shader, which works on the finished picture's pixels (RISpec 3.2, figure 4.2 and section 14.4;
/// Imager): after exposure, before quantization.
#pragma once

#include <memory>

#include "core/files/access.h"
#include "core/scene/render_context.h"

namespace trapeze {

class BoundShader;

/// A scene's imager shader, ready to run; or none, and then pictures stay as they are.
class Imager {
  public:
    /// Finds the shader that Options::imager names, or a scene's own of the name "glow" where Options::glow
    /// asks for it, which needs none (core/scene/glow.h). One that is not known, is no imager
    /// or has errors is reported; then there is none, or `background` in place of one that had a background
    /// colour. The context, its scene and `access`, to files, must outlive this.
    explicit Imager(const RenderContext& context, const Access& access = kEverything);
    ~Imager();

    bool is_there() const;
    bool is_own_glow() const;           ///< the scene's own shader is run in place of Imager "glow"
    const BoundShader* shader() const;  ///< null: none

    /// Runs the shader over one row of pixels in place: `count` of them, red green blue alpha each, from
    /// pixel (x0, y) on. Thread-safe; what becomes of a pixel depends on the pixel alone.
    ///
    /// The shader sees (table 12.5) P, the raster position of the pixel's centre, z 0; s and u, t and v, the
    /// same from 0 to 1 over the whole picture, whatever is cropped; Ci; alpha; Oi, which
    /// is alpha in all channels as no more is kept; ncomps, time and dtime. Afterwards Ci and alpha count.
    /// Values that are not finite become 0.
    void run(int x0, int y, int count, float* rgba) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace trapeze
