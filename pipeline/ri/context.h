/// What lies between RiBegin and RiEnd: the RIB so far, and what later calls need to know of earlier ones.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "pipeline/ri/errors.h"
#include "pipeline/ri/rib_output.h"
#include "pipeline/ri/spaces.h"
#include "pipeline/rib/state/block_kind.h"
#include "pipeline/rib/state/declarations.h"

namespace trapeze::ri {

using rib::BlockKind;

/// What the lengths of arrays depend on. It is saved where a block begins and comes back at its end.
struct CountingState {
    int samples_per_color = 3;   ///< RiColorSamples
    int u_step = 3, v_step = 3;  ///< RiBasis
};

class Context {
  public:
    Context(const std::string& name, RibFormat format) : output(name, format), name_(name) {}

    const std::string& name() const { return name_; }
    rib::RibWriter& writer() { return output.writer(); }

    /// open() begins a block; close() ends it, and throws RIE_NESTING unless it is the innermost open one.
    void open(BlockKind block);
    void close(BlockKind block);
    bool is_open(BlockKind block) const;
    size_t open_blocks() const { return blocks_.size(); }
    /// Throws RIE_NOTOPTIONS within a world.
    void expect_options() const;
    /// Whether a call counts for what is followed here (spaces, camera): within a motion block only the first
    /// does.
    bool counts();

    /// Keeps a message about what is left out of a call that is otherwise written, or about what is doubtful.
    void complain(RtInt code, RtInt severity, std::string text);
    /// Takes the messages away that complain() has kept.
    std::vector<Message> take_messages();

    RibOutput output;
    rib::Declarations declarations;
    CountingState counting;
    Spaces spaces;
    std::vector<std::string> archive_folders;  ///< Option "searchpath" "archive"
    uintptr_t lights = 0, objects = 0;         ///< how many handles have been given
    bool may_run_programs = false;             ///< set when the program itself asks for RiProcRunProgram

  private:
    /// What an open block brings back at its end.
    struct BlockOfCalls {
        BlockKind kind;
        CountingState counting;
        M44d current;
        Options camera;
        int calls = 0;  ///< made so far within a Motion block
    };

    std::string name_;
    std::vector<BlockOfCalls> blocks_;
    std::vector<Message> messages_;
};

/// The context that calls go to, or null. Contexts belong to the process, not to a thread (RISpec 3).
Context* current_context();
/// Makes a new context and makes it the current one.
void begin_context(const std::string& name, RibFormat format);
/// Takes the current context out of the list; there is no current one then.
std::unique_ptr<Context> take_current_context();
/// Makes another context current, by RiGetContext's handle. False when there is no such context.
bool select_context(const void* handle);

/// The format of files that RiBegin will begin, as Option "rib" before it sets it.
RibFormat& next_format();

}  // namespace trapeze::ri
