/// Maps from strangers: small pictures of odd channels, sizes, tiles, levels and numbers, some cut short, and
/// lookups with any coordinates and options. With clang: -fsanitize=fuzzer,address,undefined and seeds/map as
/// corpus. With any compiler: linked with replay_main.cpp it runs the seeds and mutations of them.
#include <OpenImageIO/imageio.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "shade/maps/make_maps.h"
#include "shade/maps/textures.h"
#include "tests/fuzz/byte_source.h"

namespace {

using namespace trapeze;
using fuzz::ByteSource;
namespace fs = std::filesystem;

constexpr int kMostLevels = 6, kMostLookups = 12;
constexpr size_t kVertices = 5;
constexpr float kUntouched = -77;

/// A folder that lives as long as the process.
class Folder {
  public:
    Folder() : path_(fs::temp_directory_path() / ("trapeze_map_fuzz_" + std::to_string(::getpid()))) {
        fs::create_directories(path_);
        OIIO::attribute("threads", 1);
    }
    ~Folder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    std::string file(const std::string& name) const { return (path_ / name).string(); }

  private:
    fs::path path_;
};

float number(ByteSource& bytes) {
    return std::strtof(bytes.number().c_str(), nullptr);
}

M44f matrix(ByteSource& bytes) {
    M44f m;
    if (bytes.once_in(3))
        for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = number(bytes);
    return m;
}

int side(ByteSource& bytes) {
    return bytes.once_in(6) ? bytes.between(4, 80) : bytes.between(1, 3);
}

OIIO::ImageSpec make_spec(ByteSource& bytes) {
    static constexpr OIIO::TypeDesc::BASETYPE kTypes[] = {OIIO::TypeDesc::FLOAT, OIIO::TypeDesc::HALF,
                                                          OIIO::TypeDesc::UINT8, OIIO::TypeDesc::UINT16};
    static constexpr const char* kWraps[] = {"periodic,periodic", "black,clamp", "mirror,mirror", "clamp",
                                             "round,periodic",    ",",           ",periodic",     "a,b,c"};
    static constexpr const char* kFormats[] = {"Plain Texture", "LatLong Environment", "CubeFace Environment",
                                               "Shadow"};
    const int width = side(bytes), height = side(bytes);
    OIIO::ImageSpec spec(width, height, bytes.between(1, 9), kTypes[bytes.between(0, 3)]);
    if (bytes.once_in(4)) {
        spec.x = bytes.between(0, 6) - 3, spec.y = bytes.between(0, 6) - 3;
        spec.full_width = bytes.between(1, 9), spec.full_height = bytes.between(1, 9);
        spec.full_x = bytes.between(0, 4) - 2;
    }
    if (bytes.once_in(2)) spec.tile_width = bytes.between(1, 32), spec.tile_height = bytes.between(1, 32);
    if (bytes.once_in(3)) spec.tile_width = spec.tile_height = 16;  // as TIFF has them
    if (bytes.once_in(2)) spec.attribute("wrapmodes", kWraps[bytes.between(0, 7)]);
    if (bytes.once_in(2)) spec.attribute("textureformat", kFormats[bytes.between(0, 3)]);
    if (bytes.once_in(2))
        for (const char* name : {"worldtocamera", "worldtoscreen"}) {
            const M44f m = matrix(bytes);
            spec.attribute(name, OIIO::TypeMatrix, &m);
        }
    return spec;
}

std::vector<float> pixels(ByteSource& bytes, const OIIO::ImageSpec& spec) {
    std::vector<float> values(spec.image_pixels() * static_cast<size_t>(spec.nchannels));
    const std::array<float, 4> some = {number(bytes), number(bytes), number(bytes), number(bytes)};
    for (size_t i = 0; i < values.size(); ++i) values[i] = some[i % some.size()];
    return values;
}

/// The name of a picture with as many levels as it happens to have.
std::string write_picture(const Folder& folder, ByteSource& bytes) {
    static constexpr const char* kNames[] = {"map.tif", "map.exr", "map.png", "map.tif"};
    const std::string name = folder.file(kNames[bytes.between(0, 3)]);
    std::error_code ignored;
    fs::remove(name, ignored);
    OIIO::ImageSpec spec = make_spec(bytes);
    if (name.ends_with(".png")) spec.tile_width = spec.tile_height = 0;
    const auto out = OIIO::ImageOutput::create(name);
    bool good = out && out->open(name, spec);
    if (good) good = out->write_image(OIIO::TypeDesc::FLOAT, pixels(bytes, spec).data());
    const auto append = out && out->supports("mipmap") ? OIIO::ImageOutput::AppendMIPLevel
                                                       : OIIO::ImageOutput::AppendSubimage;
    const int levels = spec.tile_width ? bytes.between(0, kMostLevels) : 0;
    for (int level = 0; good && level < levels; ++level) {
        spec.width = spec.full_width = std::max(spec.width / 2, 1);
        spec.height = spec.full_height = std::max(spec.height / 2, 1);
        good = out->open(name, spec, append) &&
               out->write_image(OIIO::TypeDesc::FLOAT, pixels(bytes, spec).data());
    }
    if (out) out->close();
    OIIO::geterror();
    if (bytes.once_in(8) && fs::exists(name))
        fs::resize_file(name, fs::file_size(name) * static_cast<uintmax_t>(bytes.byte()) / 256, ignored);
    return name;
}

/// Sometimes what the Make requests make of it.
std::string maybe_made(const Folder& folder, ByteSource& bytes, const std::string& picture) {
    static constexpr const char* kWraps[] = {"periodic", "clamp", "black", "mirror"};
    static constexpr const char* kFilters[] = {"box", "gaussian", "bessel", "catmull-rom", "sinc", "none"};
    if (!bytes.once_in(4)) return picture;
    const MapMaking making{kWraps[bytes.between(0, 3)], kWraps[bytes.between(0, 3)],
                           kFilters[bytes.between(0, 5)]};
    const std::string map = folder.file("made");
    std::error_code ignored;
    fs::remove(map, ignored);
    switch (bytes.between(0, 4)) {
        case 0:
            make_texture_map(picture, map, making);
            break;
        case 1:
            make_bump_map(picture, map, making);
            break;
        case 2:
            make_lat_long_environment(picture, map, making);
            break;
        case 3:
            make_cube_face_environment({picture, picture, picture, picture, picture, picture}, map,
                                       number(bytes), making);
            break;
        default:
            make_shadow_map(picture, map);
    }
    return map;
}

MapOptions make_options(ByteSource& bytes) {
    MapOptions options;
    LaneNumber* const numbers[] = {&options.sblur, &options.tblur,         &options.swidth,  &options.twidth,
                                   &options.fill,  &options.first_channel, &options.samples, &options.bias};
    for (LaneNumber* option : numbers)
        if (bytes.once_in(3)) *option = number(bytes);
    options.samples = std::min(options.samples.at(0), 64.0f);  // more take time
    options.lerp = bytes.byte() % 2;
    options.filter = static_cast<MapOptions::Filter>(bytes.between(0, 2));
    options.swrap = static_cast<MapOptions::Wrap>(bytes.between(0, 4));
    options.twrap = static_cast<MapOptions::Wrap>(bytes.between(0, 4));
    return options;
}

/// Planes of a lookup's arguments.
class Planes {
  public:
    explicit Planes(ByteSource& bytes) : bytes_(bytes) {}
    ConstPlane take() {
        std::array<float, kLanes>& plane = planes_[used_++];
        const bool same = bytes_.byte() % 2;
        for (size_t i = 0; i < kVertices; ++i) plane[i] = same && i ? plane[0] : number(bytes_);
        return plane;
    }
    ConstPlane3 take3() { return {take(), take(), take()}; }

  private:
    ByteSource& bytes_;
    std::array<std::array<float, kLanes>, 9> planes_{};
    size_t used_ = 0;
};

void look_up(Textures& textures, const std::string& name, ByteSource& bytes) {
    const MapOptions options = make_options(bytes);
    std::array<std::array<float, kLanes>, 3> results;
    for (auto& result : results) result.fill(kUntouched);
    const Plane out[] = {results[0], results[1], results[2]};
    const std::span<const Plane> wanted(out, bytes.byte() % 2 ? 3 : 1);
    std::array<float, kLanes> mask{};
    for (size_t i = 0; i < kVertices; ++i) mask[i] = std::bit_cast<float>(bytes.once_in(4) ? 0u : ~0u);
    const Lanes lanes{kVertices, mask};
    Planes planes(bytes);
    const int kind = bytes.between(0, 2);
    const Textures::Picture* picture = textures.find(name, {});
    if (kind == 0)
        textures.texture(
            picture,
            {planes.take(), planes.take(), planes.take(), planes.take(), planes.take(), planes.take()},
            options, lanes, wanted);
    else if (kind == 1)
        textures.environment(picture, {planes.take3(), planes.take3(), planes.take3()}, options, lanes,
                             wanted);
    else
        textures.shadow(textures.find_shadow(name, {}), {planes.take3(), planes.take3(), planes.take3()},
                        matrix(bytes), options, lanes, out[0]);
    const auto info = textures.info(name);
    for (size_t i = 0; i < kVertices; ++i) {
        const bool is_on = std::bit_cast<uint32_t>(mask[i]) != 0;
        if (!is_on && results[0][i] != kUntouched) std::abort();
        // Channels that are not there are what is asked for.
        if (!is_on || kind == 2 || !picture || !info) continue;
        for (size_t k = 0; k < wanted.size(); ++k) {
            const float channel =
                std::trunc(std::max(options.first_channel.at(i), 0.0f)) + static_cast<float>(k);
            if (channel >= static_cast<float>(info->channels) && results[k][i] != options.fill.at(i))
                std::abort();
        }
    }
}

}  // namespace

/// Messages that OpenImageIO keeps for threads that have ended, and its strings that libpng's errors jump
/// over.
extern "C" const char* __lsan_default_suppressions() {
    return "leak:libOpenImageIO";
}

/// The whole stack of what is allocated: by frame pointers it ends in libstdc++, which has none, before
/// OpenImageIO is seen.
extern "C" const char* __asan_default_options() {
    return "fast_unwind_on_malloc=0";
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    static const Folder folder;
    ByteSource bytes(data, size);
    const std::string name = maybe_made(folder, bytes, write_picture(folder, bytes));
    Diagnostics diagnostics([](const Diagnostic&) {});
    Textures textures(Options(), &diagnostics);
    for (int i = 0; i < kMostLookups && !bytes.is_empty(); ++i) look_up(textures, name, bytes);
    if (bytes.once_in(4))
        if (const DepthHeight height = textures.height_over(name, {}, matrix(bytes)))
            height({number(bytes), number(bytes), number(bytes)});
    return 0;
}
