#include "shade/maps/make_maps.h"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "core/files/temporary_folder_harness.h"
#include "core/random.h"
#include "shade/maps/map_files_harness.h"

namespace trapeze {
namespace {

using OIIO::ImageSpec;
using OIIO::TypeDesc;

/// 188 of 255 in linear light (IEC 61966-2-1).
const float kLinear188 = std::pow((188 / 255.0f + 0.055f) / 1.055f, 2.4f);

class MakeMapsTest : public MapFilesTest {
  protected:
    float look(const std::string& file, float s, float t, float width = 0, MapOptions options = {}) {
        Textures textures(options_, &diagnostics_);
        const Plane out = plane(kLanes, -1);
        const Plane planes[] = {out};
        textures.texture(textures.find(file, {}),
                         {plane({s}), plane({t}), plane({width}), {}, {}, plane({width})}, options, {1, {}},
                         planes);
        return out[0];
    }
    V3f seen(const std::string& file, const V3f& R) {
        Textures textures(options_, &diagnostics_);
        const Plane planes[] = {plane(kLanes, -1), plane(kLanes, -1), plane(kLanes, -1)};
        textures.environment(textures.find(file, {}), {{plane({R.x}), plane({R.y}), plane({R.z})}, {}, {}},
                             {}, {1, {}}, planes);
        return {planes[0][0], planes[1][0], planes[2][0]};
    }
    std::string grey(const std::string& name, float value) {
        return write(name, ImageSpec(16, 16, 1, TypeDesc::UINT8), [&](int, int, int) { return value; });
    }
    bool is_alone(const std::string& name) const {
        for (const auto& entry : std::filesystem::directory_iterator(folder_))
            if (entry.path().filename().string().starts_with(name + ".")) return false;
        return true;
    }
};

/// What maps of a picture hold that is 188 of 255 everywhere.
TEST_F(MakeMapsTest, NumbersAreKeptUnlessTheyAreSaidToBeEncoded) {
    constexpr float kStored = 188 / 255.0f;
    const struct {
        Transfer transfer;
        int channels;
        float texture, bump;
    } cases[] = {{Transfer::Linear, 3, kStored, kStored},
                 {Transfer::Srgb, 3, kLinear188, kLinear188},
                 {Transfer::Srgb, 1, kLinear188, kLinear188},
                 {Transfer::Auto, 3, kLinear188, kStored},
                 {Transfer::Auto, 1, kStored, kStored}};
    for (const auto& c : cases) {
        const std::string picture = write("grey.png", ImageSpec(16, 16, c.channels, TypeDesc::UINT8),
                                          [&](int, int, int) { return kStored; });
        MapMaking making;
        making.transfer = c.transfer;
        ASSERT_EQ(make_texture_map(picture, path("grey.tex"), making), "");
        ASSERT_EQ(make_bump_map(picture, path("grey.bump"), making), "");
        ASSERT_EQ(make_lat_long_environment(picture, path("grey.env"), making), "");
        for (const float width : {0.0f, 0.5f}) {
            EXPECT_NEAR(look(path("grey.tex"), 0.3f, 0.6f, width), c.texture, 1e-3f) << c.channels;
            EXPECT_NEAR(look(path("grey.bump"), 0.3f, 0.6f, width), c.bump, 1e-3f) << c.channels;
        }
        EXPECT_NEAR(seen(path("grey.env"), V3f(1, 2, 3)).x, c.texture, 1e-3f) << c.channels;
    }
    EXPECT_TRUE(is_alone("grey.tex"));
}

TEST_F(MakeMapsTest, SixteenBitsKeepTheirNumbers) {
    const std::string picture = write("height.tif", ImageSpec(16, 16, 1, TypeDesc::UINT16),
                                      [](int, int, int) { return 12345 / 65535.0f; });
    ASSERT_EQ(make_texture_map(picture, path("height.tex"), {}), "");
    EXPECT_NEAR(look(path("height.tex"), 0.3f, 0.6f), 12345 / 65535.0f, 1e-6f);
}

TEST_F(MakeMapsTest, SmallerPicturesAverageLight) {
    const std::string picture = write("checker.png", ImageSpec(64, 64, 1, TypeDesc::UINT8),
                                      [](int x, int y, int) { return static_cast<float>((x + y) % 2); });
    for (const char* filter : {"box", "gaussian", "bessel", "no such filter"}) {
        ASSERT_EQ(make_texture_map(picture, path("checker.tex"), {"periodic", "periodic", filter}), "");
        EXPECT_NEAR(look(path("checker.tex"), 0.5f, 0.5f, 0.5f), 0.5f, 0.02f) << filter;
        MapOptions nearest;
        nearest.filter = MapOptions::Filter::Nearest;
        EXPECT_EQ(look(path("checker.tex"), 10.5f / 64, 20.5f / 64, 0, nearest), 0);
        EXPECT_EQ(look(path("checker.tex"), 11.5f / 64, 20.5f / 64, 0, nearest), 1);
    }
}

TEST_F(MakeMapsTest, WrapModesAreKept) {
    const std::string picture = write("sides.exr", ImageSpec(16, 16, 1, TypeDesc::HALF),
                                      [](int x, int, int) { return x < 8 ? 0.25f : 1.0f; });
    ASSERT_EQ(make_texture_map(picture, path("periodic.tex"), {"periodic", "periodic", "box"}), "");
    ASSERT_EQ(make_texture_map(picture, path("clamp.tex"), {"clamp", "black", "box"}), "");
    EXPECT_NEAR(look(path("periodic.tex"), 1.25f, 0.5f), 0.25f, 1e-3f);
    EXPECT_NEAR(look(path("clamp.tex"), 1.25f, 0.5f), 1, 1e-3f);
    EXPECT_NEAR(look(path("clamp.tex"), 0.25f, 1.5f), 0, 1e-3f);
}

TEST_F(MakeMapsTest, LatLongMapsHaveZUp) {
    // Red above, green below; blue where x is negative.
    const std::string picture =
        write("sky.exr", ImageSpec(64, 32, 3, TypeDesc::FLOAT), [](int x, int y, int c) {
            if (c == 2) return x >= 16 && x < 48 ? 1.0f : 0.0f;
            return (y < 16) == (c == 0) ? 1.0f : 0.0f;
        });
    ASSERT_EQ(make_lat_long_environment(picture, path("sky.env"), {}), "");
    Textures textures(options_, &diagnostics_);
    EXPECT_EQ(textures.info(path("sky.env"))->type, "environment");
    const auto expect = [&](const V3f& R, const V3f& color) {
        const V3f found = seen(path("sky.env"), R);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(found[k], color[k], 0.02f) << R << k;
    };
    expect({1, 0.5f, 1}, {1, 0, 0});
    expect({1, -0.5f, -1}, {0, 1, 0});
    expect({-1, 0.5f, 1}, {1, 0, 1});
    expect({-1, 0, -1}, {0, 1, 1});
}

class CubeFacesTest : public MakeMapsTest {
  protected:
    /// Face i is red = (i + 1) / 10, green where right of its middle, blue where above it.
    std::string make(float fov = 90) {
        std::array<std::string, 6> faces;
        for (int i = 0; i < 6; ++i)
            faces[i] = write("face" + std::to_string(i) + ".exr", ImageSpec(32, 32, 3, TypeDesc::FLOAT),
                             [&](int x, int y, int c) {
                                 if (c == 0) return 0.1f * static_cast<float>(i + 1);
                                 return c == 1 ? (x >= 16 ? 1.0f : 0.0f) : (y < 16 ? 1.0f : 0.0f);
                             });
        EXPECT_EQ(make_cube_face_environment(faces, path("cube.env"), fov, {}), "");
        return path("cube.env");
    }
};

TEST_F(CubeFacesTest, FacesLieAsRISpecDrawsThem) {
    const std::string file = make();
    struct Look {
        V3f R;
        int face;
        float right, above;
    };
    // A way off each face's middle, towards what is right of it and above it, and the other way.
    const Look looks[] = {
        {{1, 0.4f, -0.4f}, 0, 1, 1},  {{1, -0.4f, 0.4f}, 0, 0, 0},  {{-1, 0.4f, 0.4f}, 1, 1, 1},
        {{-1, -0.4f, 0.4f}, 1, 1, 0}, {{0.4f, 1, -0.4f}, 2, 1, 1},  {{-0.4f, 1, -0.4f}, 2, 0, 1},
        {{0.4f, -1, 0.4f}, 3, 1, 1},  {{0.4f, -1, -0.4f}, 3, 1, 0}, {{0.4f, 0.4f, 1}, 4, 1, 1},
        {{0.4f, -0.4f, 1}, 4, 1, 0},  {{-0.4f, 0.4f, -1}, 5, 1, 1}, {{0.4f, 0.4f, -1}, 5, 0, 1},
    };
    for (const Look& look : looks) {
        const V3f found = seen(file, look.R);
        EXPECT_NEAR(found.x, 0.1f * static_cast<float>(look.face + 1), 0.01f) << look.R;
        EXPECT_NEAR(found.y, look.right, 0.02f) << look.R;
        EXPECT_NEAR(found.z, look.above, 0.02f) << look.R;
    }
}

TEST_F(CubeFacesTest, WiderFacesOverlap) {
    // Of 127 degrees, a face's picture spans -2..2: what is 0.4 off the middle is in the inner fifth.
    std::array<std::string, 6> faces;
    for (int i = 0; i < 6; ++i)
        faces[i] = write("wide" + std::to_string(i) + ".exr", ImageSpec(80, 80, 1, TypeDesc::FLOAT),
                         [](int x, int, int) { return static_cast<float>(x) < 48 ? 0.0f : 1.0f; });
    ASSERT_EQ(make_cube_face_environment(faces, path("wide.env"), 2 * 63.43495f, {}), "");
    EXPECT_NEAR(seen(path("wide.env"), V3f(0.3f, 0, 1)).x, 0, 0.02f);
    EXPECT_NEAR(seen(path("wide.env"), V3f(0.5f, 0, 1)).x, 1, 0.02f);
}

class MakeShadowTest : public MakeMapsTest {
  protected:
    std::string depths(const std::string& name) {
        ImageSpec spec(32, 32, 1, TypeDesc::FLOAT);
        const M44f m;
        spec.attribute("worldtocamera", OIIO::TypeMatrix, &m);
        spec.attribute("worldtoscreen", OIIO::TypeMatrix, &m);
        return write(name, spec, [](int x, int, int) { return x < 16 ? 5.0f : 1e30f; });
    }
    float hidden(const std::string& file, float x) {
        Textures textures(options_, &diagnostics_);
        const Plane out = plane(kLanes, -1);
        textures.shadow(textures.find_shadow(file, {}), {{plane({x}), {}, plane({10})}, {}, {}}, M44f(), {},
                        {1, {}}, out);
        EXPECT_EQ(textures.info(file)->type, "shadow");
        return out[0];
    }
};

TEST_F(MakeShadowTest, DepthsAndMatricesAreKept) {
    ASSERT_EQ(make_shadow_map(depths("z.tif"), path("z.shd")), "");
    EXPECT_EQ(hidden(path("z.shd"), -0.5f), 1);
    EXPECT_EQ(hidden(path("z.shd"), 0.5f), 0);
    EXPECT_TRUE(reported_.empty());
}

TEST_F(MakeShadowTest, MayReplaceItsPicture) {
    const std::string file = depths("z.tif");
    ASSERT_EQ(make_shadow_map(file, file), "");
    EXPECT_EQ(hidden(file, -0.5f), 1);
}

TEST_F(MakeShadowTest, NeedsMatrices) {
    EXPECT_THAT(make_shadow_map(grey("grey.tif", 0.5f), path("no.shd")).text,
                ::testing::HasSubstr("worldtocamera"));
    EXPECT_FALSE(std::filesystem::exists(path("no.shd")));
}

TEST_F(MakeMapsTest, AFullDiskIsNoticedAndLeavesNothing) {
    // Noise, which does not compress.
    ImageSpec spec(64, 32, 3, TypeDesc::FLOAT);
    const M44f m;
    for (const char* name : {"worldtocamera", "worldtoscreen"}) spec.attribute(name, OIIO::TypeMatrix, &m);
    uint32_t seed = 0;
    const auto noise = [&](int, int, int) { return unit_float(hash(seed++)) + 0.5f; };
    const std::string picture = write("noise.tif", spec, noise);
    spec.nchannels = 1;
    const std::string depths = write("depths.tif", spec, noise), map = path("map");
    MapProblem problems[5];
    for (const rlim_t bytes : {0, 5000}) {
        {
            const testing::FileSizeLimit full(bytes);
            problems[0] = make_texture_map(picture, map, {});
            problems[1] = make_bump_map(picture, map, {});
            problems[2] = make_lat_long_environment(picture, map, {});
            problems[3] = make_cube_face_environment({picture, picture, picture, picture, picture, picture},
                                                     map, 90, {});
            problems[4] = make_shadow_map(depths, map);
        }
        for (const MapProblem& problem : problems) {
            EXPECT_NE(problem, "") << bytes;
            EXPECT_TRUE(problem.is_of_output) << problem.text;
        }
    }
    EXPECT_FALSE(std::filesystem::exists(map));
    EXPECT_TRUE(is_alone("map"));
}

TEST_F(MakeMapsTest, FailuresSayWhyAndLeaveWhatWasThere) {
    std::ofstream(path("old.tex")) << "old";
    EXPECT_NE(make_texture_map(path("nowhere.png"), path("old.tex"), {}), "");
    const std::string picture = grey("grey.png", 0.5f);
    EXPECT_THAT(make_texture_map(picture, path("old.tex"), {"round", "periodic", "box"}).text,
                ::testing::HasSubstr("\"round\""));
    EXPECT_TRUE(make_texture_map(picture, path("no/such/folder.tex"), {}).is_of_output);
    EXPECT_FALSE(make_texture_map(path("broken.png"), path("old.tex"), {}).is_of_output);
    std::ofstream(path("broken.png")) << "no picture";
    EXPECT_NE(make_texture_map(path("broken.png"), path("old.tex"), {}), "");
    EXPECT_NE(make_bump_map(path("broken.png"), path("old.tex"), {}), "");
    EXPECT_NE(make_lat_long_environment(path("broken.png"), path("old.tex"), {}), "");
    EXPECT_NE(make_cube_face_environment({picture, picture, picture, picture, picture, path("broken.png")},
                                         path("old.tex"), 90, {}),
              "");
    std::ifstream old(path("old.tex"));
    std::string text;
    old >> text;
    EXPECT_EQ(text, "old");
    EXPECT_TRUE(is_alone("old.tex"));
}

}  // namespace
}  // namespace trapeze
