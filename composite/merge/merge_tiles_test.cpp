#include "composite/merge/merge_tiles.h"

#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "composite/image.h"
#include "composite/merge/tiles_harness.h"
#include "core/files/file_text_harness.h"
#include "core/files/temporary_folder_harness.h"

namespace trapeze {
namespace {

using testing::file_text;
using testing::FlatPart;
using testing::MadePicture;
using testing::TemporaryFolder;
using testing::write_deep;
using testing::write_flat;
using testing::write_tiled;
using testing::write_zeros;
using Names = std::vector<std::string>;

struct Merged {
    MergeOutcome outcome;
    std::string said;  ///< all messages, a line each
};

Merged merge(const Names& tiles, const std::string& output, bool allow_missing = false) {
    Merged result;
    Diagnostics diagnostics([&](const Diagnostic& message) { result.said += message.text + "\n"; });
    result.outcome = merge_tiles(tiles, output, {allow_missing, nullptr}, diagnostics);
    return result;
}

template <class Write>
Names write_tiles(const TemporaryFolder& folder, const MadePicture& picture, int columns, int rows,
                  const Write& write) {
    Names names;
    for (int number = 1; number <= columns * rows; ++number) {
        names.push_back(folder.file("tile" + std::to_string(number) + ".exr"));
        write(names.back(), picture.tile_header({columns, rows, number}));
    }
    return names;
}

/// Tiles of one picture in a folder of their own, next to the picture as it is written at once.
class MergeTiles : public ::testing::Test {
  protected:
    template <class Write>
    void expect_same_bytes(const MadePicture& picture, int columns, int rows, const Write& write) {
        Names names = write_tiles(folder_, picture, columns, rows, write);
        std::rotate(names.begin(), names.begin() + 1, names.end());
        std::swap(names.front(), names.back());
        write(folder_.file("whole.exr"), picture.header(picture.crop));
        const Merged merged = merge(names, out_);
        EXPECT_EQ(merged.outcome, MergeOutcome::Written) << merged.said;
        EXPECT_EQ(merged.said, "");
        EXPECT_FALSE(file_text(out_).empty());
        EXPECT_TRUE(file_text(out_) == file_text(folder_.file("whole.exr"))) << columns << "x" << rows;
    }
    /// Merging must fail, name the file or the reason, and leave an output that was there as it was.
    void expect_refused(const Names& tiles, MergeOutcome outcome, const Names& said,
                        bool allow_missing = false) {
        std::ofstream(out_) << "older";
        const size_t files = folder_.names().size();
        const Merged merged = merge(tiles, out_, allow_missing);
        EXPECT_EQ(merged.outcome, outcome) << merged.said;
        for (const std::string& text : said)
            EXPECT_NE(merged.said.find(text), std::string::npos) << text << "\n" << merged.said;
        EXPECT_TRUE(file_text(out_) == "older");
        EXPECT_EQ(folder_.names().size(), files) << "something is left";
    }

    TemporaryFolder folder_;
    const std::string out_ = folder_.file("out.exr");
};

TEST_F(MergeTiles, GiveTheFileOfTheWholePicture) {
    MadePicture picture;
    for (const Imf::Compression compression :
         {Imf::ZIP_COMPRESSION, Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION,
          Imf::PIZ_COMPRESSION}) {
        picture.compression = compression;
        expect_same_bytes(picture, 3, 2, write_flat);
    }
    expect_same_bytes(picture, 1, 1, write_flat);
    expect_same_bytes(picture, 7, 5, write_flat);
    picture.crop = {-3, -5, 17, 21};
    expect_same_bytes(picture, 3, 4, write_flat);
    picture.crop = {10, 3, 60, 700};  // more rows than are in memory at a time
    expect_same_bytes(picture, 2, 3, write_flat);
}

TEST_F(MergeTiles, MayBeStoredInTilesOfOpenExr) {
    MadePicture picture;
    expect_same_bytes(picture, 3, 2, write_tiled);
    picture.crop = {-3, 5, 37, 700};  // more rows than are in memory at a time
    expect_same_bytes(picture, 2, 3, write_tiled);
}

TEST_F(MergeTiles, AreStoredAsTheFirstIs) {
    const MadePicture picture;
    const Names names{folder_.file("a.exr"), folder_.file("b.exr")};
    write_flat(names[0], picture.tile_header({2, 1, 1}));
    write_tiled(names[1], picture.tile_header({2, 1, 2}));
    write_flat(folder_.file("whole.exr"), picture.header(picture.crop));
    EXPECT_EQ(merge(names, out_).outcome, MergeOutcome::Written);
    EXPECT_TRUE(file_text(out_) == file_text(folder_.file("whole.exr")));
    write_tiled(folder_.file("whole.exr"), picture.header(picture.crop));
    EXPECT_EQ(merge({names[1], names[0]}, out_).outcome, MergeOutcome::Written);
    EXPECT_TRUE(file_text(out_) == file_text(folder_.file("whole.exr")));
}

TEST_F(MergeTiles, MayBeDeep) {
    MadePicture picture;
    expect_same_bytes(picture, 3, 2, write_deep);
    picture.crop = {10, 3, 23, 60};
    expect_same_bytes(picture, 4, 3, write_deep);
}

TEST_F(MergeTiles, MayOverlapWithTheSamePixels) {
    const MadePicture picture;
    const Names names{folder_.file("a.exr"), folder_.file("b.exr"), folder_.file("a.exr")};
    for (const auto& write : {+[](const std::string&path, const Imf::Header&h) { write_flat(path, h); },
                              +[](const std::string&path, const Imf::Header&h) { write_deep(path, h); }}) {
        write(names[0], picture.header({0, 0, 40, 20}));
        write(names[1], picture.header({0, 11, 40, 30}));
        write(folder_.file("whole.exr"), picture.header(picture.crop));
        const Merged merged = merge(names, out_);
        EXPECT_EQ(merged.said, "");
        EXPECT_TRUE(file_text(out_) == file_text(folder_.file("whole.exr")));
    }
}

TEST_F(MergeTiles, OfOtherPixelsAreRefused) {
    const MadePicture picture;
    write_flat(folder_.file("a.exr"), picture.header({0, 0, 40, 20}));
    for (const char* channel : {"R", "Z", "id"}) {
        const Imf::Header header = picture.header({0, 11, 40, 30});
        FlatPart part(header);
        const size_t pixel = 5 * 40 + 12;  // at 12, 16
        if (*channel == 'R') part.r[pixel].setBits(static_cast<uint16_t>(part.r[pixel].bits() ^ 1));
        if (*channel == 'Z') part.z[pixel] += 1000;
        if (*channel == 'i') part.id[pixel] ^= 1u << 31;
        {
            Imf::OutputFile file(folder_.file("b.exr").c_str(), header, 0);
            file.setFrameBuffer(part.buffer());
            file.writePixels(part.rows());
        }
        expect_refused({folder_.file("a.exr"), folder_.file("b.exr")}, MergeOutcome::NoPicture,
                       {"a.exr\" and \"", "b.exr\" have different pixels at 12 16, in channel \"" +
                                              std::string(channel) + "\""});
    }
}

TEST_F(MergeTiles, ThatAreMissingAreNamed) {
    const MadePicture picture;
    Names names = write_tiles(folder_, picture, 4, 3, write_flat);
    names.erase(names.begin() + 6, names.begin() + 9);
    names.erase(names.begin() + 1);
    expect_refused(names, MergeOutcome::NoPicture, {"tiles 2 and 7 to 9 of 4x3 are missing"});
    const Merged merged = merge(names, out_, true);
    EXPECT_EQ(merged.outcome, MergeOutcome::Written);
    EXPECT_NE(merged.said.find("tiles 2 and 7 to 9 of 4x3 are missing"), std::string::npos) << merged.said;
    Imf::InputFile file(out_.c_str(), 0);
    EXPECT_EQ(file.header().dataWindow(), Box2i(V2i(0, 0), V2i(39, 29)));
    FlatPart whole(file.header()), read(file.header());
    file.setFrameBuffer(read.buffer());
    file.readPixels(0, 29);
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x) {
            const auto at = static_cast<size_t>(40 * y + x);
            const bool is_missing =
                (x >= 10 && x < 20 && y < 10) || (x >= 20 && y >= 10 && y < 20) || (x < 10 && y >= 20);
            EXPECT_EQ(read.r[at].bits(), is_missing ? 0 : whole.r[at].bits());
            EXPECT_EQ(read.z[at], is_missing ? kInfinity : whole.z[at]);
            EXPECT_EQ(read.id[at], is_missing ? kNoPrimitive : whole.id[at]);
        }
}

TEST_F(MergeTiles, WithoutNumbersAreNamedByPixels) {
    const MadePicture picture;
    write_flat(folder_.file("a.exr"), picture.header({0, 0, 40, 20}));
    write_flat(folder_.file("b.exr"), picture.header({5, 20, 40, 30}));
    expect_refused({folder_.file("a.exr"), folder_.file("b.exr")}, MergeOutcome::NoPicture,
                   {"these pixels are in no tile (x, y): 0..4, 20..29"});
}

TEST_F(MergeTiles, DeepOnesThatAreMissingHaveNoSamples) {
    const MadePicture picture;
    Names names = write_tiles(folder_, picture, 3, 1, write_deep);
    names.erase(names.begin() + 1);
    expect_refused(names, MergeOutcome::NoPicture, {"tile 2 of 3x1 is missing"});
    EXPECT_EQ(merge(names, out_, true).outcome, MergeOutcome::Written);
}

TEST_F(MergeTiles, ThatCannotBeReadAreNamed) {
    const MadePicture picture;
    Names names = write_tiles(folder_, picture, 2, 1, write_flat);
    const std::string bytes = file_text(names[1]);
    const auto put = [&](const std::string& text) { std::ofstream(names[1], std::ios::binary) << text; };
    const auto refused = [&](const std::string& why) {
        expect_refused(names, MergeOutcome::Unreadable, {"tile2.exr", why});
    };
    for (const size_t length : {size_t{4}, size_t{20}, size_t{200}, bytes.size() / 2, bytes.size() - 1}) {
        SCOPED_TRACE(length);
        put(bytes.substr(0, length));
        refused("cannot read");
    }
    put("P6 1 1 255\nabc");
    refused("it is no OpenEXR file");
    put("");
    refused("it is no OpenEXR file");
    std::filesystem::remove(names[1]);
    refused("there is no such file");
    std::filesystem::create_directory(names[1]);
    refused("it is no file");
    std::filesystem::remove(names[1]);
    write_zeros(names[1], picture.tile_header({2, 1, 2}));  // which are compressed, unlike noise
    std::string damaged = file_text(names[1]);
    for (size_t i = 1; i <= 10; ++i) damaged[damaged.size() - i] ^= 1;
    SCOPED_TRACE("damaged");
    put(damaged);
    refused("cannot read");
}

TEST_F(MergeTiles, AllThatCannotBeReadAreNamed) {
    expect_refused({folder_.file("one.exr"), folder_.file("two.exr")}, MergeOutcome::Unreadable,
                   {"one.exr", "two.exr"});
}

TEST_F(MergeTiles, OfOtherKindsAreRefused) {
    const MadePicture picture;
    const Names names{folder_.file("a.exr"), folder_.file("b.exr")};
    write_flat(names[0], picture.tile_header({2, 1, 1}));
    MadePicture halved = picture;
    halved.change = [](Imf::Header& header) {
        header.channels().insert("Z", Imf::Channel(Imf::FLOAT, 2, 2));
        header.channels().insert("R", Imf::Channel(Imf::HALF, 2, 2));
        header.channels().insert("id", Imf::Channel(Imf::UINT, 2, 2));
    };
    write_zeros(names[1], halved.header({20, 0, 40, 30}));
    expect_refused(names, MergeOutcome::Unreadable, {"b.exr", "does not have a value for every pixel"});
    {
        std::vector<Imf::Header> headers{picture.header({20, 0, 40, 30}), picture.header({20, 0, 40, 30})};
        headers[0].setName("one"), headers[1].setName("two");
        for (Imf::Header& header : headers) header.setType(Imf::SCANLINEIMAGE);
        const Imf::MultiPartOutputFile file(names[1].c_str(), headers.data(), 2, false, 0);
    }
    expect_refused(names, MergeOutcome::Unreadable, {"b.exr", "it has 2 parts, not one"});
    write_deep(names[1], picture.header({20, 0, 40, 30}));
    expect_refused(names, MergeOutcome::NoPicture, {"b.exr", "one is deep, the other is not"});
}

TEST_F(MergeTiles, OfOtherPicturesAreRefused) {
    const Names names{folder_.file("a.exr"), folder_.file("b.exr")};
    const auto expect_other = [&](const std::string& attribute,
                                  const std::function<void(Imf::Header&)>& change) {
        MadePicture picture;
        picture.change = [](Imf::Header& header) { header.insert("frame", Imf::IntAttribute(7)); };
        write_flat(names[0], picture.tile_header({2, 1, 1}));
        Imf::Header header = picture.tile_header({2, 1, 2});
        change(header);
        write_zeros(names[1], header);
        expect_refused(names, MergeOutcome::NoPicture,
                       {"a.exr\" and \"", "b.exr\" are not of one picture", attribute}, true);
    };
    expect_other("displayWindow", [](Imf::Header& h) { h.displayWindow().max.x = 40; });
    expect_other("channels", [](Imf::Header& h) { h.channels().insert("G", Imf::Channel(Imf::HALF)); });
    expect_other("channels", [](Imf::Header& h) { h.channels().insert("R", Imf::Channel(Imf::FLOAT)); });
    expect_other("pixelAspectRatio", [](Imf::Header& h) { h.pixelAspectRatio() = 2; });
    expect_other("frame", [](Imf::Header& h) { h.insert("frame", Imf::IntAttribute(8)); });
    expect_other("worldToCamera", [](Imf::Header& h) { Imf::addWorldToCamera(h, M44f()); });
    expect_other("one is tile 1 of 2x1, the other 2 of 1x2",
                 [](Imf::Header& h) { h.insert("tile", Imf::StringAttribute("2 of 1x2")); });
}

TEST_F(MergeTiles, KeepWhatTheirHeadersHaveInCommon) {
    MadePicture picture;
    Names names;
    for (int number = 1; number <= 2; ++number) {
        picture.change = [&](Imf::Header& header) {
            header.insert("scene", Imf::StringAttribute("a.rib"));
            header.insert("renderTime", Imf::StringAttribute(std::to_string(number)));
            header.insert("renderStats",
                          Imf::StringAttribute("{\"threads\":" + std::to_string(number) + "}"));
            header.insert("owner", Imf::StringAttribute(number == 1 ? "me" : "you"));
            Imf::addCapDate(header, number == 1 ? "2026:01:31 23:59:59" : "2026:02:01 00:00:01");
        };
        names.push_back(folder_.file("tile" + std::to_string(number) + ".exr"));
        write_flat(names.back(), picture.tile_header({1, 2, number}));
    }
    const Merged merged = merge(names, out_);
    EXPECT_EQ(merged.outcome, MergeOutcome::Written);
    EXPECT_NE(merged.said.find("attribute \"owner\" is left out"), std::string::npos) << merged.said;
    EXPECT_EQ(std::count(merged.said.begin(), merged.said.end(), '\n'), 1) << merged.said;
    const Imf::InputFile file(out_.c_str(), 0);
    const Imf::Header& header = file.header();
    EXPECT_EQ(header.typedAttribute<Imf::StringAttribute>("scene").value(), "a.rib");
    EXPECT_EQ(Imf::capDate(header), "2026:01:31 23:59:59");
    for (const char* name : {"tile", "renderTime", "renderStats", "owner", "type"})
        EXPECT_EQ(header.find(name), header.end()) << name;
}

TEST_F(MergeTiles, SayWhereTheyCannotBeWritten) {
    const MadePicture picture;
    const Names names = write_tiles(folder_, picture, 2, 1, write_flat);
    const Merged nowhere = merge(names, folder_.file("none/out.exr"));
    EXPECT_EQ(nowhere.outcome, MergeOutcome::Unwritable);
    EXPECT_NE(nowhere.said.find("none/out.exr"), std::string::npos) << nowhere.said;
    const testing::FileSizeLimit full(3000);
    const Merged on_full_disk = merge(names, out_);
    EXPECT_EQ(on_full_disk.outcome, MergeOutcome::Unwritable) << on_full_disk.said;
    EXPECT_EQ(folder_.names().size(), 2u);
}

TEST_F(MergeTiles, EndEarlyWhenToldTo) {
    const Names names = write_tiles(folder_, {}, 2, 1, write_flat);
    Diagnostics diagnostics;
    const std::atomic<bool> cancelled = true;
    EXPECT_EQ(merge_tiles(names, out_, {false, &cancelled}, diagnostics), MergeOutcome::Cancelled);
    EXPECT_FALSE(std::filesystem::exists(out_));
}

}  // namespace
}  // namespace trapeze
