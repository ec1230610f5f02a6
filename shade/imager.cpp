#include "shade/imager.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "shade/grid_messages.h"
#include "shade/maps/map_service.h"
#include "shade/materials/bound_shader.h"
#include "shade/materials/scene_spaces.h"
#include "shade/materials/shader_library.h"

namespace trapeze {
namespace {

constexpr int kBatch = 256;  ///< pixels that run together: about as many as a grid has vertices

/// The register of a variable; null when the program does not name it.
const vm::Operand* variable(const vm::Registers& registers, std::string_view name) {
    const rsl::RegisterId* id = registers.program().find_global(name);
    return id ? &registers.operand(*id) : nullptr;
}

/// A stand-in for an imager that is missing. Imagers of exporters mostly put a colour behind the picture:
/// where the missing one was given such a colour, the standard background does so.
std::optional<ShaderInstance> stand_in(const ShaderInstance& missing) {
    for (const Parameter& parameter : missing.parameters.values)
        for (const char* name : {"bgcolor", "background", "backgroundcolor", "color"})
            if (parameter.name == name && parameter.floats.size() == 3) {
                ShaderInstance made;
                made.name = "background";
                made.location = missing.location;
                made.camera_from_shader = missing.camera_from_shader;
                made.parameters.set(
                    {"bgcolor", {StorageClass::Uniform, ValueType::Color, 1}, parameter.floats, {}});
                return made;
            }
    return {};
}

/// The lanes of a row's pixels. Each pixel is a grid of its own: it has no neighbours, and its random numbers
/// follow from its place in the picture.
vm::Batch batch_of(int x0, int y, size_t pixels) {
    vm::Batch batch;
    batch.vertices = pixels;
    batch.lanes = padded_size(pixels);
    for (size_t i = 0; i < pixels; ++i) {
        const uint64_t row = static_cast<uint32_t>(y), column = static_cast<uint32_t>(x0) + i;
        batch.spans.push_back({i, GridShape{0, 0}, false, row << 32 | column, -1, V2f(0)});
    }
    return batch;
}

/// Sets a varying variable's component from each pixel; lanes past the end repeat the last.
template <class ValueOf>
void load(const vm::Operand* out, int component, size_t pixels, size_t lanes, const ValueOf& value_of) {
    if (!out) return;
    float* to = out->data + static_cast<size_t>(component) * out->stride;
    for (size_t i = 0; i < lanes; ++i) to[i] = value_of(std::min(i, pixels - 1));
}

/// Pixels must stay numbers, whatever a shader does.
float finite(float value) {
    return std::isfinite(value) ? value : 0.0f;
}

}  // namespace

struct Imager::Impl {
    explicit Impl(const RenderContext& render) : context(render) {}

    void load_pixels(vm::Registers& registers, int x0, int y, size_t pixels, const float* rgba) const;

    const RenderContext& context;
    // All null when there is no imager.
    std::unique_ptr<Textures> textures;  ///< thread-safe
    std::unique_ptr<SceneSpaces> spaces;
    std::unique_ptr<BoundShader> shader;
    bool is_own_glow = false;
};

Imager::Imager(const RenderContext& context, const Access& access) : impl_(std::make_unique<Impl>(context)) {
    const Scene& scene = *context.scene;
    const ShaderInstance *asked = scene.options.imager.get(), *const glow = scene.options.glow.get();
    if (!asked && !glow) return;
    ShaderLibrary library(scene.options, context.diagnostics, access);
    std::shared_ptr<const vm::Executable> executable;
    if (glow) {
        executable = library.find(glow->name, rsl::ShaderKind::Imager, {}, glow->location);
        impl_->is_own_glow = executable || library.has_said_why_not(glow->name);
        if (impl_->is_own_glow) asked = glow;
    }
    if (!asked) return;
    ShaderInstance instance = *asked;
    if (!executable) executable = library.find(instance.name, rsl::ShaderKind::Imager, {}, instance.location);
    if (!executable) {
        auto instead = stand_in(instance);
        if (context.diagnostics && !library.has_said_why_not(instance.name))
            context.diagnostics->error(
                instance.location,
                fmt::format("Imager: there is no shader \"{}\"; {}", instance.name,
                            instead ? "background is used" : "the picture stays as it is"),
                "missing-shader Imager " + instance.name);
        if (!instead) return;
        instance = std::move(*instead);
        executable = library.find(instance.name, rsl::ShaderKind::Imager, {}, instance.location);
        if (!executable) return;
    }
    impl_->textures = std::make_unique<Textures>(scene.options, context.diagnostics, access, context.colors);
    impl_->spaces = std::make_unique<SceneSpaces>(scene, context.camera, &instance, nullptr);
    impl_->shader =
        std::make_unique<BoundShader>(std::move(executable), instance, *impl_->spaces, context.diagnostics);
}

Imager::~Imager() = default;

bool Imager::is_there() const {
    return impl_->shader != nullptr;
}

bool Imager::is_own_glow() const {
    return impl_->is_own_glow;
}

const BoundShader* Imager::shader() const {
    return impl_->shader.get();
}

void Imager::Impl::load_pixels(vm::Registers& registers, int x0, int y, size_t pixels,
                               const float* rgba) const {
    const size_t lanes = registers.lanes();
    load(variable(registers, "P"), 0, pixels, lanes,
         [&](size_t i) { return static_cast<float>(x0) + static_cast<float>(i) + 0.5f; });
    load(variable(registers, "P"), 1, pixels, lanes, [&](size_t) { return static_cast<float>(y) + 0.5f; });
    load(variable(registers, "P"), 2, pixels, lanes, [](size_t) { return 0.0f; });
    for (const char* name : {"s", "u"})
        load(variable(registers, name), 0, pixels, lanes, [&](size_t i) {
            return (static_cast<float>(x0) + static_cast<float>(i) + 0.5f) /
                   static_cast<float>(context.camera.width);
        });
    for (const char* name : {"t", "v"})
        load(variable(registers, name), 0, pixels, lanes, [&](size_t) {
            return (static_cast<float>(y) + 0.5f) / static_cast<float>(context.camera.height);
        });
    for (int c = 0; c < 3; ++c) {
        load(variable(registers, "Ci"), c, pixels, lanes,
             [&](size_t i) { return rgba[4 * i + static_cast<size_t>(c)]; });
        load(variable(registers, "Oi"), c, pixels, lanes, [&](size_t i) { return rgba[4 * i + 3]; });
    }
    load(variable(registers, "alpha"), 0, pixels, lanes, [&](size_t i) { return rgba[4 * i + 3]; });
    const Options& options = context.scene->options;
    const float components = 3, open = options.shutter_close - options.shutter_open;
    for (const auto& [name, value] :
         {std::pair{"ncomps", components}, {"time", options.shutter_open}, {"dtime", open}})
        if (const rsl::RegisterId* id = registers.program().find_global(name))
            registers.set_uniform(*id, &value);
}

void Imager::run(int x0, int y, int count, float* rgba) const {
    if (!impl_->shader) return;
    const BoundShader& shader = *impl_->shader;
    vm::Machine machine;
    vm::Registers& registers = machine.registers(shader.executable());
    MapService maps(*impl_->textures, *impl_->context.scene);
    GridMessages messages(impl_->context);
    for (int done = 0; done < count; done += kBatch) {
        const auto pixels = static_cast<size_t>(std::min(kBatch, count - done));
        float* colors = rgba + 4 * static_cast<size_t>(done);
        const vm::Batch batch = batch_of(x0 + done, y, pixels);
        registers.start(batch.lanes);
        shader.set_parameters(registers, {});
        impl_->load_pixels(registers, x0 + done, y, pixels, colors);
        vm::Context surroundings;
        surroundings.batch = &batch;
        surroundings.spaces = impl_->spaces.get();
        surroundings.maps = &maps;
        surroundings.messages = &messages;
        surroundings.diagnostics = impl_->context.diagnostics;
        surroundings.near_clip = impl_->context.camera.near_clip;
        surroundings.far_clip = impl_->context.camera.far_clip;
        shader.set_run_defaults(machine, registers, surroundings, {}).get();
        machine.run(registers, surroundings).get();
        const vm::Operand *color = variable(registers, "Ci"), *alpha = variable(registers, "alpha");
        for (size_t i = 0; i < pixels; ++i) {
            for (size_t c = 0; c < 3 && color; ++c)
                colors[4 * i + c] = finite(color->data[c * color->stride + i]);
            if (alpha) colors[4 * i + 3] = finite(alpha->data[i]);
        }
    }
}

}  // namespace trapeze
