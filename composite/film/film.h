/// The film: filtered sums of samples, and the picture they make.
///
/// The picture is the same bit for bit for any order of tiles, any number of threads, any split into regions,
/// and a crop equals the same pixels of the whole picture [decision 0003]. So no two tiles add to the same
/// sum: each has its own, over its pixels and those around that its samples reach, filled in the order of the
/// samples. A pixel is finished by adding the sums of the tiles around it in the order of the tiles, as soon
/// as the last of these has come; then sums that nobody waits for are freed, so that memory holds the picture
/// and a frontier of tiles. A pixel's samples are summed together (pixel_summer.h): colours, and output
/// variables (aov.h) if there are any.
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "composite/film/film_rules.h"
#include "composite/film/film_tiles.h"
#include "composite/film/finished_tiles.h"
#include "composite/film/sample_sink.h"
#include "composite/filters/filters.h"
#include "composite/image.h"
#include "core/scene/aov.h"
#include "core/scene/render_context.h"

namespace trapeze {

struct FilmPart;
struct PixelRecord;
class AwaitedTiles;
class GatheredSamples;

class Film final : public SampleSink {
  public:
    /// Reads the crop, PixelFilter, Exposure and Hider of the context's scene. Image::id is recorded when
    /// asked for here, or by a Display of mode "id".
    /// `leave_gamma`: Exposure's gamma is not applied, but its gain; what comes after adds up light.
    explicit Film(const RenderContext& context, bool record_ids = false, bool leave_gamma = false);
    ~Film() override;
    Film(const Film&) = delete;
    Film& operator=(const Film&) = delete;

    /// Adds what samples see: of a rectangle whose sides lie at multiples of kTileSide or at those of
    /// sampled_pixels(). How the picture is cut into such rectangles changes no bit of it. Thread-safe; each
    /// square of kTileSide once (a second time it is ignored).
    void add(const SampleTile& samples, const HitBuffer& hits, const Grids& grids) override;
    void add(const SampleTile& samples, const LayerStack& stack) override;
    void begin_stack(size_t sample_count, LayerStack& stack) const override;

    /// Adds pixels with numbers of samples of their own, gathered by the film's rules; rectangles as above.
    void add(const GatheredSamples& gathered);
    /// What it wants of samples; as long as the film lives.
    const FilmRules& rules() const { return rules_; }

    /// The picture. Pixels that still wait for tiles are made of those that came. Call once, after the last
    /// add().
    Image finish();

    /// Before finish(): the picture as it becomes, of which only what finished_pixels() names may be read.
    const Image& unfinished() const { return image_; }
    int tile_count() const { return tiles_.count(); }
    /// The pixels of a tile whose colours, depths, ids and variables are finished: none, then those that no
    /// other tile's samples reach, then all that are kept. Thread-safe.
    PixelRect finished_pixels(int tile) const;

    /// Numbers of the tiles whose pixels are finished, in order. Thread-safe, as write_finished().
    std::vector<int> finished_tiles() const;
    /// The tiles that are finished in the end: all that have pixels of the picture.
    size_t picture_tiles() const;
    /// Writes the finished tiles, while others may be added. False when `write` was.
    bool write_finished(const WriteBytes& write) const;
    /// Takes tiles that write_finished() of a film of the same picture has written, before the first add().
    /// False when they are none of this film's; it is of no use then.
    bool read_finished(const ReadBytes& read);
    /// Whether anything is seen in the tiles that were taken.
    bool took_something() const { return took_something_; }
    /// The tiles that have not been added.
    AwaitedTiles awaited_tiles() const;
    /// Whether a rectangle has pixels of such a tile. Thread-safe.
    bool awaits(const PixelRect& pixels) const;

    /// Bytes of the sums that wait for their neighbours.
    size_t waiting_bytes() const { return waiting_bytes_.load(std::memory_order_relaxed); }

  private:
    void add_part(const FilmPart& part);
    /// Adds the tiles that a rectangle has pixels of: sums_of(pixels) makes a tile's sums.
    template <class SumsOf>
    void add_tiles(const PixelRect& pixels, const SumsOf& sums_of);
    template <class SumsOf>
    void add_tile(int tile, const PixelRect& pixels, const SumsOf& sums_of);

    void accumulate(const FilmPart& part, TileSums& sums);
    FinishedTilesHeader finished_tiles_header() const;
    bool takes_pixel(int px, int py) const;
    void record_pixel(int px, int py, const PixelRecord& record);
    std::unique_ptr<TileSums> make_sums(const PixelRect& tile, bool colored) const;
    void rank_mattes(int tile, const PixelRect& pixels);
    void finish_tile(int tile);
    void develop_inner(int tile, const TileSums& sums);
    void develop_rest(int tile);
    template <class ForSums>
    void develop(const PixelRect& pixels, const ForSums& for_sums);
    void release(int tile);
    void expose(float* rgba) const;

    AovLayout aovs_;
    FilterKernel kernel_;
    MatteKeys matte_keys_;
    std::optional<FilterKernel> matte_kernel_;  ///< where mattes are asked for
    FilmRules rules_;
    std::atomic<float> matte_loss_{0};
    float gain_ = 1, inverse_gamma_ = 1;
    FilmTiles tiles_;
    std::atomic<size_t> waiting_bytes_{0};
    bool took_something_ = false;
    Image image_;
};

}  // namespace trapeze
