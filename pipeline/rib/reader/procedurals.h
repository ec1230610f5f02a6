/// Procedural primitives (RISpec 5.8): their geometry is read at once, within a block of their own.
#pragma once

#include <string>
#include <vector>

#include "core/files/access.h"
#include "pipeline/rib/programs/programs.h"
#include "pipeline/rib/reader/block_ends.h"
#include "pipeline/rib/reader/request_stream.h"
#include "pipeline/rib/reader/scene_builder.h"

namespace trapeze::rib {

/// Owns the programs that have been started; they answer until the reader ends. A bound is a box of the
/// current space, xmin xmax ymin ymax zmin zmax, or empty: not known.
class Procedurals {
  public:
    Procedurals(const ReadOptions& options, const Access& access, RequestReport& report,
                const GraphicsStateStack& state, SceneBuilder& scene, BlockEnds& blocks, OpenFiles& files,
                const FileSearch& search, RequestStream& stream)
        : read_options_(options),
          access_(access),
          report_(report),
          state_(state),
          scene_(scene),
          blocks_(blocks),
          files_(files),
          search_(search),
          stream_(stream) {}

    /// Geometry that stands in another file.
    void delayed_archive(const std::string& name);
    /// Geometry that a program writes. `command`: words apart by spaces, run without a shell; `data`: what
    /// the program is asked, after the size of the bound on the picture.
    void run_program(const std::string& command, const std::string& data, const std::vector<float>& bound);
    /// Geometry that a library makes through the C interface, loaded by ReadOptions::procedural_host.
    void load_procedural(const std::string& library, const std::string& data,
                         const std::vector<float>& bound);

  private:
    /// What answers: a program of the scene's, or the host process with a library as its last word.
    struct Source {
        std::string kind, shown;         ///< what messages call it: "program", and the command
        std::vector<std::string> words;  ///< of the command
        std::string title() const;
    };
    bool takes_procedural();
    bool may_run(const Source& source);
    void read_answer(const Source& source, const std::string& data, const std::vector<float>& bound);
    ProgramAnswer ask(const Source& source, const std::string& request);

    const ReadOptions& read_options_;
    const Access& access_;
    RequestReport& report_;
    const GraphicsStateStack& state_;
    SceneBuilder& scene_;
    BlockEnds& blocks_;
    OpenFiles& files_;
    const FileSearch& search_;
    RequestStream& stream_;
    Programs programs_;
};

}  // namespace trapeze::rib
