// Each overload of each built-in function, where its arguments are the same at all vertices, constants,
// different ones, and where only some vertices call it; with and without the optimiser.
#include <array>
#include <set>

#include "shade/rsl/analysis/builtins.h"
#include "shade/vm/builtin_cases_harness.h"
#include "shade/vm/run_shader_harness.h"

namespace trapeze::vm {
namespace {

using testing::asking_cases;
using testing::BuiltinCase;
using testing::geometry_cases;
using testing::number_cases;
using testing::pattern_cases;
using testing::ShaderRun;

/// How X and Y come to a case.
enum class Way { Varying, Masked, Uniform, Constant };
constexpr float kX = 0.6f, kY = 0.3f;

std::string source_of(const BuiltinCase& c, Way way) {
    std::string text = "#define K(v) (comp(v, 0) + 10 * comp(v, 1) + 100 * comp(v, 2))\n";
    const bool varies = way == Way::Varying || way == Way::Masked;
    text += varies                ? "#define X s\n#define Y t\n"
            : way == Way::Uniform ? "#define X given_x\n#define Y given_y\n"
                                  : "#define X 0.6\n#define Y 0.3\n";
    text += "surface test(uniform float given_x = 0.6, given_y = 0.3; output varying float r = 0;) { ";
    text += way == Way::Masked ? "r = -7; if (s > 0.5) { " + c.code + " } }" : c.code + " }";
    return text;
}

/// An ambient light of (0.1, 0.2, 0.3), and one of (1, 2, 4) from (0, 0, -1).
class TwoLights : public Lights {
  public:
    TwoLights() {
        const float values[] = {0, 0, -2, 0, 0, -1};
        for (size_t k = 0; k < 6; ++k) std::fill_n(planes_.begin() + k * kLanes, kLanes, values[k]);
        arriving_.L = planes_.data(), arriving_.direction = planes_.data() + 3 * kLanes;
        arriving_.Cl = planes_.data() + 6 * kLanes, arriving_.lit = planes_.data() + 9 * kLanes;
        const uint32_t all = ~0u;
        for (size_t i = 0; i < kLanes; ++i) std::memcpy(&planes_[9 * kLanes + i], &all, sizeof all);
    }
    size_t count() const override { return 2; }
    Task<const Arriving*> arriving(size_t light, const LightRequest&) override {
        arriving_.ambient = light == 0;
        const float colors[2][3] = {{0.1f, 0.2f, 0.3f}, {1, 2, 4}};
        for (size_t k = 0; k < 3; ++k) std::fill_n(&planes_[(6 + k) * kLanes], kLanes, colors[light][k]);
        co_return &arriving_;
    }
    bool in_category(const Arriving&, std::string_view) override { return true; }

  private:
    alignas(64) std::array<float, 10 * kLanes> planes_{};  // the grid has 12 vertices
    Arriving arriving_;
};

class KnownMessages : public Messages {
  public:
    bool find(rsl::Op, std::string_view name, rsl::Type, const Operand& out, std::span<std::string>,
              const Registers*) override {
        if (name == "known") std::fill_n(out.data, kLanes, 0.25f);
        return name == "known";
    }
    std::string shader_name(std::string_view kind) override { return "shader " + std::string(kind); }
};

class CountingMaps : public Maps {
  public:
    std::unique_ptr<GatherTurns> gather_sky(std::string_view, Run&, const Step&,
                                            std::span<const Operand>) override {
        return {};
    }
    void look_up(Run& run, const Step& step, std::span<const Operand> operands) override {
        const size_t lanes = operands[0].lane_mask ? run.lanes() : kLanes;
        if (step.op == rsl::Op::TextureInfo) {
            std::fill_n(operands[0].data, lanes, 1.0f);
            std::fill_n(operands[1].data, operands[1].lane_mask ? run.lanes() : kLanes, 0.25f);
            return;
        }
        for (int k = 0; k < (operands[0].stride ? 3 : 1); ++k)
            for (size_t i = 0; i < lanes; ++i)
                operands[0].data[static_cast<size_t>(k) * operands[0].stride + i] =
                    100 * Run::at(operands[2], 0, i) + 10 * static_cast<float>(step.immediate) +
                    Run::at(operands[3], 0, i) + static_cast<float>(k);
    }
    void sky(std::string_view, SourceLocation, std::span<const V3f>, std::span<const float>,
             std::span<V3f>) override {}
};

void check(const BuiltinCase& c, Way way, bool optimised) {
    ShaderRun run(source_of(c, way), optimised);
    M44f far;
    far.setTranslation(V3f(5, 0, 10));
    far[0][0] = far[1][1] = far[2][2] = 2;
    run.scene().scene.camera_from_named["far"] = far;
    TwoLights lights;
    ASSERT_EQ(padded_size(run.vertices()), kLanes);
    KnownMessages messages;
    CountingMaps maps;
    Context context;
    context.lights = &lights, context.messages = &messages, context.maps = &maps;
    context.near_clip = 0.5f, context.far_clip = 4.5f;
    run.run(context);
    const bool varies = way == Way::Varying || way == Way::Masked;
    for (size_t i = 0; i < run.vertices(); ++i) {
        const double s = run.grid().s[i], t = run.grid().t[i];
        double expected = varies ? c.expected(s, t) : c.flat ? c.flat(kX, kY) : c.expected(kX, kY);
        if (way == Way::Masked && s <= 0.5) expected = -7;
        EXPECT_NEAR(run.at("r", i), expected, c.tolerance)
            << c.code << (optimised ? " optimised," : "") << " way " << static_cast<int>(way) << " at vertex "
            << i;
    }
}

std::vector<BuiltinCase> all_cases() {
    std::vector<BuiltinCase> all;
    for (const auto& cases : {number_cases(), pattern_cases(), geometry_cases(), asking_cases()})
        all.insert(all.end(), cases.begin(), cases.end());
    return all;
}

void collect(const rsl::Expression& e, std::set<const rsl::Builtin*>& called) {
    if (e.builtin) called.insert(e.builtin);
    for (const auto& child : e.children) collect(*child, called);
}

void collect(const rsl::Statement& s, std::set<const rsl::Builtin*>& called) {
    for (const auto& e : s.expressions)
        if (e) collect(*e, called);
    for (const auto& variable : s.variables)
        if (variable->initial) collect(*variable->initial, called);
    for (const auto& child : s.children) collect(*child, called);
}

TEST(BuiltinOverloads, GiveWhatTheyShould) {
    for (const BuiltinCase& c : all_cases())
        for (const Way way : {Way::Varying, Way::Masked, Way::Uniform, Way::Constant})
            for (const bool optimised : {false, true}) check(c, way, optimised);
}

TEST(BuiltinOverloads, AllHaveACase) {
    std::set<const rsl::Builtin*> called;
    for (const BuiltinCase& c : all_cases()) {
        Diagnostics diagnostics;
        const auto unit = rsl::compile_front({"test.sl", source_of(c, Way::Varying)}, {}, diagnostics);
        ASSERT_TRUE(unit) << c.code;
        collect(*unit->shaders.front()->body, called);
    }
    for (const rsl::Builtin& builtin : rsl::builtins())
        EXPECT_TRUE(called.contains(&builtin))
            << "no case for " << builtin.result << ' ' << builtin.name << '(' << builtin.parameters << ')';
}

}  // namespace
}  // namespace trapeze::vm
