/// The shaders of one render by name: found, compiled and kept.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/diagnostics.h"
#include "core/files/access.h"
#include "core/scene/scene.h"
#include "shade/rsl/front_end.h"
#include "shade/rsl/syntax/ast.h"
#include "shade/vm/executable.h"

namespace trapeze {

class ShaderLibrary {
  public:
    /// NAME.sl is looked for in the folders of Option "searchpath" "shader" (the scene's own among them),
    /// then among the standard shaders. diagnostics may be null; `access` must outlive this.
    ShaderLibrary(const Options& options, Diagnostics* diagnostics, const Access& access = kEverything);
    ~ShaderLibrary();

    /// A shader ready to run, in which the named parameters are varying besides those that it declares so.
    /// Null, and reported once, when there is no such shader, it has errors, or it is of another kind. Not
    /// thread-safe.
    std::shared_ptr<const vm::Executable> find(std::string_view name, rsl::ShaderKind kind,
                                               const std::set<std::string>& varying, SourceLocation asked_at);

    /// Whether an error has said that this shader cannot be used, and why. If not, and find() was null, there
    /// is none of the name.
    bool has_said_why_not(std::string_view name) const { return reported_.contains(name); }

    /// How many shaders have turned out to have loops without an end.
    size_t endless_count() const;

  private:
    struct Compiled;
    std::optional<std::string> file_text(const std::string& path) const;
    rsl::Source source_named(const std::string& name) const;
    Compiled& compiled(const std::string& name, rsl::ShaderKind kind, SourceLocation asked_at);

    std::vector<std::string> folders_;
    const Access& access_;
    Diagnostics* diagnostics_;
    Diagnostics silent_;
    /// Shaders by the name and kind that were asked for; also those that are not there or have errors.
    std::map<std::pair<std::string, rsl::ShaderKind>, std::unique_ptr<Compiled>> shaders_;
    std::set<std::string, std::less<>> reported_;  ///< names for which an error has been reported
};

/// What a kind of shader is called in messages and requests: "surface", "light"...
std::string_view kind_name(rsl::ShaderKind kind);

}  // namespace trapeze
