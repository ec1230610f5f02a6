/// The module "maps": pictures read, and maps made of them.
// First: OpenImageIO declares vectors of its own where it has not seen Imath's.
#include "core/math.h"

#include <OpenImageIO/filter.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "shade/maps/openimageio/linear_image_input.h"
#include "shade/maps/openimageio/map_bytes.h"
#include "shade/maps/openimageio/map_cache.h"
#include "shade/maps/openimageio/map_matrices.h"

namespace trapeze {
namespace {

using OIIO::ImageSpec;
using OIIO::TypeDesc;

constexpr uint64_t kMostFloats = uint64_t{1} << 28;  ///< that a picture may have: 1 GiB
constexpr int kTile = 64;

std::string or_unreadable(std::string problem) {
    return problem.empty() ? "cannot be read" : problem;
}

/// Whether halves hold a file's numbers exactly: it has halves or 8 bits.
bool fits_halves(const ImageSpec& spec) {
    return spec.format == TypeDesc::UINT8 || spec.format == TypeDesc::HALF;
}

/// Reads an open file into `picture`. Returns what went wrong.
std::string read_picture(OIIO::ImageInput& file, const std::string& name, SourcePicture& picture) {
    ImageSpec spec;
    if (!file.open(name, spec)) return or_unreadable(file.geterror());
    const uint64_t floats = spec.image_pixels() * static_cast<uint64_t>(spec.nchannels);
    if (spec.nchannels <= 0 || spec.depth > 1 || spec.deep) return "is no picture of rows and columns";
    if (spec.width <= 0 || spec.height <= 0 || floats > kMostFloats)
        return fmt::format("\"{}\" is too large: {} x {} pixels", name, spec.width, spec.height);
    picture.raster = {spec.width, spec.height, spec.nchannels, std::vector<float>(floats)};
    picture.fits_halves = fits_halves(spec);
    picture.channel_names = spec.channelnames;
    picture.x = spec.x, picture.y = spec.y;
    picture.full_width = spec.full_width, picture.full_height = spec.full_height;
    picture.matrices = map_matrices(spec);
    if (!file.read_image(0, 0, 0, spec.nchannels, TypeDesc::FLOAT, picture.raster.pixels.data()))
        return or_unreadable(file.geterror());
    file.close();
    return {};
}

std::string read_numbers(const std::string& name, SourcePicture& picture) {
    const auto file = OIIO::ImageInput::create(name);
    return file ? read_picture(*file, name, picture) : or_unreadable(OIIO::geterror());
}

/// OpenImageIO's name of a filter. Names that it does not know but RISpec does become the nearest it has;
/// others become "box".
std::string filter_name(const std::string& name) {
    if (name == "b-spline" || name == "radial-bspline") return "bspline";
    if (name == "bessel" || name == "lanczos") return "lanczos3";
    for (int i = 0; i < OIIO::Filter2D::num_filters(); ++i)
        if (name == OIIO::Filter2D::get_filterdesc(i).name) return name;
    return "box";
}

ImageSpec texture_config(const MapForm& form) {
    ImageSpec config;
    config.format = form.halves ? TypeDesc::HALF : TypeDesc::FLOAT;
    config.tile_width = config.tile_height = kTile;
    config.attribute("wrapmodes", form.wrap_modes);
    config.attribute("maketx:filtername", filter_name(form.filter));
    return config;
}

OIIO::ImageBuf buffer_of(Raster& raster) {
    return OIIO::ImageBuf(ImageSpec(raster.width, raster.height, raster.channels, TypeDesc::FLOAT),
                          raster.pixels.data());
}

class OpenImageIo final : public MapLibrary {
  public:
    std::unique_ptr<MapCache> make_cache(float megabytes) const override {
        return std::make_unique<OpenImageIoCache>(megabytes);
    }

    std::string read(const std::string& name, Transfer transfer, SourcePicture& picture) const override {
        const auto stored = OIIO::ImageInput::open(name);
        if (!stored) return or_unreadable(OIIO::geterror());
        if (!is_srgb_encoded(stored->spec(), transfer)) return read_numbers(name, picture);
        LinearImageInput file;
        return read_picture(file, name, picture);
    }

    MapBytes texture_map(Raster& picture, const MapForm& form) const override {
        return open_exr_texture(buffer_of(picture), texture_config(form));
    }

    std::string write_environment_map(Raster& picture, const MapForm& form,
                                      const std::string& file) const override {
        ImageSpec config = texture_config(form);
        config.attribute("maketx:fileformatname", "tiff");
        if (OIIO::ImageBufAlgo::make_texture(OIIO::ImageBufAlgo::MakeTxEnvLatl, buffer_of(picture), file,
                                             config))
            return {};
        const std::string problem = OIIO::geterror();
        return problem.empty() ? "cannot be written" : problem;
    }

    MapBytes shadow_map(const SourcePicture& from, const std::vector<float>& depths) const override {
        ImageSpec spec(from.raster.width, from.raster.height, 1, TypeDesc::FLOAT);
        spec.x = from.x, spec.y = from.y;
        spec.full_width = from.full_width, spec.full_height = from.full_height;
        spec.channelnames = {"Z"};
        spec.tile_width = spec.tile_height = kTile;
        spec.attribute("textureformat", "Shadow");
        if (from.matrices) {
            spec.attribute("worldtocamera", OIIO::TypeMatrix, &from.matrices->camera_from_world);
            spec.attribute("worldtoscreen", OIIO::TypeMatrix, &from.matrices->screen_from_world);
        }
        return tiff_bytes(spec, depths);
    }
};

constexpr OpenImageIo kLibrary;

}  // namespace
}  // namespace trapeze

const trapeze::ModuleEntry trapeze_maps_module = {
    TRAPEZE_VERSION, static_cast<const trapeze::MapLibrary*>(&trapeze::kLibrary)};
