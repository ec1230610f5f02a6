/// What happens to a picture after its film: it glows, then an imager shader runs over its pixels.
#pragma once

#include <optional>

#include "composite/image.h"
#include "core/files/access.h"
#include "core/scene/glow.h"
#include "core/scene/render_context.h"
#include "shade/imager.h"

namespace trapeze {

class PostEffects {
  public:
    /// Finds the imager and the glow that the scene asks for. `asked` and `access` outlive this.
    PostEffects(const RenderContext& asked, const Access& access);

    /// The context of what is to be rendered for them: as asked, with the margin around the crop that glows
    /// into the picture.
    const RenderContext& context() const { return context_; }
    /// Whether the film is to leave Exposure's gamma to apply(): light glows before it.
    bool takes_gamma() const { return glow_.has_value(); }
    /// Applies them to the picture of context(), and trims it to the crop that was asked for. False when
    /// cancelled half way.
    bool apply(Image& image) const;

  private:
    const RenderContext& asked_;
    Imager imager_;
    std::optional<Glow> glow_;
    RenderContext context_;
};

}  // namespace trapeze
