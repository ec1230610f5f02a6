#include "pipeline/compare/record/replay.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/compare/compare_harness.h"
#include "pipeline/compare/results_json.h"

namespace trapeze {
namespace {

using Value = nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

/// A comparison of two methods, made once.
const Comparison& recorded_comparison() {
    static const Comparison made = [] {
        const testing::SharedScene shared("defocus_motion.rib");
        CompareSettings settings;
        settings.samplers = testing::samplers_of({"raytrace", "interval"});
        settings.rates = {{1, 1}, {2, 2}};
        settings.measure.rounds = 2;
        settings.reference_side = 4;
        Comparison c = *compare(*shared.frame, settings);
        c.scene = "a.rib", c.scenes = {"a.rib", "b.rib"}, c.machine.trapeze = "1.2.3";
        c.options = {{"option", {"Color 1 0 0", "Opacity 1 1 1"}}, {"samples", {"1x1,2x2"}}};
        c.inputs = {{"a.rib", 12, std::string(64, 'a')}, {"b.rib", 0, ""}};
        return c;
    }();
    return made;
}

Value recorded_json() {
    return Value::parse(to_json(recorded_comparison()).dump());
}

std::string problem_of(const std::string& text) {
    std::string error;
    EXPECT_FALSE(read_recorded(text, &error));
    return error;
}

TEST(Replay, ReadsWhatCompareHasWritten) {
    std::string error;
    const auto recorded = read_recorded(to_json(recorded_comparison()).dump(), &error);
    ASSERT_TRUE(recorded) << error;
    EXPECT_EQ(recorded->scenes, recorded_comparison().scenes);
    EXPECT_EQ(recorded->options, recorded_comparison().options);
    EXPECT_EQ(recorded->inputs, recorded_comparison().inputs);
    EXPECT_EQ(recorded->version, "1.2.3");
    EXPECT_EQ(recorded->whole, recorded_json());
}

TEST(Replay, SaysWhatIsWrongWithOtherFiles) {
    EXPECT_THAT(problem_of(""), HasSubstr("no JSON"));
    EXPECT_THAT(problem_of("{\"program\": \"trapeze compare\", "), HasSubstr("no JSON from byte 32"));
    EXPECT_THAT(problem_of("\xff\xfe"), HasSubstr("no JSON"));
    for (const char* other :
         {"[]", "7", "null", "{}", R"({"program": 7})", R"({"program": "trapeze study"})"})
        EXPECT_THAT(problem_of(other), HasSubstr("not written by `trapeze compare --json`")) << other;
    const std::string whole = recorded_json().dump();
    EXPECT_THAT(problem_of(whole.substr(0, whole.size() / 2)), HasSubstr("no JSON"));
}

TEST(Replay, NamesTheFieldThatIsMissingOrWrong) {
    for (const char* field : {"results", "machine", "scenes", "options", "inputs"})
        for (const Value& instead :
             {Value("x"), Value(3), Value::array({1}), Value{{"samples", 2}}, Value()}) {
            Value broken = recorded_json();
            if (instead.is_null())
                broken.erase(field);
            else if (std::string(field) == "results" && instead.is_array())
                continue;
            else
                broken[field] = instead;
            EXPECT_THAT(problem_of(broken.dump()), HasSubstr("\"" + std::string(field) + "\"")) << instead;
        }
    Value broken = recorded_json();
    broken["inputs"][0]["bytes"] = -1;
    EXPECT_THAT(problem_of(broken.dump()), HasSubstr("\"inputs\""));
    broken = recorded_json(), broken["options"]["samples"] = Value::array();
    EXPECT_THAT(problem_of(broken.dump()), HasSubstr("\"options\""));
}

/// Nothing walks into what nobody has written.
TEST(Replay, DeepNestingIsNoTrouble) {
    const std::string open(1'000'000, '['), close(1'000'000, ']');
    EXPECT_THAT(problem_of(open), HasSubstr("no JSON"));
    EXPECT_THAT(problem_of(open + close), HasSubstr("not written by"));
    std::string text = to_json(recorded_comparison()).dump();
    text.insert(text.size() - 1, ",\"width\": " + open + close + ",\"rounds\": " + open + close);
    std::string error;
    const auto recorded = read_recorded(text, &error);
    ASSERT_TRUE(recorded) << error;
    EXPECT_THAT(compare_figures(recorded->whole, recorded_json()).differences,
                UnorderedElementsAre("\"width\" was a list, is 96", "\"rounds\" was a list, is 2"));
}

/// Memory of the process is a matter of what was there before.
TEST(Replay, EqualFiguresAreEqualWhateverTheTimes) {
    Value other = recorded_json();
    other["machine"]["threads"] = 77, other["shade_seconds"] = 1e9;
    other["results"][1]["build_seconds_by_round"] = {1, 2, 3};
    other["results"][1]["ratio_to_baseline"] = 9, other["results"][1]["samples_per_second"] = 1;
    other["results"][1]["build_peak_bytes"] = 12345;
    other["verdict"] = {"interval is faster"};
    const ReplayOutcome outcome = compare_figures(recorded_json(), other);
    EXPECT_THAT(outcome.differences, IsEmpty());
    EXPECT_GT(outcome.compared, 4u * 15);
}

TEST(Replay, EveryOtherFigureCounts) {
    size_t changed = 0;
    const Value whole = recorded_json();
    for (const auto& [name, value] : whole["results"][2].items()) {
        if (!value.is_number() || name.find("seconds") != std::string::npos || name == "ratio_to_baseline" ||
            name == "samples_per_second" || name == "build_peak_bytes")
            continue;
        Value other = whole;
        other["results"][2][name] = value.get<double>() + 1;
        const auto differences = compare_figures(whole, other).differences;
        ASSERT_EQ(differences.size(), 1u) << name;
        if (name != "samples_x" && name != "samples_y") {
            EXPECT_THAT(differences[0], HasSubstr("raytrace at 2x2: \"" + name + "\" was ")) << name;
        }
        ++changed;
    }
    EXPECT_GT(changed, 15u);
    Value other = whole;
    other["verdict_without_times"][0] = "Nothing moves.";
    EXPECT_THAT(compare_figures(whole, other).differences,
                ElementsAre(HasSubstr("\"verdict_without_times[0]\" was \"The frame has")));
    other = whole, other["results"][0].erase("rmse"), other["results"][0]["new"] = 1;
    EXPECT_THAT(compare_figures(whole, other).differences,
                ElementsAre("raytrace at 1x1: \"new\" was not there, is 1",
                            AllOf(HasSubstr("raytrace at 1x1: \"rmse\" was 0"), HasSubstr("is not there"))));
    other = whole, other["results"].erase(3);
    EXPECT_THAT(compare_figures(whole, other).differences, ElementsAre("\"results\" was 4 values, is 3"));
}

TEST(Replay, MemoryOfOtherLibrariesIsTheirAffair) {
    Value whole = recorded_json();
    whole["results"][0]["method"] = "embree";
    Value other = whole;
    for (const char* field : {"tree_bytes", "bytes_per_micropolygon"}) other["results"][0][field] = 1;
    const size_t differing = find_named(visibility_methods(), "embree") ? 0 : 2;
    EXPECT_EQ(compare_figures(whole, other).differences.size(), differing);
    other["results"][0]["hits"] = 1;
    EXPECT_EQ(compare_figures(whole, other).differences.size(), differing + 1);
}

TEST(Replay, FilesThatChangedAreNamed) {
    const std::string a(64, 'a'), b(64, 'b');
    const std::vector<InputFile> recorded = {{"same", 1, a}, {"other", 1, a}, {"gone", 1, a}, {"-", 0, ""}};
    const std::vector<InputFile> now = {{"same", 1, a}, {"other", 2, b}, {"-", 0, ""}, {"new", 1, a}};
    EXPECT_THAT(changed_inputs(recorded, now),
                ElementsAre("\"other\" has changed: its SHA-256 was " + a + ", is " + b,
                            "\"gone\" was read then, and is not read now", HasSubstr("\"-\" cannot be held"),
                            "\"new\" is read now, and was not read then"));
    EXPECT_THAT(changed_inputs({recorded[0]}, {now[0]}), IsEmpty());
}

}  // namespace
}  // namespace trapeze
