/// What lies between RiBegin and RiEnd: the RIB so far, and what later calls need to know of earlier ones.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "pipeline/ri/errors.h"
#include "pipeline/ri/rib_output.h"
#include "pipeline/ri/spaces.h"
#include "pipeline/rib/state/declarations.h"

namespace trapeze::ri {

enum class Block { Frame, World, Attribute, Transform, Solid, Object, Motion };

/// What the lengths of arrays depend on: it comes back at the end of a block.
struct CountingState {
    int samples_per_color = 3;   ///< RiColorSamples
    int u_step = 3, v_step = 3;  ///< RiBasis
};

class Context {
  public:
    Context(const std::string& name, RibFormat format) : output(name, format), name_(name) {}

    const std::string& name() const { return name_; }
    rib::RibWriter& writer() { return output.writer(); }

    /// Begins a block's request, or ends it: RIE_NESTING unless it is the innermost.
    void open(Block block);
    void close(Block block);
    bool is_open(Block block) const;
    size_t open_blocks() const { return blocks_.size(); }
    /// Throws RIE_NOTOPTIONS within a world.
    void expect_options() const;
    /// Of the calls within a motion block only the first counts for what is followed here.
    bool counts();

    /// What is left out of a call that is otherwise written, and what is doubtful.
    void complain(RtInt code, RtInt severity, std::string text);
    std::vector<Message> take_messages();

    RibOutput output;
    rib::Declarations declarations;
    CountingState counting;
    Spaces spaces;
    std::vector<std::string> archive_folders;  ///< Option "searchpath" "archive"
    uintptr_t lights = 0, objects = 0;         ///< so many handles have been given
    bool may_run_programs = false;             ///< the program itself asked for RiProcRunProgram

  private:
    struct OpenBlock {
        Block kind;
        CountingState counting;
        M44d current;
        Options camera;
        int calls = 0;  ///< within Motion
    };

    std::string name_;
    std::vector<OpenBlock> blocks_;
    std::vector<Message> messages_;
};

/// The context that calls go to, or null. Contexts are the process's (RISpec 3).
Context* current_context();
/// Makes a new one current.
void begin_context(const std::string& name, RibFormat format);
/// Takes the current one away; there is none then.
std::unique_ptr<Context> take_current_context();
/// False when there is no such context.
bool select_context(const void* handle);

/// Of files that RiBegin will begin: Option "rib" before it.
RibFormat& next_format();

}  // namespace trapeze::ri
