/// Every spelling of what Attribute says of rays.
#include "pipeline/rib/state/ray_attributes.h"

#include "pipeline/rib/reading_harness.h"

namespace trapeze::testing {
namespace {

using ::testing::IsEmpty;
using HitMode = RayAttributes::HitMode;

/// Rays of a sphere behind the requests, of which nothing is said and which all have an effect.
RayAttributes rays_after(const std::string& requests) {
    const ReadOutcome outcome = read_world(requests + " " + kSphere);
    EXPECT_THAT(outcome.messages, IsEmpty()) << requests;
    EXPECT_THAT(outcome.summary.without_effect, IsEmpty()) << requests;
    return outcome.attributes().rays;
}

/// The kinds of rays that see it: D, S and T.
std::string seen_by(const std::string& requests) {
    const RayAttributes rays = rays_after(requests);
    return std::string(rays.diffuse ? "D" : "") + (rays.specular ? "S" : "") + (rays.transmission ? "T" : "");
}

TEST(RayAttributes, NothingIsSeenByRaysAtFirst) {
    const RayAttributes rays = rays_after("");
    EXPECT_FALSE(rays.seen());
    EXPECT_EQ(rays.transmission_hits, HitMode::Shader);
    EXPECT_EQ(rays.bias, 0);
    EXPECT_EQ(rays.max_diffuse, 1);
    EXPECT_EQ(rays.max_specular, 2);
    EXPECT_FALSE(rays.displaced);
}

TEST(RayAttributes, VisibilityIsByKind) {
    for (const std::string type : {"", "int ", "integer ", "uniform integer ", "float "}) {
        const auto visibility = [&](const std::string& name, const std::string& value) {
            return "Attribute \"visibility\" \"" + type + name + "\" " + value + " ";
        };
        EXPECT_EQ(seen_by(visibility("diffuse", "1")), "D") << type;
        EXPECT_EQ(seen_by(visibility("specular", "[1]")), "S") << type;
        EXPECT_EQ(seen_by(visibility("transmission", "1")), "T") << type;
        EXPECT_EQ(seen_by(visibility("trace", "[1]")), "DS") << type;
        EXPECT_EQ(seen_by(visibility("trace", "1") + visibility("diffuse", "0")), "S") << type;
        EXPECT_EQ(
            seen_by(visibility("diffuse", "1") + visibility("transmission", "1") + visibility("trace", "0")),
            "T")
            << type;
        EXPECT_EQ(seen_by(visibility("camera", "1")), "") << type;
    }
    EXPECT_EQ(seen_by("Attribute \"visibility\" \"int diffuse\" 1 \"int specular\" [1] \"transmission\" 1"),
              "DST");
}

/// There are no photon maps: that it is not seen by photons is so in any case, and no message.
TEST(RayAttributes, VisibilityForPhotonsIsTaken) {
    for (const char* value : {"\"int photon\" [1]", "\"photon\" 0", "\"string photon\" \"Cs\""}) {
        EXPECT_EQ(seen_by(std::string("Attribute \"visibility\" \"int specular\" 1 ") + value), "S") << value;
        const ReadOutcome outcome =
            read_world(std::string("Attribute \"visibility\" ") + value + " " + kSphere);
        EXPECT_EQ(outcome.summary.not_needed.size(), 1u) << value;
    }
}

TEST(RayAttributes, TransmissionWasATextOnce) {
    const auto transmission = [](const std::string& value) {
        return "Attribute \"visibility\" \"string transmission\" \"" + value + "\"";
    };
    for (const char* value : {"transparent", "none"}) EXPECT_EQ(seen_by(transmission(value)), "") << value;
    for (const auto& [value, mode] :
         {std::pair("opaque", HitMode::Opaque), {"Os", HitMode::Primitive}, {"shader", HitMode::Shader}}) {
        EXPECT_EQ(seen_by(transmission(value)), "T") << value;
        EXPECT_EQ(rays_after(transmission(value)).transmission_hits, mode) << value;
    }
    EXPECT_EQ(seen_by("Attribute \"visibility\" \"int transmission\" 1 " + transmission("transparent")), "");
}

TEST(RayAttributes, BitsOfRenderAreAsBmrtHasThem) {
    const char* const seen[] = {"", "", "DS", "DS", "T", "T", "DST", "DST"};
    for (int bits = 0; bits < 8; ++bits) {
        const std::string value = std::to_string(bits);
        EXPECT_EQ(seen_by("Attribute \"render\" \"integer visibility\" [" + value + "]"), seen[bits]) << bits;
    }
}

TEST(RayAttributes, HitModeIsAText) {
    const auto mode = [](const std::string& value) {
        return rays_after("Attribute \"shade\" \"string transmissionhitmode\" [\"" + value + "\"]")
            .transmission_hits;
    };
    EXPECT_EQ(mode("primitive"), HitMode::Primitive);
    EXPECT_EQ(mode("shader"), HitMode::Shader);
    EXPECT_EQ(rays_after("Attribute \"shade\" \"transmissionhitmode\" \"primitive\"").transmission_hits,
              HitMode::Primitive);
}

TEST(RayAttributes, EachKindHasItsHitMode) {
    const RayAttributes none = rays_after("");
    EXPECT_EQ(none.specular_hits, HitMode::Shader);
    EXPECT_FALSE(none.diffuse_hits);
    const RayAttributes rays = rays_after(
        "Attribute \"shade\" \"string specularhitmode\" [\"primitive\"] \"diffusehitmode\" [\"shader\"]");
    EXPECT_EQ(rays.specular_hits, HitMode::Primitive);
    EXPECT_EQ(rays.diffuse_hits, HitMode::Shader);
    EXPECT_EQ(rays.transmission_hits, HitMode::Shader);
}

TEST(RayAttributes, MembershipsAreSetAddedToAndTakenFrom) {
    using Groups = std::vector<std::string>;
    std::string text;
    const auto after = [&](const std::string& names) {
        text += "Attribute \"grouping\" \"string membership\" [\"" + names + "\"] ";
        return rays_after(text).groups;
    };
    EXPECT_EQ(after("a, b"), (Groups{"a", "b"}));
    EXPECT_EQ(after("+c a"), (Groups{"a", "b", "c"}));
    EXPECT_EQ(after("-b,x"), (Groups{"a", "c"}));
    EXPECT_EQ(after("+ d -a"), (Groups{"c", "d"}));
    EXPECT_EQ(after("e"), Groups{"e"});
    EXPECT_EQ(after(""), Groups{});
}

TEST(RayAttributes, TraceHasNumbers) {
    EXPECT_EQ(rays_after("Attribute \"trace\" \"float bias\" [.25]").bias, 0.25f);
    EXPECT_EQ(rays_after("Attribute \"trace\" \"bias\" .5").bias, 0.5f);
    EXPECT_EQ(rays_after("Attribute \"trace\" \"bias\" -1").bias, 0);
    EXPECT_EQ(rays_after("Attribute \"trace\" \"int maxdiffusedepth\" [3]").max_diffuse, 3);
    EXPECT_EQ(rays_after("Attribute \"trace\" \"maxdiffusedepth\" 0").max_diffuse, 0);
    EXPECT_FALSE(rays_after("").sample_motion);
    EXPECT_TRUE(rays_after("Attribute \"trace\" \"int samplemotion\" 1").sample_motion);
    EXPECT_FALSE(rays_after("Attribute \"trace\" \"samplemotion\" 1 Attribute \"trace\" \"samplemotion\" 0")
                     .sample_motion);
    EXPECT_EQ(rays_after("Attribute \"trace\" \"int maxspeculardepth\" 7").max_specular, 7);
    EXPECT_EQ(rays_after("Attribute \"trace\" \"maxspeculardepth\" [-1]").max_specular, 0);
    EXPECT_LE(rays_after("Attribute \"trace\" \"maxspeculardepth\" 2000000000").max_specular, 1000);
    EXPECT_TRUE(rays_after("Attribute \"trace\" \"int displacements\" [1]").displaced);
    EXPECT_FALSE(rays_after("Attribute \"trace\" \"displacements\" 0").displaced);
    const RayAttributes all =
        rays_after("Attribute \"trace\" \"bias\" .5 \"maxdiffusedepth\" 4 \"maxspeculardepth\" 5");
    EXPECT_EQ(all.bias, 0.5f);
    EXPECT_EQ(all.max_diffuse, 4);
    EXPECT_EQ(all.max_specular, 5);
}

TEST(RayAttributes, BlocksRestoreThem) {
    const ReadOutcome outcome =
        read_world("AttributeBegin Attribute \"visibility\" \"trace\" 1 Attribute \"trace\" \"bias\" 1 " +
                   kSphere + "AttributeEnd " + kSphere);
    EXPECT_TRUE(outcome.attributes(0).rays.seen());
    EXPECT_FALSE(outcome.attributes(1).rays.seen());
    EXPECT_EQ(outcome.attributes(0).rays.bias, 1);
    EXPECT_EQ(outcome.attributes(1).rays.bias, 0);
}

TEST(RayAttributes, ObjectsKeepTheirOwnAndTakeTheRest) {
    const std::string seen = "Attribute \"visibility\" \"specular\" 1 ";
    const ReadOutcome outcome =
        read_world("ObjectBegin 1 " + seen + kSphere + "ObjectEnd ObjectBegin 2 " + kSphere +
                   "ObjectEnd ObjectInstance 1 ObjectInstance 2 " + seen + "ObjectInstance 2");
    ASSERT_EQ(outcome.count(), 3u);
    EXPECT_TRUE(outcome.attributes(0).rays.specular);
    EXPECT_FALSE(outcome.attributes(1).rays.specular);
    EXPECT_TRUE(outcome.attributes(2).rays.specular);
}

TEST(RayOptions, DepthHasABound) {
    const auto depth = [](const std::string& value, size_t messages = 0) {
        const ReadOutcome outcome =
            read_text("Option \"trace\" \"int maxdepth\" [" + value + "] WorldBegin " + kSphere + "WorldEnd");
        EXPECT_EQ(outcome.messages.size(), messages) << value;
        EXPECT_THAT(outcome.summary.without_effect, IsEmpty());
        return outcome.scene().options.max_ray_depth;
    };
    EXPECT_EQ(depth("3"), 3);
    EXPECT_EQ(depth("0"), 0);
    EXPECT_EQ(depth("-4"), 0);
    EXPECT_EQ(depth("100"), 100);
    EXPECT_EQ(depth("1000000", 1), 100);
    EXPECT_EQ(read_world(kSphere).scene().options.max_ray_depth, 10);
}

}  // namespace
}  // namespace trapeze::testing
