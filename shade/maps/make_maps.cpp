#include "shade/maps/make_maps.h"

#include <OpenImageIO/filter.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <limits>

#include "core/files/output_file.h"
#include "shade/maps/cube_faces.h"
#include "shade/maps/linear_image_input.h"
#include "shade/maps/map_bytes.h"
#include "shade/maps/map_matrices.h"

namespace trapeze {
namespace {

namespace fs = std::filesystem;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

constexpr uint64_t kMostFloats = uint64_t{1} << 28;  ///< of a picture: 1 GiB
constexpr int kTile = 64;
constexpr float kNothing = 1e30f;  ///< what is as deep

struct MakingError {
    MapProblem problem;
};

void check(bool good, const std::string& text) {
    if (!good) throw MakingError{{text.empty() ? "cannot be read" : text}};
}

void check_output(bool good, const std::string& text) {
    if (!good) throw MakingError{{text.empty() ? "cannot be written" : text, true}};
}

struct Picture {
    Raster raster;
    ImageSpec spec;  ///< of the file
};

Picture read_picture(OIIO::ImageInput& file, const std::string& name) {
    Picture picture;
    check(file.open(name, picture.spec), file.geterror());
    const ImageSpec& spec = picture.spec;
    const uint64_t floats = spec.image_pixels() * static_cast<uint64_t>(spec.nchannels);
    check(spec.nchannels > 0 && spec.depth <= 1 && !spec.deep, "is no picture of rows and columns");
    check(spec.width > 0 && spec.height > 0 && floats <= kMostFloats,
          fmt::format("\"{}\" is too large: {} x {} pixels", name, spec.width, spec.height));
    picture.raster = {spec.width, spec.height, spec.nchannels, std::vector<float>(floats)};
    check(file.read_image(0, 0, 0, spec.nchannels, TypeDesc::FLOAT, picture.raster.pixels.data()),
          file.geterror());
    file.close();
    return picture;
}

Picture read_numbers(const std::string& name) {
    const auto file = OIIO::ImageInput::create(name);
    check(file != nullptr, OIIO::geterror());
    return read_picture(*file, name);
}

Picture read_light(const std::string& name, Transfer transfer) {
    const auto stored = OIIO::ImageInput::open(name);
    check(stored != nullptr, OIIO::geterror());
    if (!is_srgb_encoded(stored->spec(), transfer)) return read_numbers(name);
    LinearImageInput file;
    return read_picture(file, name);
}

/// Where a file is made that becomes `target` when all has gone well.
class Unfinished {
  public:
    explicit Unfinished(const std::string& target)
        : target_(target), path_(fmt::format("{}.{}.part", target, ::getpid())) {}
    ~Unfinished() {
        std::error_code ignored;
        fs::remove(path_, ignored);
    }
    Unfinished(const Unfinished&) = delete;
    Unfinished& operator=(const Unfinished&) = delete;

    const std::string& path() const { return path_; }
    void finish() {
        std::error_code problem;
        fs::rename(path_, target_, problem);
        check_output(!problem, problem.message());
    }

  private:
    std::string target_, path_;
};

std::string wrap_mode(const std::string& name) {
    for (const char* known : {"periodic", "clamp", "black", "mirror"})
        if (name == known) return name;
    throw MakingError{{fmt::format("\"{}\" is no wrap mode", name)}};
}

/// OpenImageIO's name of a filter; "box" for one that it does not have.
std::string filter_name(const std::string& name) {
    if (name == "b-spline" || name == "radial-bspline") return "bspline";
    if (name == "bessel" || name == "lanczos") return "lanczos3";
    for (int i = 0; i < OIIO::Filter2D::num_filters(); ++i)
        if (name == OIIO::Filter2D::get_filterdesc(i).name) return name;
    return "box";
}

ImageSpec texture_config(const MapMaking& making, TypeDesc format) {
    ImageSpec config;
    config.format = format;
    config.tile_width = config.tile_height = kTile;
    config.attribute("wrapmodes", wrap_mode(making.swrap) + "," + wrap_mode(making.twrap));
    config.attribute("maketx:filtername", filter_name(making.filter));
    return config;
}

/// Whole, or not at all.
void write_map(const MapBytes& map, const std::string& name) {
    check(map.problem.empty(), map.problem);
    OutputFile file(name);
    check_output(file.open() && file.write(map.bytes.data(), map.bytes.size()) && file.commit(),
                 file.error());
}

OIIO::ImageBuf buffer_of(Raster& raster) {
    return OIIO::ImageBuf(ImageSpec(raster.width, raster.height, raster.channels, TypeDesc::FLOAT),
                          raster.pixels.data());
}

/// Runs what may throw, and says what went wrong.
template <class Make>
MapProblem made(Make&& make) {
    try {
        make();
        return {};
    } catch (const MakingError& error) {
        return error.problem;
    } catch (const std::exception& error) {
        return {error.what()};
    }
}

/// Eight bits and halves fit halves.
TypeDesc texture_format(const ImageSpec& spec) {
    const bool fits = spec.format == TypeDesc::UINT8 || spec.format == TypeDesc::HALF;
    return fits ? TypeDesc::HALF : TypeDesc::FLOAT;
}

void make_flat(Picture picture, const std::string& texture, const MapMaking& making) {
    const ImageSpec config = texture_config(making, texture_format(picture.spec));
    write_map(open_exr_texture(buffer_of(picture.raster), config), texture);
}

/// TIFF: OpenEXR's maps have another up. OpenImageIO makes a TIFF of several pictures on the disk only.
void make_environment(Raster& raster, const std::string& texture, const MapMaking& making) {
    ImageSpec config = texture_config(making, TypeDesc::FLOAT);
    config.attribute("maketx:fileformatname", "tiff");
    Unfinished file(texture);
    check_output(OIIO::ImageBufAlgo::make_texture(OIIO::ImageBufAlgo::MakeTxEnvLatl, buffer_of(raster),
                                                  file.path(), config),
                 OIIO::geterror());
    file.finish();
}

std::vector<float> depths_of(const Picture& picture) {
    const std::vector<std::string>& names = picture.spec.channelnames;
    const auto named = std::find_if(names.begin(), names.end(),
                                    [](const std::string& name) { return name == "Z" || name == "z"; });
    check(named != names.end() || picture.raster.channels == 1, "the picture has no depths (channel Z)");
    const int channel = named == names.end() ? 0 : static_cast<int>(named - names.begin());
    std::vector<float> depths;
    for (size_t i = channel; i < picture.raster.pixels.size(); i += picture.raster.channels) {
        const float depth = picture.raster.pixels[i];
        depths.push_back(depth > 0 && depth < kNothing ? depth : std::numeric_limits<float>::max());
    }
    return depths;
}

void write_depths(const ImageSpec& from, const MapMatrices& matrices, const std::vector<float>& depths,
                  const std::string& shadow) {
    ImageSpec spec(from.width, from.height, 1, TypeDesc::FLOAT);
    spec.x = from.x, spec.y = from.y;
    spec.full_width = from.full_width, spec.full_height = from.full_height;
    spec.channelnames = {"Z"};
    spec.tile_width = spec.tile_height = kTile;
    spec.attribute("textureformat", "Shadow");
    spec.attribute("worldtocamera", OIIO::TypeMatrix, &matrices.camera_from_world);
    spec.attribute("worldtoscreen", OIIO::TypeMatrix, &matrices.screen_from_world);
    write_map(tiff_bytes(spec, depths), shadow);
}

}  // namespace

MapProblem make_texture_map(const std::string& picture, const std::string& texture, const MapMaking& making) {
    return made([&] { make_flat(read_light(picture, making.transfer), texture, making); });
}

MapProblem make_bump_map(const std::string& picture, const std::string& texture, const MapMaking& making) {
    return made([&] {
        const bool is_encoded = making.transfer == Transfer::Srgb;
        make_flat(read_light(picture, is_encoded ? Transfer::Srgb : Transfer::Linear), texture, making);
    });
}

MapProblem make_lat_long_environment(const std::string& picture, const std::string& texture,
                                     const MapMaking& making) {
    return made([&] {
        Picture read = read_light(picture, making.transfer);
        make_environment(read.raster, texture, making);
    });
}

MapProblem make_cube_face_environment(const std::array<std::string, 6>& pictures, const std::string& texture,
                                      float fov, const MapMaking& making) {
    return made([&] {
        std::array<Raster, 6> faces;
        for (size_t i = 0; i < faces.size(); ++i) {
            faces[i] = std::move(read_light(pictures[i], making.transfer).raster);
            check(faces[i].channels == faces[0].channels, "the faces do not have the same channels");
            check(faces[i].pixels.size() * 8 <= kMostFloats, fmt::format("\"{}\" is too large", pictures[i]));
        }
        Raster map = lat_long_from_cube(faces, fov);
        make_environment(map, texture, making);
    });
}

MapProblem make_shadow_map(const std::string& picture, const std::string& shadow) {
    return made([&] {
        const Picture read = read_numbers(picture);
        const auto matrices = map_matrices(read.spec);
        check(matrices.has_value(),
              "the picture does not say where its camera was (worldtocamera, worldtoscreen)");
        write_depths(read.spec, *matrices, depths_of(read), shadow);
    });
}

}  // namespace trapeze
