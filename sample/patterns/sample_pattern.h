/// Where, when and through which point of the lens samples look. The pattern is chosen apart from the
/// visibility method; every method has a natural one, and a method may honour only some.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/samples.h"
#include "core/scene/render_context.h"
#include "sample/names/method_spec.h"
#include "sample/patterns/lens_shape.h"
#include "sample/patterns/sample_levels.h"

namespace trapeze {

/// Makes the samples of any rectangle of pixels, from any thread; nothing is remembered between calls. Random
/// numbers are hashes of pixel, sample and use (core/random.h), never a state: so tiles may be made in any
/// order and size.
class SamplePattern {
  public:
    virtual ~SamplePattern() = default;

    /// All samples of a rectangle of pixels. What a pixel gets depends on the pixel alone.
    virtual void make_tile(const PixelRect& pixels, SampleTile& tile) const = 0;

    int sample_count() const { return nx_ * ny_; }  ///< of a pixel

    /// The levels that the context asks for; null where it asks for none, or the pattern has none.
    virtual const SampleLevels* levels() const { return nullptr; }
    /// Which of the levels' variants a pixel has.
    virtual size_t variant_of(const PixelPlace&) const { return 0; }
    /// What levels `from` to `to` add in some pixels of a rectangle, level by level. Of a pattern with
    /// levels.
    virtual void make_levels(const PixelRect&, std::span<const PixelPlace>, int, int, SampleTile&) const {}

  protected:
    explicit SamplePattern(const RenderContext& context)
        : camera_(context.camera),
          lens_(context.camera.aperture),
          nx_(std::max(1, context.samples_x)),
          ny_(std::max(1, context.samples_y)),
          seed_(context.seed),
          motion_(context.motion) {}

    /// An empty tile of these pixels, with room for their samples.
    void begin_tile(const PixelRect& pixels, SampleTile& tile) const {
        tile.pixels = pixels;
        tile.listed.clear(), tile.in_pixel.clear();
        tile.samples_per_pixel = sample_count();
        tile.resize(static_cast<size_t>(pixels.width()) * pixels.height() * tile.samples_per_pixel);
    }

    Camera camera_;
    LensShape lens_;
    int nx_, ny_;  ///< regions of a pixel, a sample each
    uint32_t seed_;
    bool motion_;
};

/// A row of the table of patterns.
struct PatternKind {
    std::string_view name;
    std::vector<SpecOption> options;
    std::unique_ptr<SamplePattern> (*make)(const RenderContext& context, const MethodSpec& spec);
};

/// The table of all patterns, in the order in which messages list them.
const std::vector<PatternKind>& sample_patterns();

/// Reads the name of a pattern, as "stratified", against the table. Empty with *error set when it is wrong.
std::optional<MethodSpec> parse_pattern(std::string_view text, std::string* error);

/// `spec` is parse_pattern's.
std::unique_ptr<SamplePattern> make_sample_pattern(const RenderContext& context, const MethodSpec& spec);

}  // namespace trapeze
