/// Shaders from strangers, compiled and run over a small grid, once as generated and once optimised: both
/// must give the same bits. With clang: -fsanitize=fuzzer,address,undefined and shade/rsl/test_shaders as
/// corpus. With any compiler: linked with replay_main.cpp it runs the seeds and mutations of them.
///
/// Two things are not compared, since there the optimiser may lawfully give other bits: the payloads of NaNs,
/// and shaders that look at neighbouring vertices from where only some vertices are (Du() behind an if): what
/// those that are not there hold is undefined. Runs that were stopped because their loops took too long have
/// stopped elsewhere.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>

#include "shade/code/blocks.h"
#include "shade/code/slice_code.h"
#include "shade/operations/op_table.h"
#include "shade/vm/compile_shader.h"
#include "shade/vm/machine.h"

namespace {

using namespace trapeze;
using namespace trapeze::vm;

constexpr size_t kMostBytes = size_t{1} << 16;
constexpr size_t kMostInstructions = 20'000;
constexpr uint32_t kMostPlanes = 20'000;
constexpr LoopLimits kLimits{40, 100'000};
constexpr GridShape kShape{3, 2};  // 12 vertices: fewer than lanes, and no power of two

float number_of(std::string_view name, size_t lane) {
    uint32_t hash = 2166136261u;
    for (const char c : name) hash = (hash ^ static_cast<uint8_t>(c)) * 16777619u;
    hash = (hash ^ static_cast<uint32_t>(lane)) * 2654435761u;
    return static_cast<float>(static_cast<int32_t>(hash >> 8) - (1 << 23)) / static_cast<float>(1 << 22);
}

class AnySpaces : public Spaces {
  public:
    std::optional<M44f> matrix(std::string_view from, std::string_view to) const override {
        if (from.size() + to.size() > 20) return {};
        M44f m;
        m[0][0] = 2, m[1][0] = 0.5f,
        m[3][1] = static_cast<float>(from.size()) - static_cast<float>(to.size());
        return m;
    }
};

class ThreeLights : public Lights {
  public:
    ThreeLights() {
        constexpr size_t lanes = kLanes;
        set_planes();
        for (size_t i = 0; i < lanes; ++i) {
            const uint32_t bits = i % 3 ? ~0u : 0u;
            std::memcpy(&planes_[9 * lanes + i], &bits, sizeof bits);
        }
        arriving_.L = planes_.data();
        arriving_.direction = planes_.data() + 3 * lanes;
        arriving_.Cl = planes_.data() + 6 * lanes;
        arriving_.lit = planes_.data() + 9 * lanes;
    }
    size_t count() const override { return 3; }
    /// What is sent is seen in the colour.
    Task<const Arriving*> arriving(size_t light, const LightRequest& request) override {
        arriving_.ambient = light == 1;
        light_ = light;
        set_planes();
        for (const SentValue& sent : request.sent)
            for (size_t i = 0; i < kLanes; ++i)
                if (request.lanes[i])
                    planes_[6 * kLanes + i] = sent.texts.empty()
                                                  ? Run::at(sent.value, 0, i)
                                                  : static_cast<float>(sent.texts.back().size());
        co_return &arriving_;
    }
    bool in_category(const Arriving&, std::string_view wanted) override { return wanted.size() != light_; }

  private:
    void set_planes() {
        for (size_t i = 0; i < 9 * kLanes; ++i) planes_[i] = number_of("light", i);
    }

    size_t light_ = 0;
    alignas(64) std::array<float, 10 * kLanes> planes_{};
    Arriving arriving_;
};

class AnyMessages : public Messages {
  public:
    bool find(rsl::Op, std::string_view name, rsl::Type type, const Operand& out,
              std::span<std::string> texts, const Registers*) override {
        if (name.size() % 2) return false;
        for (std::string& text : texts) text = name;
        const int planes = rsl::width_of(type.base) * std::max(type.length, 1);
        for (size_t i = 0; i < static_cast<size_t>(planes) * kLanes; ++i)
            out.data[i] = out.lane_mask ? number_of(name, i) : number_of(name, i / kLanes);
        return true;
    }
    std::string shader_name(std::string_view kind) override { return "shader " + std::string(kind); }
};

/// A program ready to run, and what a run left.
class Side {
  public:
    explicit Side(rsl::Program program) : executable_(lay_out(std::move(program), {}, kLimits)) {}

    bool fits() const { return executable_->varying_planes() < kMostPlanes; }
    const rsl::Program& program() const { return executable_->program(); }
    Registers& registers() { return machine_.registers(executable_); }

    /// False when loops took too long.
    bool run() {
        Diagnostics diagnostics([](const Diagnostic&) {});
        registers().start(kLanes);
        Context context;
        const AnySpaces spaces;
        context.spaces = &spaces;
        context.diagnostics = &diagnostics;
        for (size_t i = 0; i < program().parameters.size(); ++i) {
            // As if defaults could name variables that are not there yet.
            set_variables();
            machine_.run_initial(registers(), i, context).get();
        }
        set_variables();
        Batch batch{static_cast<size_t>(kShape.vertex_count()), kLanes, {{0, kShape, false, 1}}};
        ThreeLights lights;
        AnyMessages messages;
        std::vector<float> L(3 * kLanes);
        std::vector<uint32_t> lit(kLanes);
        LightOutput output{L.data(), lit.data()};
        context.batch = &batch;
        context.lights = &lights;
        context.messages = &messages;
        if (program().kind == rsl::ShaderKind::Light) context.light_output = &output;
        machine_.run(registers(), context).get();
        return diagnostics.count(Severity::Error) == 0;
    }

  private:
    void set_variables() {
        for (const rsl::RegisterId id : program().globals) {
            const rsl::Register& r = program().reg(id);
            const Operand& operand = registers().operand(id);
            for (int k = 0; k < rsl::width_of(r.type.base); ++k)
                for (size_t i = 0; i < kLanes; ++i)
                    operand.data[static_cast<size_t>(k) * operand.stride + i] =
                        number_of(r.name, operand.lane_mask ? i + static_cast<size_t>(k) * 100 : 0);
        }
    }

    std::shared_ptr<const Executable> executable_;
    Machine machine_;
};

bool same_lane(float a, float b) {
    return std::memcmp(&a, &b, sizeof a) == 0 || (std::isnan(a) && std::isnan(b));
}

bool same_register(Side& a, Side& b, rsl::RegisterId id_a, rsl::RegisterId id_b) {
    const rsl::Type type = a.program().reg(id_a).type;
    const size_t elements = static_cast<size_t>(std::max(type.length, 1));
    if (type.base == rsl::Base::String) {
        for (size_t e = 0; e < elements; ++e)
            if (a.registers().text(id_a, e) != b.registers().text(id_b, e)) return false;
        return true;
    }
    const Operand &left = a.registers().operand(id_a), &right = b.registers().operand(id_b);
    const auto at = [](const Operand& operand, size_t e, size_t k, size_t lane) {
        return operand.data[e * operand.element_stride + k * operand.stride + (lane & operand.lane_mask)];
    };
    for (size_t e = 0; e < elements; ++e)
        for (size_t k = 0; k < static_cast<size_t>(rsl::width_of(type.base)); ++k)
            for (size_t lane = 0; lane < static_cast<size_t>(kShape.vertex_count()); ++lane)
                if (!same_lane(at(left, e, k, lane), at(right, e, k, lane))) return false;
    return true;
}

/// An operation that looks at neighbours where lanes may have parted.
bool looks_aside(const rsl::Program& program) {
    const rsl::Blocks blocks(program.code);
    for (size_t i = 0; i < program.code.size(); ++i) {
        if (!rsl::reads_neighbours(program.code[i].op)) continue;
        for (size_t b = blocks.around[i]; b != rsl::Blocks::kNone; b = blocks.around[b])
            if (program.code[b].varying) return true;
    }
    return false;
}

void run_both(const rsl::Shader& shader, Diagnostics& diagnostics) {
    const std::unique_ptr<rsl::Program> program =
        compile_program(shader, diagnostics, rsl::OptimiseOptions::none());
    if (!program || program->code.size() > kMostInstructions) return;
    const std::unique_ptr<rsl::Program> optimised = compile_program(shader, diagnostics);
    Side plain(*program), quick(*optimised), opacity(rsl::slice(*optimised, "Oi"));
    if (!plain.fits() || !quick.fits()) return;
    const bool plain_ended = plain.run(), quick_ended = quick.run();
    if (!plain_ended || !quick_ended || looks_aside(plain.program())) return;
    const rsl::RegisterId *const whole_Oi = plain.program().find_global("Oi"), *const part_Oi =
                                                                                   opacity.program()
                                                                                       .find_global("Oi");
    if (whole_Oi && part_Oi && (!opacity.run() || !same_register(plain, opacity, *whole_Oi, *part_Oi)))
        std::abort();
    for (size_t i = 0; i < plain.program().parameters.size(); ++i)
        if (!same_register(plain, quick, plain.program().parameters[i].id, quick.program().parameters[i].id))
            std::abort();
    for (const rsl::RegisterId id : plain.program().globals)
        if (const rsl::RegisterId* other = quick.program().find_global(plain.program().reg(id).name))
            if (!same_register(plain, quick, id, *other)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    const rsl::Source source{"fuzz.sl", {reinterpret_cast<const char*>(data), std::min(size, kMostBytes)}};
    rsl::CompileOptions options;
    options.include_folders = {"include"};
    options.read_file = [](const std::string&) -> std::optional<std::string> { return {}; };
    Diagnostics diagnostics([](const Diagnostic&) {});
    const auto unit = rsl::compile_front(source, options, diagnostics);
    if (!unit) return 0;
    constexpr size_t kMostShaders = 4;
    for (size_t i = 0; i < std::min(unit->shaders.size(), kMostShaders); ++i)
        run_both(*unit->shaders[i], diagnostics);
    return 0;
}
