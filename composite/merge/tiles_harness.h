/// Tiles of made pictures, for tests of what joins them.
#pragma once

#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineOutputFile.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTileDescription.h>
#include <OpenEXR/ImfTiledOutputFile.h>

#include <functional>
#include <string>
#include <vector>

#include "core/math.h"
#include "core/picture_tile.h"
#include "core/random.h"
#include "core/scene/scene.h"

namespace trapeze::testing {

/// A picture of halves, floats and whole numbers whose values tell their pixels; NaNs among them.
struct MadePicture {
    Box2i display{V2i(0, 0), V2i(39, 29)};
    PixelRect crop{0, 0, 40, 30};
    Imf::Compression compression = Imf::ZIP_COMPRESSION;
    std::function<void(Imf::Header&)> change = [](Imf::Header&) {};  ///< of the header

    static uint32_t bits(int x, int y, uint32_t channel) {
        return hash(static_cast<uint32_t>(x), static_cast<uint32_t>(y), channel);
    }
    Imf::Header header(const PixelRect& part) const {
        Imf::Header header(display, Box2i(V2i(part.x0, part.y0), V2i(part.x1 - 1, part.y1 - 1)));
        header.compression() = compression;
        header.channels().insert("R", Imf::Channel(Imf::HALF));
        header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
        header.channels().insert("id", Imf::Channel(Imf::UINT));
        header.insert("software", Imf::StringAttribute("made"));
        change(header);
        return header;
    }
    Imf::Header tile_header(const PictureTile& tile) const {
        Imf::Header made = header(part_of(crop, tile));
        made.insert("tile", Imf::StringAttribute(name_of(tile)));
        return made;
    }
};

/// The values of a part of the picture, flat.
struct FlatPart {
    explicit FlatPart(const Imf::Header& header) : window(header.dataWindow()) {
        for (int y = window.min.y; y <= window.max.y; ++y)
            for (int x = window.min.x; x <= window.max.x; ++x) {
                r.emplace_back();
                r.back().setBits(static_cast<uint16_t>(MadePicture::bits(x, y, 0)));
                z.push_back(x % 7 == 0 ? kInfinity : static_cast<float>(MadePicture::bits(x, y, 1)));
                id.push_back(MadePicture::bits(x, y, 2));
            }
    }
    Imf::FrameBuffer buffer() {
        const auto slice = [&](Imf::PixelType type, const void* values, size_t bytes) {
            const auto width = static_cast<int64_t>(window.max.x) - window.min.x + 1;
            return Imf::Slice::Make(type, values, window.min, width,
                                    static_cast<int64_t>(window.max.y) - window.min.y + 1, bytes,
                                    bytes * static_cast<size_t>(width));
        };
        Imf::FrameBuffer made;
        made.insert("R", slice(Imf::HALF, r.data(), sizeof r[0]));
        made.insert("Z", slice(Imf::FLOAT, z.data(), sizeof z[0]));
        made.insert("id", slice(Imf::UINT, id.data(), sizeof id[0]));
        return made;
    }
    int rows() const { return window.max.y - window.min.y + 1; }

    Box2i window;
    std::vector<Imath::half> r;
    std::vector<float> z;
    std::vector<uint32_t> id;
};

inline void write_flat(const std::string& path, const Imf::Header& header) {
    FlatPart part(header);
    Imf::OutputFile file(path.c_str(), header, 0);
    file.setFrameBuffer(part.buffer());
    file.writePixels(part.rows());
}

/// A file of any channels, all of whose values are 0.
inline void write_zeros(const std::string& path, const Imf::Header& header) {
    Imf::OutputFile file(path.c_str(), header, 0);
    file.setFrameBuffer({});
    file.writePixels(header.dataWindow().max.y - header.dataWindow().min.y + 1);
}

/// The same pixels, stored in tiles of OpenEXR's.
inline void write_tiled(const std::string& path, Imf::Header header) {
    FlatPart part(header);
    header.setTileDescription(Imf::TileDescription(8, 9));
    Imf::TiledOutputFile file(path.c_str(), header, 0);
    file.setFrameBuffer(part.buffer());
    file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
}

/// A deep picture of none to three samples a pixel.
inline void write_deep(const std::string& path, Imf::Header header) {
    header.setType(Imf::DEEPSCANLINE);
    header.compression() = Imf::ZIPS_COMPRESSION;
    header.channels() = Imf::ChannelList();
    header.channels().insert("A", Imf::Channel(Imf::HALF));
    header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
    const Box2i window = header.dataWindow();
    const auto width = static_cast<size_t>(window.max.x - window.min.x + 1);
    const auto height = static_cast<size_t>(window.max.y - window.min.y + 1);
    std::vector<uint32_t> counts;
    std::vector<std::vector<Imath::half>> alphas;
    std::vector<std::vector<float>> depths;
    for (int y = window.min.y; y <= window.max.y; ++y)
        for (int x = window.min.x; x <= window.max.x; ++x) {
            counts.push_back(MadePicture::bits(x, y, 9) % 4);
            alphas.emplace_back(), depths.emplace_back();
            for (uint32_t sample = 0; sample < counts.back(); ++sample) {
                alphas.back().emplace_back(static_cast<float>(sample) / 3);
                depths.back().push_back(static_cast<float>(MadePicture::bits(x, y, sample)));
            }
        }
    std::vector<Imath::half*> alpha_places;
    std::vector<float*> depth_places;
    for (auto& values : alphas) alpha_places.push_back(values.data());
    for (auto& values : depths) depth_places.push_back(values.data());
    const auto base = [&](const void* first, size_t bytes) {
        return Imf::Slice::Make(Imf::UINT, first, window.min, static_cast<int64_t>(width),
                                static_cast<int64_t>(height), bytes, bytes * width)
            .base;
    };
    constexpr size_t kPlace = sizeof(void*);
    Imf::DeepFrameBuffer buffer;
    buffer.insertSampleCountSlice(Imf::Slice(Imf::UINT, base(counts.data(), sizeof counts[0]),
                                             sizeof counts[0], sizeof counts[0] * width));
    buffer.insert("A", Imf::DeepSlice(Imf::HALF, base(alpha_places.data(), kPlace), kPlace, kPlace * width,
                                      sizeof(Imath::half)));
    buffer.insert("Z", Imf::DeepSlice(Imf::FLOAT, base(depth_places.data(), kPlace), kPlace, kPlace * width,
                                      sizeof(float)));
    Imf::DeepScanLineOutputFile file(path.c_str(), header, 0);
    file.setFrameBuffer(buffer);
    file.writePixels(static_cast<int>(height));
}

}  // namespace trapeze::testing
