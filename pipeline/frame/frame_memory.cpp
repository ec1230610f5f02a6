#include "pipeline/frame/frame_memory.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "composite/film/film.h"
#include "composite/mattes/matte_layers.h"
#include "core/scene/glow.h"

namespace trapeze {
namespace {

constexpr int kPictureChannels = 6;  ///< colour, opacity, depth and a weight or id, of four bytes each
constexpr int kPreviewChannels = 5;  ///< colour, opacity and depth, for whoever is watching
constexpr int kGlowChannels = 9;     ///< light spread along rows, three times

/// Point clouds may take a part of the memory budget, but for small ones so much.
constexpr size_t kLeastCloudBytes = size_t{1} << 26;

/// Lists of hits may take this part of the memory budget, beside a region's grids and tree.
constexpr size_t kListsShare = 8;

/// Bytes of physical memory; two gibibytes where the system does not tell.
size_t machine_memory() {
    const long pages = sysconf(_SC_PHYS_PAGES), page_bytes = sysconf(_SC_PAGE_SIZE);
    if (pages <= 0 || page_bytes <= 0) return size_t{1} << 31;
    return static_cast<size_t>(pages) * static_cast<size_t>(page_bytes);
}

}  // namespace

size_t default_memory_budget() {
    return machine_memory() / 4 * 3;
}

size_t MemoryBudget::for_clouds() const {
    return std::max(bytes_ / 4, kLeastCloudBytes);
}

size_t hit_list_bytes(size_t region_bytes) {
    return region_bytes / kListsShare;
}

std::string mebibytes_text(double bytes) {
    const double mebibytes = bytes / (1 << 20);
    return fmt::format("{:.{}f} MiB", mebibytes, mebibytes < 10 ? 1 : 0);
}

bool picture_fits(const RenderContext& context, const RenderSettings& settings) {
    const PixelRect pixels = sampled_pixels(context.camera, context.scene->options);
    if (pixels.empty()) return true;
    const int aovs = aov_layout(context.scene->options).channel_count;
    const int channels = kPictureChannels + aovs + (settings.watcher ? kPreviewChannels + aovs : 0) +
                         kMatteFloats * static_cast<int>(matte_layers(context.scene->options).size()) +
                         (find_glow(context.scene->options, nullptr) ? kGlowChannels : 0);
    const double bytes = 4.0 * channels * pixels.width() * pixels.height();
    // A stranger's has what there is for all.
    const size_t most =
        settings.access->is_confined() && settings.memory_bytes ? settings.memory_bytes : machine_memory();
    if (bytes <= static_cast<double>(most)) return true;
    context.diagnostics->error(
        {},
        fmt::format("a picture of {}x{} pixels takes {}, more than the {} of {}; a smaller --resolution or "
                    "--crop helps",
                    pixels.width(), pixels.height(), mebibytes_text(bytes),
                    most == machine_memory() ? "machine's memory" : "limit",
                    mebibytes_text(static_cast<double>(most))),
        kPictureTooLarge);
    return false;
}

}  // namespace trapeze
