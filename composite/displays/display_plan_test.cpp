#include "composite/displays/display_plan.h"

#include <gtest/gtest.h>

#include "core/scene/deep_pictures.h"

namespace trapeze {
namespace {

struct Planned {
    std::optional<DisplayPlan> plan;
    uint64_t warnings, notes;
};

Planned planned(const Display& display, const Options& options) {
    Diagnostics diagnostics;
    Planned result;
    result.plan = plan_display(display, options, aov_layout(options), diagnostics);
    result.warnings = diagnostics.count(Severity::Warning);
    result.notes = diagnostics.count(Severity::Note);
    EXPECT_EQ(diagnostics.count(Severity::Error), 0u);
    return result;
}

Planned planned(const Display& display) {
    const Options options;
    return planned(display, options);
}

Parameter floats(const std::string& name, std::vector<float> values) {
    return {name, {StorageClass::Uniform, ValueType::Float, static_cast<int>(values.size())}, values, {}};
}

Parameter text(const std::string& name, const std::string& value) {
    return {name, {StorageClass::Uniform, ValueType::String, 1}, {}, {value}};
}

TEST(DisplayPlan, DriverThenExtensionChoosesTheFormat) {
    const struct {
        const char *name, *type;
        FileFormat format;
        const char* path;
        uint64_t warnings, notes;
    } cases[] = {
        {"a.exr", "openexr", FileFormat::OpenExr, "a.exr", 0, 0},
        {"a.tif", "exr", FileFormat::OpenExr, "a.tif", 0, 0},
        {"a.exr", "file", FileFormat::OpenExr, "a.exr", 0, 0},
        {"a.TIF", "file", FileFormat::Tiff, "a.TIF", 0, 0},
        {"a.tiff", "tiff", FileFormat::Tiff, "a.tiff", 0, 0},
        {"a.png", "file", FileFormat::Png, "a.png", 0, 0},
        {"a.jpg", "file", FileFormat::Jpeg, "a.jpg", 0, 0},
        {"a", "file", FileFormat::OpenExr, "a", 0, 1},
        {"a.pic", "tiff", FileFormat::Tiff, "a.pic", 0, 0},
        {"a", "framebuffer", FileFormat::OpenExr, "a.exr", 1, 0},
        {"a.png", "it", FileFormat::Png, "a.png", 1, 0},
        {"a", "rgl", FileFormat::OpenExr, "a.exr", 1, 0},
        {"a.z", "zfile", FileFormat::Tiff, "a.z", 0, 0},
        {"a.exr", "shadow", FileFormat::Tiff, "a.exr", 0, 0},
        {"a.pic", "vortech", FileFormat::OpenExr, "a.pic", 1, 0},
    };
    for (const auto& c : cases) {
        const Planned result = planned({c.name, c.type, "rgba", {}, {}});
        ASSERT_TRUE(result.plan) << c.name << " " << c.type;
        EXPECT_EQ(result.plan->format, c.format) << c.name << " " << c.type;
        EXPECT_EQ(result.plan->path, c.path);
        EXPECT_EQ(result.warnings, c.warnings) << c.name << " " << c.type;
        EXPECT_EQ(result.notes, c.notes) << c.name << " " << c.type;
    }
    EXPECT_FALSE(planned({"a.exr", "null", "rgba", {}, {}}).plan);
}

/// A window's name is what its title says.
TEST(DisplayPlan, WindowsDoNotAskForWholeNumbersByTheirNames) {
    const Options options;
    for (const char* type : {"framebuffer", "it", "openexr", "file"})
        EXPECT_FALSE(asks_for_whole_numbers({"a.exr", type, "rgb", {}, {}}, options)) << type;
    for (const char* type : {"framebuffer", "It"})
        EXPECT_FALSE(asks_for_whole_numbers({"a.tif", type, "rgb", {}, {}}, options)) << type;
    for (const char* type : {"tiff", "file"})
        EXPECT_TRUE(asks_for_whole_numbers({"a.tif", type, "rgb", {}, {}}, options)) << type;
    Display quantized{"a.tif", "framebuffer", "rgb", {}, {}};
    quantized.parameters.set(floats("quantize", {0, 255, 0, 255}));
    EXPECT_TRUE(asks_for_whole_numbers(quantized, options));
}

TEST(DisplayPlan, WindowsDoNotOverwriteFiles) {
    Options options;
    options.displays = {{"a.tif", "file", "rgba", {}, {}},
                        {"a.tif", "framebuffer", "z", {}, {}},
                        {"b.exr", "framebuffer", "rgbz", {}, {}},
                        {"c.tif", "null", "a", {}, {}},
                        {"c.tif", "it", "a", {}, {}},
                        {"d.tif", "framebuffer", "rgb", {}, {}},
                        {"", "zframebuffer", "", {}, {}}};
    const bool written[] = {true, false, true, false, true, false, false};
    for (size_t i = 0; i < options.displays.size(); ++i) {
        const Planned result = planned(options.displays[i], options);
        EXPECT_EQ(result.plan.has_value(), written[i]) << i;
        EXPECT_EQ(result.warnings, i == 0 || i == 3 ? 0u : 1u) << i;
    }
}

TEST(DisplayPlan, Modes) {
    const struct {
        const char* mode;
        bool rgb, alpha, depth, id;
    } cases[] = {{"rgb", true, false, false, false}, {"rgba", true, true, false, false},
                 {"a", false, true, false, false},   {"z", false, false, true, false},
                 {"rgbz", true, false, true, false}, {"rgbaz", true, true, true, false},
                 {"az", false, true, true, false},   {"id", false, false, false, true},
                 {"", true, true, false, false}};
    for (const auto& c : cases) {
        const Planned result = planned({"a.exr", "exr", c.mode, {}, {}});
        ASSERT_TRUE(result.plan) << c.mode;
        EXPECT_EQ(result.plan->rgb, c.rgb) << c.mode;
        EXPECT_EQ(result.plan->alpha, c.alpha) << c.mode;
        EXPECT_EQ(result.plan->depth, c.depth) << c.mode;
        EXPECT_EQ(result.plan->id, c.id) << c.mode;
        EXPECT_EQ(result.warnings, 0u);
    }
    for (const char* mode : {"varying color foo", "bgr", "rgbaa", "P"}) {
        const Planned result = planned({"a.exr", "exr", mode, {}, {}});
        EXPECT_FALSE(result.plan) << mode;
        EXPECT_EQ(result.warnings, 1u) << mode;
    }
}

Display shows(ValueType type, const char* name, const char* file = "a.exr") {
    Display display{file, "file", "a variable", {}, {}};
    display.variable = DisplayVariable{name, type};
    return display;
}

Planned planned_variable(const Display& display, Options options) {
    options.displays = {shows(ValueType::Float, "other"), display};
    return planned(display, options);
}

Planned planned_variable(const Display& display) {
    const Options options;
    return planned_variable(display, options);
}

TEST(DisplayPlan, VariablesStandAloneAndAreNamedByTheirType) {
    using Names = std::vector<std::string>;
    const struct {
        ValueType type;
        Names names;
        bool floats;
    } cases[] = {{ValueType::Color, {"R", "G", "B"}, false},
                 {ValueType::Float, {"Y"}, true},
                 {ValueType::Normal, {"foo.X", "foo.Y", "foo.Z"}, true},
                 {ValueType::Point, {"foo.X", "foo.Y", "foo.Z"}, true},
                 {ValueType::Vector, {"foo.X", "foo.Y", "foo.Z"}, true}};
    for (const auto& c : cases) {
        const Planned result = planned_variable(shows(c.type, "foo"));
        ASSERT_TRUE(result.plan && result.plan->aov);
        EXPECT_EQ(result.warnings, 0u);
        EXPECT_FALSE(result.plan->rgb || result.plan->alpha || result.plan->depth || result.plan->id);
        EXPECT_EQ(result.plan->aov->offset, 1);  // after the other
        EXPECT_EQ(channel_names(*result.plan, false), c.names);
        EXPECT_EQ(result.plan->float_pixels, c.floats);
    }
}

TEST(DisplayPlan, TheVariableZIsTheDepth) {
    const Planned result = planned_variable(shows(ValueType::Float, "z"));
    ASSERT_TRUE(result.plan);
    EXPECT_TRUE(result.plan->depth);
    EXPECT_FALSE(result.plan->aov || result.plan->rgb || result.plan->alpha);
}

TEST(DisplayPlan, VariablesAreQuantizedByTheirOwnNameOrAsColourOrNotAtAll) {
    EXPECT_TRUE(planned_variable(shows(ValueType::Normal, "foo", "a.tif")).plan->quantization.to_float());
    EXPECT_EQ(planned_variable(shows(ValueType::Color, "foo", "a.tif")).plan->quantization.one, 255);
    Options options;
    options.quantize.set(floats("rgba", {65535, 0, 65535, 0}));
    options.quantize.set(floats("bar", {100, 0, 255, 0}));
    EXPECT_EQ(planned_variable(shows(ValueType::Color, "foo", "a.tif"), options).plan->quantization.one,
              65535);
    EXPECT_EQ(planned_variable(shows(ValueType::Float, "bar", "a.tif"), options).plan->quantization.one, 100);
    Display own = shows(ValueType::Float, "bar", "a.tif");
    own.parameters.set(floats("quantize", {5, 10, 0, 255}));
    EXPECT_EQ(planned_variable(own, options).plan->quantization.one, 10);
    EXPECT_EQ(planned_variable(own, options).plan->quantization.zero, 5);
}

TEST(DisplayPlan, VariablesBeyondTheMostChannelsAreNotWritten) {
    Options options;
    for (int i = 0; i <= kMostAovChannels; ++i)
        options.displays.push_back(shows(ValueType::Float, ("v" + std::to_string(i)).c_str()));
    EXPECT_TRUE(planned(options.displays[kMostAovChannels - 1], options).plan);
    const Planned result = planned(options.displays.back(), options);
    EXPECT_FALSE(result.plan);
    EXPECT_EQ(result.warnings, 1u);
}

TEST(DisplayPlan, DepthMapsAreDepthsAsFloatsWhateverTheirMode) {
    for (const char* driver : {"zfile", "shadow"})
        for (const char* mode : {"z", "rgba", ""}) {
            const Planned result = planned({"a.z", driver, mode, {}, {}});
            ASSERT_TRUE(result.plan);
            EXPECT_TRUE(result.plan->depth && result.plan->depth_map);
            EXPECT_FALSE(result.plan->rgb || result.plan->alpha);
            EXPECT_TRUE(result.plan->quantization.to_float());
        }
    EXPECT_FALSE(planned({"a.tif", "tiff", "z", {}, {}}).plan->depth_map);
}

TEST(DisplayPlan, WhatAFormatCannotHold) {
    const Planned depth_left_out = planned({"a.png", "png", "rgbaz", {}, {}});
    ASSERT_TRUE(depth_left_out.plan);
    EXPECT_FALSE(depth_left_out.plan->depth);
    EXPECT_EQ(depth_left_out.warnings, 1u);
    EXPECT_FALSE(planned({"a.png", "png", "z", {}, {}}).plan);
    EXPECT_FALSE(planned({"a.tif", "tiff", "id", {}, {}}).plan);
    const Planned depth = planned({"a.tif", "tiff", "z", {}, {}});
    ASSERT_TRUE(depth.plan);
    EXPECT_TRUE(depth.plan->quantization.to_float());
}

TEST(DisplayPlan, PixelTypes) {
    Display display{"a.exr", "exr", "rgba", {}, {}};
    EXPECT_FALSE(planned(display).plan->float_pixels);
    display.parameters.set(floats("quantize", {0, 0, 0, 0}));
    EXPECT_TRUE(planned(display).plan->float_pixels);
    display.parameters.set(text("exrpixeltype", "half"));
    EXPECT_FALSE(planned(display).plan->float_pixels);
    display.parameters = {};
    display.parameters.set(text("type", "float"));
    EXPECT_TRUE(planned(display).plan->float_pixels);
    display.parameters.set(text("compression", "PIZ"));
    EXPECT_EQ(planned(display).plan->compression, "piz");
    for (const char* name : {"compression", "exrcompression"}) {
        Display nameless{"a.exr", "openexr", "rgba", {}, {}};
        nameless.parameters.set(text(name, ""));
        const Planned result = planned(nameless);
        EXPECT_EQ(result.warnings, 1u) << name;
        EXPECT_EQ(result.plan->compression, "") << "the usual one";
    }
}

TEST(DisplayPlan, WhatMeansNothingIsTold) {
    const auto told = [](const Parameter& parameter, const char* driver = "exr") {
        Display display{"a.exr", driver, "rgba", {}, {}};
        display.parameters.set(text("storage", "tiled"));
        display.parameters.set(parameter);
        const Planned result = planned(display);
        EXPECT_TRUE(result.plan);
        return result.warnings;
    };
    EXPECT_EQ(told(text("type", "double")), 1u);
    EXPECT_EQ(told(text("type", "HALF")), 0u);
    EXPECT_EQ(told(floats("quantize", {0, 255, 255, 0})), 1u);
    EXPECT_EQ(told(floats("quantize", {0, 255, 255})), 1u);
    EXPECT_EQ(told(floats("quantize", {0, 255, 0, 255})), 0u);
    EXPECT_EQ(told(floats("tilesize", {0})), 1u);
    EXPECT_EQ(told(floats("tilesize", {32})), 0u);
    EXPECT_EQ(told(floats("deeptolerance", {-1})), 0u) << "is not deep";
    Display display{"a.tif", "tiff", "rgba", {}, {}};
    display.parameters.set(floats("quantize", {0, 255, 255, 0}));
    EXPECT_EQ(planned(display).plan->quantization.max, 255);
    Display deep{"a.exr", "deepexr", "rgba", {}, {}};
    for (const float tolerance : {-1.0f, 2.0f}) {
        deep.parameters.set(floats("deeptolerance", {tolerance}));
        EXPECT_EQ(planned(deep).warnings, 1u);
    }
}

TEST(DisplayPlan, ADeepPictureStaysDeepUnderAnotherName) {
    Display display{"a.exr", "deepexr", "rgba", {}, {}};
    rename(display, "b.exr");
    EXPECT_EQ(display.name, "b.exr");
    EXPECT_TRUE(is_deep(display));
    rename(display, "b.png");
    EXPECT_FALSE(is_deep(display));
    rename(display, "c.exr");
    EXPECT_FALSE(is_deep(display));
}

TEST(DisplayPlan, QuantizeOfTheDisplayBeatsThatOfTheOptions) {
    Display display{"a.tif", "tiff", "rgba", {}, {}};
    Options options;
    EXPECT_EQ(planned(display, options).plan->quantization.one, 255);
    options.quantize.set(floats("rgba", {65535, 0, 65535, 0.25f}));
    EXPECT_EQ(planned(display, options).plan->quantization.one, 65535);
    EXPECT_EQ(planned(display, options).plan->quantization.dither, 0.25f);
    display.parameters.set(floats("quantize", {16, 240, 1, 250}));
    const Quantization own = planned(display, options).plan->quantization;
    EXPECT_EQ(own.zero, 16);
    EXPECT_EQ(own.one, 240);
    EXPECT_EQ(own.min, 1);
    EXPECT_EQ(own.max, 250);
    EXPECT_EQ(own.dither, 0.25f);
    display.parameters.set(floats("quantize", {0, 0, 0, 0}));
    EXPECT_TRUE(planned(display, options).plan->quantization.to_float());
    EXPECT_FALSE(planned({"a.exr", "exr", "rgba", {}, {}}, options).plan->float_pixels);
}

TEST(DisplayPlan, WholeNumbersAndFloatsHoldMoreThanHalves) {
    const auto holds_more = [](const Display& display) {
        Options options;
        options.displays = {{"a.exr", "openexr", "rgba", {}, {}}, display};
        return holds_more_than_halves(options);
    };
    EXPECT_FALSE(holds_more({"b.exr", "file", "rgb", {}, {}}));
    EXPECT_FALSE(holds_more({"b.tif", "zfile", "z", {}, {}}));
    EXPECT_FALSE(holds_more({"b.tif", "null", "rgba", {}, {}}));
    EXPECT_TRUE(holds_more({"b.tif", "tiff", "rgba", {}, {}}));
    EXPECT_TRUE(holds_more({"b.png", "file", "a", {}, {}}));
    Display floats_display{"b.exr", "openexr", "rgba", {}, {}};
    floats_display.parameters.set(text("exrpixeltype", "float"));
    EXPECT_TRUE(holds_more(floats_display));
    floats_display.parameters.set(text("exrpixeltype", "half"));
    EXPECT_FALSE(holds_more(floats_display));
}

}  // namespace
}  // namespace trapeze
