#include "shade/materials/shader_library.h"

#include <fmt/format.h>

#include <filesystem>

#include "core/files/foreign_paths.h"
#include "shade/shaders/standard_shaders.h"
#include "shade/vm/compile_shader.h"

namespace trapeze {
namespace {

namespace fs = std::filesystem;

constexpr uint32_t kMostPlanes = 16384;      ///< varying floats that a shader may have: 20 MB a thread
constexpr size_t kLargestSource = 16 << 20;  ///< bytes; larger files are not read

}  // namespace

/// A shader's code before storage is inferred, and what was made of it for different varying parameters.
struct ShaderLibrary::Compiled {
    std::unique_ptr<rsl::Program> program;  ///< optimised; null: not found or wrong
    std::map<std::set<std::string>, std::shared_ptr<const vm::Executable>> executables;
};

ShaderLibrary::ShaderLibrary(const Options& options, Diagnostics* diagnostics, const Access& access)
    : access_(access), diagnostics_(diagnostics) {
    if (const auto paths = options.search_paths.find("shader"); paths != options.search_paths.end())
        folders_ = paths->second;
}

ShaderLibrary::~ShaderLibrary() = default;

std::optional<std::string> ShaderLibrary::file_text(const std::string& path) const {
    std::string text;
    if (!access_.read(path, kLargestSource, &text)) return {};
    return text;
}

/// The source of a shader: a file of the search path, else a standard shader. Nameless when there is none.
rsl::Source ShaderLibrary::source_named(const std::string& name) const {
    for (const std::string& folder : folders_) {
        const std::string path = (fs::path(folder) / (name + ".sl")).string();
        if (auto text = file_text(path)) return {path, std::move(*text)};
    }
    // What renderers call the surface that is drawn when none is named.
    const std::string standard = name == "default" ? "defaultsurface" : name;
    const std::string_view text = standard_shader(standard);
    if (text.empty()) return {};
    return {standard + ".sl", std::string(text)};
}

ShaderLibrary::Compiled& ShaderLibrary::compiled(const std::string& name, rsl::ShaderKind kind,
                                                 SourceLocation asked_at) {
    std::unique_ptr<Compiled>& entry = shaders_[{name, kind}];
    if (entry) return *entry;
    entry = std::make_unique<Compiled>();
    Diagnostics& diagnostics = diagnostics_ ? *diagnostics_ : silent_;
    rsl::Source source;
    std::string stem = name;
    // Some scenes name compiled shaders with their path, or the source itself.
    for (const std::string_view ending :
         {".sl", ".slo", ".slx", ".sdr", ".sle", ".sdl", ".slc", ".so", ".dll"})
        if (stem.ends_with(ending)) stem.resize(stem.size() - ending.size());
    // A name from another machine is also tried without its leading folders.
    std::vector<std::string> names = other_names(stem);
    names.insert(names.begin(), stem);
    for (size_t i = 0; i < names.size() && source.name.empty(); ++i) {
        source = source_named(names[i]);
        stem = names[i].substr(names[i].find_last_of('/') + 1);
    }
    if (source.name.empty()) {
        if (access_.is_closed(name)) {
            diagnostics.error(asked_at, fmt::format("shader \"{}\" {}", name, Access::kClosed));
            reported_.insert(name);
        }
        return *entry;
    }
    rsl::CompileOptions options;
    options.include_folders = folders_;
    options.carried_file = standard_header;
    if (access_.is_confined())
        options.read_file = [this](const std::string& path) { return file_text(path); };
    entry->program = vm::compile_program(source, options, diagnostics, stem, kind);
    if (!entry->program) {
        diagnostics.error(asked_at, fmt::format("shader \"{}\" has errors and is not used", name));
        reported_.insert(name);
    }
    return *entry;
}

std::shared_ptr<const vm::Executable> ShaderLibrary::find(std::string_view name, rsl::ShaderKind kind,
                                                          const std::set<std::string>& varying,
                                                          SourceLocation asked_at) {
    Compiled& shader = compiled(std::string(name), kind, asked_at);
    if (!shader.program) return nullptr;
    if (shader.program->kind != kind) {
        reported_.insert(std::string(name));
        if (diagnostics_)
            diagnostics_->error(asked_at,
                                fmt::format("\"{}\" is a {} shader, and a {} shader is wanted here", name,
                                            kind_name(shader.program->kind), kind_name(kind)),
                                fmt::format("shader-kind {} {}", name, kind_name(kind)));
        return nullptr;
    }
    std::set<std::string> relevant;
    for (const rsl::ProgramParameter& parameter : shader.program->parameters)
        if (varying.contains(parameter.name)) relevant.insert(parameter.name);
    std::shared_ptr<const vm::Executable>& executable = shader.executables[relevant];
    if (!executable) {
        executable = vm::lay_out(*shader.program, relevant);
        if (executable->varying_planes() > kMostPlanes) {
            if (diagnostics_)
                diagnostics_->error(
                    asked_at, fmt::format("shader \"{}\" needs {} values at each vertex, more than {}", name,
                                          executable->varying_planes(), kMostPlanes));
            shader.program.reset();
            return nullptr;
        }
    }
    return executable;
}

size_t ShaderLibrary::endless_count() const {
    size_t count = 0;
    for (const auto& [name, shader] : shaders_)
        for (const auto& [varying, executable] : shader->executables)
            count += executable && executable->is_endless();
    return count;
}

std::string_view kind_name(rsl::ShaderKind kind) {
    switch (kind) {
        case rsl::ShaderKind::Surface:
            return "surface";
        case rsl::ShaderKind::Displacement:
            return "displacement";
        case rsl::ShaderKind::Light:
            return "light";
        case rsl::ShaderKind::Volume:
            return "volume";
        case rsl::ShaderKind::Imager:
            return "imager";
    }
    return "?";
}

}  // namespace trapeze
