#include "composite/displays/cryptomatte_header.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "composite/mattes/murmur_hash.h"

namespace trapeze {
namespace {

std::string manifest_of(const std::string& name) {
    auto attributes = std::make_shared<Attributes>();
    attributes->name = name;
    Scene scene;
    scene.primitives.resize(1);
    scene.primitives[0].attributes = attributes;
    return matte_manifest(scene, MatteLayer::Object, Diagnostics());
}

TEST(MatteManifest, HasHashesAsHexadecimalDigits) {
    EXPECT_EQ(manifest_of("hello"), R"({"hello":"248bfa47"})");
    const std::string odd = "a\"b\\c\n";
    EXPECT_EQ(manifest_of(odd), R"({"a\"b\\c\n":")" + fmt::format("{:08x}", murmur_hash_3(odd)) + "\"}");
}

TEST(MatteManifest, IsJsonWhateverBytesANameHas) {
    for (const char* name : {"Kugel \xC3\xA4", "latin \xE4", "\xFF\xFE", "\x01\x7F"}) {
        const auto manifest = nlohmann::json::parse(manifest_of(name));
        EXPECT_EQ(manifest.size(), 1u) << name;
        EXPECT_EQ(manifest.begin().value().get<std::string>().size(), 8u) << name;
    }
    EXPECT_NE(manifest_of("latin \xE4").find("latin \xEF\xBF\xBD"), std::string::npos);
}

}  // namespace
}  // namespace trapeze
