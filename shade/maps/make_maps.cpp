#include "shade/maps/make_maps.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <limits>

#include "core/files/output_file.h"
#include "shade/maps/cube_faces.h"
#include "shade/maps/map_library.h"

namespace trapeze {
namespace {

namespace fs = std::filesystem;

constexpr uint64_t kMostFloats = uint64_t{1} << 28;  ///< that a cube's faces may have together: 1 GiB
constexpr float kNothing = 1e30f;                    ///< depths from here on mean that nothing was seen

/// Ends the making of a map; caught by made().
struct MakingError {
    MapProblem problem;
};

/// Throws for the pictures' side, with a text that may be empty; check_output() throws for the map's.
void check(bool good, const std::string& text) {
    if (!good) throw MakingError{{text.empty() ? "cannot be read" : text}};
}

void check_output(bool good, const std::string& text) {
    if (!good) throw MakingError{{text.empty() ? "cannot be written" : text, true}};
}

const MapLibrary& library() {
    std::string problem;
    const MapLibrary* const found = map_library(&problem);
    check(found != nullptr, problem);
    return *found;
}

SourcePicture read_picture(const std::string& name, Transfer transfer) {
    SourcePicture picture;
    const std::string problem = library().read(name, transfer, picture);
    check(problem.empty(), problem);
    return picture;
}

/// A file under a temporary name beside `target`, which it becomes by finish(); else it is removed.
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

MapForm form_of(const MapMaking& making) {
    return {wrap_mode(making.swrap) + "," + wrap_mode(making.twrap), making.filter, false};
}

/// Writes a map's file whole, or not at all.
void write_map(const MapBytes& map, const std::string& name) {
    check(map.problem.empty(), map.problem);
    OutputFile file(name);
    check_output(file.open() && file.write(map.bytes.data(), map.bytes.size()) && file.commit(),
                 file.error());
}

/// Makes a map, and turns what is thrown into the problem that is returned.
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

/// The tail of texture and bump maps: one picture, kept as halves where these hold its numbers.
void make_flat(SourcePicture picture, const std::string& texture, const MapMaking& making) {
    MapForm form = form_of(making);
    form.halves = picture.fits_halves;
    write_map(library().texture_map(picture.raster, form), texture);
}

void make_environment(Raster& raster, const std::string& texture, const MapMaking& making) {
    const MapForm form = form_of(making);
    Unfinished file(texture);
    const std::string problem = library().write_environment_map(raster, form, file.path());
    check_output(problem.empty(), problem);
    file.finish();
}

/// A depth for each pixel, from channel Z or the only channel. What was not seen becomes the largest float.
std::vector<float> depths_of(const SourcePicture& picture) {
    const std::vector<std::string>& names = picture.channel_names;
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

}  // namespace

MapProblem make_texture_map(const std::string& picture, const std::string& texture, const MapMaking& making) {
    return made([&] { make_flat(read_picture(picture, making.transfer), texture, making); });
}

MapProblem make_bump_map(const std::string& picture, const std::string& texture, const MapMaking& making) {
    return made([&] {
        const bool is_encoded = making.transfer == Transfer::Srgb;
        make_flat(read_picture(picture, is_encoded ? Transfer::Srgb : Transfer::Linear), texture, making);
    });
}

MapProblem make_lat_long_environment(const std::string& picture, const std::string& texture,
                                     const MapMaking& making) {
    return made([&] {
        SourcePicture read = read_picture(picture, making.transfer);
        make_environment(read.raster, texture, making);
    });
}

MapProblem make_cube_face_environment(const std::array<std::string, 6>& pictures, const std::string& texture,
                                      float fov, const MapMaking& making) {
    return made([&] {
        std::array<Raster, 6> faces;
        for (size_t i = 0; i < faces.size(); ++i) {
            faces[i] = std::move(read_picture(pictures[i], making.transfer).raster);
            check(faces[i].channels == faces[0].channels, "the faces do not have the same channels");
            check(faces[i].pixels.size() * 8 <= kMostFloats, fmt::format("\"{}\" is too large", pictures[i]));
        }
        Raster map = lat_long_from_cube(faces, fov);
        make_environment(map, texture, making);
    });
}

MapProblem make_shadow_map(const std::string& picture, const std::string& shadow) {
    return made([&] {
        const SourcePicture read = read_picture(picture, Transfer::Linear);
        check(read.matrices.has_value(),
              "the picture does not say where its camera was (worldtocamera, worldtoscreen)");
        write_map(library().shadow_map(read, depths_of(read)), shadow);
    });
}

}  // namespace trapeze
