#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <vector>

#include "core/files/access.h"
#include "pipeline/cli/commands/commands.h"
#include "pipeline/cli/support/exit_codes.h"
#include "pipeline/cli/support/read_settings.h"
#include "shade/rsl/front_end.h"
#include "shade/shaders/standard_shaders.h"
#include "shade/vm/compile_shader.h"

namespace trapeze {
namespace {

/// Bytes of a header that is included, at most.
constexpr size_t kLargestHeader = 16 << 20;

std::string kind_name(rsl::ShaderKind kind) {
    static constexpr const char* kNames[] = {"surface", "displacement", "light", "volume", "imager"};
    return kNames[static_cast<size_t>(kind)];
}

/// One line for each parameter, in columns.
void print_parameters(const rsl::Shader& shader) {
    struct Row {
        std::string storage, type, name, initial;
    };
    std::vector<Row> rows;
    Row widest;
    const auto widen = [](std::string& widest_text, const std::string& text) {
        if (text.size() > widest_text.size()) widest_text = text;
    };
    for (const auto& parameter : shader.parameters) {
        Row row;
        row.storage = parameter->output ? "output " : "";
        row.storage += parameter->storage == rsl::Storage::Varying ? "varying" : "uniform";
        row.type = rsl::print(parameter->type);
        row.name = parameter->name;
        if (parameter->initial) row.initial = rsl::print(*parameter->initial);
        widen(widest.storage, row.storage);
        widen(widest.type, row.type);
        widen(widest.name, row.name);
        rows.push_back(std::move(row));
    }
    for (const Row& row : rows) {
        std::string line = fmt::format("    {:<{}}  {:<{}}  {:<{}}", row.storage, widest.storage.size(),
                                       row.type, widest.type.size(), row.name, widest.name.size());
        if (!row.initial.empty()) line += "  = " + row.initial;
        line.erase(line.find_last_not_of(' ') + 1);
        fmt::print("{}\n", line);
    }
}

/// The code as the machine would run it with no parameter given for each vertex.
void print_code(const rsl::Shader& shader, Diagnostics& diagnostics) {
    if (const auto program = vm::compile_program(shader, diagnostics))
        fmt::print("{}", rsl::listing(vm::lay_out(*program)->program()));
}

std::string read_source(const std::string& file) {
    if (file == "-") return std::string(std::istreambuf_iterator<char>(std::cin), {});
    std::ifstream stream(file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(stream), {});
}

}  // namespace

int shader_command(const Arguments& arguments, Terminal& terminal, Diagnostics& diagnostics) {
    const ShaderArguments& a = arguments.shader;
    if (!inputs_exist({a.file}, diagnostics)) return kExitNoInput;
    const std::string text = read_source(a.file);
    for (const std::string& folder : a.include_folders)
        if (!std::filesystem::is_directory(folder))
            diagnostics.warning({}, "--include: there is no folder \"" + folder + "\"");
    rsl::CompileOptions options;
    options.include_folders = a.include_folders;
    options.carried_file = standard_header;
    Access access = arguments.safe ? Access::confined() : Access();
    access.allow_reading_below(std::filesystem::path(a.file).parent_path().string());
    for (const std::string& folder : a.include_folders) access.allow_reading_below(folder);
    if (access.is_confined())
        options.read_file = [&](const std::string& path) -> std::optional<std::string> {
            std::string bytes;
            if (!access.read(path, kLargestHeader, &bytes)) return {};
            return bytes;
        };
    for (const std::string& define : a.defines) {
        const size_t equals = define.find('=');
        options.defines.emplace_back(define.substr(0, equals),
                                     equals == std::string::npos ? "1" : define.substr(equals + 1));
    }
    const auto unit = rsl::compile_front({a.file == "-" ? "<stdin>" : a.file, text}, options, diagnostics);
    if (unit) {
        for (const auto& shader : unit->shaders) {
            fmt::print("{} {}\n", kind_name(shader->kind), shader->name);
            if (a.parameters) print_parameters(*shader);
            if (a.code) print_code(*shader, diagnostics);
        }
        if (unit->shaders.empty()) diagnostics.warning({}, "there is no shader in \"" + a.file + "\"");
    }
    terminal.say(fmt::format("{} errors, {} warnings", diagnostics.count(Severity::Error),
                             diagnostics.count(Severity::Warning)));
    const bool bad = !unit || (arguments.strict && diagnostics.count(Severity::Warning) > 0);
    return bad ? kExitErrors : kExitOk;
}

}  // namespace trapeze
