#include "composite/mattes/matte_layers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "composite/mattes/murmur_hash.h"

namespace trapeze {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

TEST(MurmurHash3, HasItsPublishedValues) {
    EXPECT_EQ(murmur_hash_3(""), 0u);
    EXPECT_EQ(murmur_hash_3("hello"), 0x248bfa47u);
    EXPECT_EQ(murmur_hash_3("hello, world"), 0x149bbb7fu);
    EXPECT_EQ(murmur_hash_3("The quick brown fox jumps over the lazy dog"), 0x2e4ff723u);
    // Of the manifests that come with Cryptomatte's specification.
    EXPECT_EQ(murmur_hash_3("bunny"), 0x13851a76u);
    EXPECT_EQ(murmur_hash_3("default"), 0x42c9679fu);
}

TEST(MatteLayers, IdsAreNumbersOfOrdinaryFloats) {
    for (const uint32_t hash :
         {0x00000000u, 0x00000001u, 0x80000000u, 0x7f800000u, 0xffffffffu, 0x7fc12345u, 0x007fffffu}) {
        EXPECT_TRUE(std::isnormal(matte_id(hash))) << hash;
        EXPECT_EQ(std::bit_cast<uint32_t>(matte_id(hash)), hash ^ 0x00800000u);
    }
    EXPECT_EQ(std::bit_cast<uint32_t>(matte_id(0x13851a76u)), 0x13851a76u);
}

Primitive primitive_of(const char* name, const char* asset, const char* shader, SourceLocation at) {
    auto attributes = std::make_shared<Attributes>();
    attributes->name = name, attributes->asset = asset;
    if (*shader) {
        auto surface = std::make_shared<ShaderInstance>();
        surface->name = shader;
        attributes->surface = surface;
    }
    Primitive primitive;
    primitive.attributes = attributes, primitive.location = at;
    return primitive;
}

struct NamedScene {
    Diagnostics sources;
    Scene scene;

    NamedScene() {
        const uint32_t file = sources.add_source("some/folder/a.rib");
        scene.primitives = {primitive_of("ball", "toys", "plastic", {file, 3, 1}),
                            primitive_of("cube", "toys", "plastic", {file, 4, 1}),
                            primitive_of("", "", "", {file, 12, 7}),
                            primitive_of("ball", "toys", "matte", {}), primitive_of("", "", "plastic", {})};
    }
};

TEST(MatteLayers, NamesAreOfAttributesShadersAndPlaces) {
    const NamedScene named;
    const auto names = [&](MatteLayer layer) {
        std::vector<std::string> all;
        for (const auto& [name, hash] : matte_names(named.scene, layer, named.sources)) {
            EXPECT_EQ(hash, murmur_hash_3(name));
            all.push_back(name);
        }
        return all;
    };
    EXPECT_THAT(names(MatteLayer::Object), ElementsAre("a.rib:12", "ball", "cube", "unnamed"));
    EXPECT_THAT(names(MatteLayer::Material), ElementsAre("defaultsurface", "matte", "plastic"));
    EXPECT_THAT(names(MatteLayer::Asset), ElementsAre("a.rib:12", "toys", "unnamed"));
}

TEST(MatteLayers, DisplaysAskForThem) {
    Options options;
    EXPECT_TRUE(matte_layers(options).empty());
    options.displays = {{"a", "exr", "crypto_asset", {}, {}},
                        {"a", "exr", "crypto_object", {}, {}},
                        {"b", "exr", "crypto_object", {}, {}},
                        {"c", "NULL", "crypto_material", {}, {}}};
    EXPECT_THAT(matte_layers(options), ElementsAre(MatteLayer::Object, MatteLayer::Asset));
    for (const MatteLayer layer : kMatteLayers) EXPECT_EQ(matte_layer_named(matte_layer_name(layer)), layer);
    EXPECT_FALSE(matte_layer_named("crypto"));
}

TEST(MatteKeys, TellApartWhatAnyLayerTellsApart) {
    const NamedScene named;
    const MatteKeys keys(named.scene, {MatteLayer::Material, MatteLayer::Asset}, named.sources);
    EXPECT_EQ(keys.key_of(0), keys.key_of(1)) << "other objects, of one material and asset";
    EXPECT_NE(keys.key_of(0), keys.key_of(3));
    EXPECT_NE(keys.key_of(0), keys.key_of(4));
    EXPECT_EQ(keys.id(keys.key_of(0), 0), matte_id(murmur_hash_3("plastic")));
    EXPECT_EQ(keys.id(keys.key_of(3), 1), matte_id(murmur_hash_3("toys")));
}

}  // namespace
}  // namespace trapeze
