/// Headers next to OpenImageIO's own judgement: what is plain it must open, whatever byte is wrong.
#include "shade/maps/headers/map_header.h"

#include <fstream>
#include <iterator>
#include <utility>

#include "core/random.h"
#include "shade/maps/map_files_harness.h"

namespace trapeze {
namespace {

using OIIO::ImageSpec;
using OIIO::TypeDesc;

class MapHeaderTest : public MapFilesTest {
  protected:
    std::string picture(const std::string& name, int channels, TypeDesc type,
                        const std::vector<std::pair<std::string, std::string>>& attributes = {},
                        int side = 20) {
        ImageSpec spec(side, side, channels, type);
        for (const auto& [key, value] : attributes) spec.attribute(key, value);
        return write(name, spec, [&](int x, int y, int c) {
            return static_cast<float>((x * 7 + y * 5 + c * 3) % 11) / 11;
        });
    }
    std::string tiled(const std::string& name, TypeDesc type) {
        ImageSpec spec(40, 24, 3, type);
        spec.tile_width = spec.tile_height = 16;
        const auto out = OIIO::ImageOutput::create(path(name));
        const std::vector<float> pixels(size_t{40} * 24 * 3, 0.25f);
        EXPECT_TRUE(out && out->open(path(name), spec) && out->write_image(TypeDesc::FLOAT, pixels.data()));
        return path(name);
    }
    static std::string bytes_of(const std::string& file) {
        std::ifstream in(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    std::string write_bytes(const std::string& name, const std::string& bytes) const {
        std::ofstream(path(name), std::ios::binary) << bytes;
        return path(name);
    }
    /// Whether OpenImageIO's cache takes the file as a map of rows and columns.
    bool opens(const std::string& file) {
        Textures textures(options_, &diagnostics_);
        return textures.find(file, {}) != nullptr;
    }
    /// One picture of each plain kind.
    std::vector<std::string> plain_pictures() {
        return {picture("grey.png", 1, TypeDesc::UINT8),
                picture("color.png", 3, TypeDesc::UINT16),
                picture("alpha.png", 4, TypeDesc::UINT8),
                picture("grey.jpg", 1, TypeDesc::UINT8),
                picture("color.jpg", 3, TypeDesc::UINT8),
                picture("color.tif", 3, TypeDesc::UINT8, {{"compression", "lzw"}}),
                picture("color16.tif", 4, TypeDesc::UINT16, {{"compression", "zip"}}),
                picture("plain.tif", 3, TypeDesc::FLOAT, {{"compression", "none"}}),
                tiled("tiled.tif", TypeDesc::FLOAT),
                tiled("tiled.exr", TypeDesc::HALF),
                picture("color.exr", 3, TypeDesc::HALF),
                picture("deep_grey.exr", 1, TypeDesc::FLOAT)};
    }
};

TEST_F(MapHeaderTest, PicturesOfThePlainKindsAreEnoughByThemselves) {
    for (const std::string& file : plain_pictures()) {
        EXPECT_TRUE(plain_map_header(file)) << file;
        EXPECT_TRUE(opens(file)) << file;
    }
    EXPECT_TRUE(plain_map_header(picture("depth.exr", 1, TypeDesc::FLOAT))->is_one_float);
    EXPECT_TRUE(plain_map_header(picture("depth.tif", 1, TypeDesc::FLOAT))->is_one_float);
    EXPECT_FALSE(plain_map_header(picture("half.exr", 1, TypeDesc::HALF))->is_one_float);
    EXPECT_FALSE(plain_map_header(picture("depth.exr", 1, TypeDesc::FLOAT))->has_matrices);
}

TEST_F(MapHeaderTest, ShadowMapsAreKnownByTheirMatrices) {
    for (const char* name : {"map.tif", "map.exr"}) {
        const std::string file = write_depth_map(
            name, 8, true, [](int, int) { return 3.0f; }, M44f());
        const auto header = plain_map_header(file);
        ASSERT_TRUE(header) << name;
        EXPECT_TRUE(header->is_one_float && header->has_matrices) << name;
        EXPECT_NE(Textures(options_, nullptr).find_shadow(file, {}), nullptr) << name;
    }
}

TEST_F(MapHeaderTest, WhatIsNoPictureOrOfARarerKindIsLeftToOpenImageIo) {
    EXPECT_FALSE(plain_map_header(path("none.png")));
    EXPECT_FALSE(plain_map_header(write_bytes("empty.png", "")));
    EXPECT_FALSE(plain_map_header(write_bytes("text.tif", "a text")));
    EXPECT_FALSE(plain_map_header(picture("color.tga", 3, TypeDesc::UINT8)));
    EXPECT_FALSE(plain_map_header(picture("planes.tif", 3, TypeDesc::UINT8, {{"planarconfig", "separate"}})));
}

TEST_F(MapHeaderTest, WhatIsPlainOpensWhicheverByteIsChangedAndWhereverTheFileEnds) {
    uint32_t drawn = 0;
    const auto draw = [&] { return unit_float(hash(18, drawn++)); };
    size_t changed_and_plain = 0, refused = 0;
    for (const std::string& file : plain_pictures()) {
        const std::string whole = bytes_of(file);
        const std::string ending = file.substr(file.find_last_of('.'));
        // Headers are at the beginning of all but TIFF, which has its directory at the end.
        const size_t header = std::min<size_t>(whole.size(), 600);
        const auto try_bytes = [&](const std::string& bytes, const std::string& how) {
            const std::string odd = write_bytes("odd" + ending, bytes);
            if (!plain_map_header(odd)) {
                ++refused;
                return;
            }
            ++changed_and_plain;
            EXPECT_TRUE(opens(odd)) << file << ": " << how << ": " << reported_.back().text;
        };
        for (size_t i = 0; i < 2 * header; i += 1 + static_cast<size_t>(draw() * 10)) {
            const size_t at = i < header ? i : whole.size() - 1 - (i - header);
            std::string odd = whole;
            const float kind = draw();
            odd[at] = kind < 0.3f   ? '\0'
                      : kind < 0.6f ? '\xff'
                                    : static_cast<char>(odd[at] ^ (1 << static_cast<int>(draw() * 8)));
            try_bytes(odd, "byte " + std::to_string(at));
        }
        for (int i = 0; i < 40; ++i) {
            const auto length = static_cast<size_t>(draw() * static_cast<float>(whole.size()));
            try_bytes(whole.substr(0, length), "cut after " + std::to_string(length));
        }
    }
    EXPECT_GT(changed_and_plain, 200u);
    EXPECT_GT(refused, 200u);
}

}  // namespace
}  // namespace trapeze
