/// For tests: a shader's source, compiled and run over a small grid, and the values of its output parameters.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "shade/grid_footprints.h"
#include "shade/materials/grid_shader.h"
#include "shade/materials/scene_spaces.h"
#include "shade/shading_harness.h"
#include "shade/vm/compile_shader.h"

namespace trapeze::testing {

class ShaderRun {
  public:
    explicit ShaderRun(const std::string& source, bool optimised = true, int nu = 3, int nv = 2)
        : grid_(scene_.grid(nu, nv)) {
        const auto optimiser = optimised ? rsl::OptimiseOptions() : rsl::OptimiseOptions::none();
        executable_ = vm::compile_shader({"test.sl", source}, {}, scene_.diagnostics, optimiser);
        if (!executable_) ADD_FAILURE() << messages() << source;
    }

    ShadingGrid& grid() { return grid_; }
    ShadingScene& scene() { return scene_; }

    /// Runs it, with what is in `context` besides points.
    void run(vm::Context context = {}) {
        if (!executable_) return;
        const SceneSpaces spaces(scene_.scene, scene_.context.camera, &instance_,
                                 &scene_.scene.primitives[0]);
        const BoundShader bound(executable_, instance_, spaces, &scene_.diagnostics);
        const ShadingGrid* grids[] = {&grid_};
        batch_ = batch_of(grids);
        registers_ = &machine_.registers(executable_);
        registers_->start(batch_.lanes);
        bound.set_parameters(*registers_, grids);
        GridFootprints footprints(grids, scene_.context.camera);
        set_variables(*registers_, grids, scene_.context, footprints, false);
        context.footprints = &footprints;
        context.batch = &batch_;
        context.spaces = &spaces;
        context.diagnostics = &scene_.diagnostics;
        bound.set_run_defaults(machine_, *registers_, context, grids).get();
        machine_.run(*registers_, context).get();
    }

    size_t vertices() const { return grid_.vertex_count(); }
    /// An output parameter's component at a vertex.
    float at(const std::string& name, size_t vertex, int component = 0, size_t element = 0) const {
        const vm::Operand& operand = registers_->operand(id(name));
        return operand.data[element * operand.element_stride +
                            static_cast<size_t>(component) * operand.stride + (vertex & operand.lane_mask)];
    }
    const std::string& text(const std::string& name) const { return registers_->text(id(name)); }
    bool is_varying(const std::string& name) const { return registers_->reg(id(name)).varying; }
    const rsl::Program& program() const { return executable_->program(); }
    vm::Machine& machine() { return machine_; }
    vm::Registers& registers() { return *registers_; }
    std::string messages() const {
        std::string all;
        for (const Diagnostic& d : scene_.reported) all += to_string(d) + "\n";
        return all;
    }

  private:
    rsl::RegisterId id(const std::string& name) const {
        for (const rsl::ProgramParameter& parameter : program().parameters)
            if (parameter.name == name) return parameter.id;
        ADD_FAILURE() << "no parameter " << name;
        return 0;
    }

    ShadingScene scene_;
    ShaderInstance instance_;
    ShadingGrid grid_;
    std::shared_ptr<const vm::Executable> executable_;
    vm::Batch batch_;
    vm::Machine machine_;
    vm::Registers* registers_ = nullptr;
};

/// Runs `body` in a surface with output parameter `float r`, with and without the optimiser, and hands the
/// value at each vertex, with its s and t, to `expected`.
template <class Expected>
void expect_values(const std::string& body, const Expected& expected, float tolerance = 0,
                   const std::string& functions = {}) {
    for (const bool optimised : {false, true}) {
        ShaderRun run(functions + "surface test(output varying float r = 0;) {" + body + "}", optimised);
        run.run();
        if (!run.messages().empty()) ADD_FAILURE() << run.messages();
        for (size_t i = 0; i < run.vertices(); ++i)
            EXPECT_NEAR(run.at("r", i), expected(run.grid().s[i], run.grid().t[i]), tolerance)
                << (optimised ? "optimised " : "") << body << " at vertex " << i;
    }
}

}  // namespace trapeze::testing
