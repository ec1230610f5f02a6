/// Parts of a stream that are read but not carried out: branches of IfBegin, ElseIf, Else and IfEnd (no part
/// of RISpec 3.2; PRMan's and Pixie's), and blocks that are skipped whole.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/files/access.h"
#include "pipeline/rib/reader/request_report.h"
#include "pipeline/rib/state/graphics_state_stack.h"
#include "pipeline/rib/syntax/arguments.h"
#include "pipeline/rib/syntax/conditions.h"

namespace trapeze::rib {

/// Owns the conditions that are open. They have nothing to do with the blocks of the graphics state, and nest
/// across them as they like; but each stream (file, archive, answer) closes its own.
class ConditionalBlocks {
  public:
    ConditionalBlocks(RequestReport& report, const GraphicsStateStack& state, const Access& access)
        : report_(report), state_(state), access_(access) {}

    /// Requests that are looked at where others are skipped.
    static bool is_conditional(std::string_view request);
    bool is_skipping() const { return !blocks_.empty() && !blocks_.back().is_active; }

    // --- requests; they throw a RequestError where no such block is open in this stream ---
    void if_begin(const std::string& expression);
    /// Else: null.
    void else_if(const std::string* expression);
    void if_end();
    /// Begins or ends a block that is skipped whole (EditBegin and the like); the name of the current request
    /// says which.
    void skip_block();

    /// Another stream is read for a while; returns what end_stream() wants.
    size_t begin_stream();
    /// Closes what the stream has left open: an error where it was read as a whole.
    void end_stream(size_t outer, bool is_whole);

    /// PRMan's Option "ribparse" "string varsubst" (older: "rib"): from then on texts in requests may name
    /// options and attributes, as $user:pass does where the option is "$".
    void substitute(RequestText& request) const;

  private:
    /// One block that is open. Skipped blocks (EditBegin) are conditions too, whose only branch is never
    /// active.
    struct OpenCondition {
        std::string_view name;  ///< of the request that opened it
        SourceLocation at;
        bool outer_skips;  ///< nothing in it is carried out, whatever its conditions say
        bool is_active;    ///< what comes now is carried out
        bool was_taken;    ///< a branch has been
        bool had_else;
    };
    bool holds(const std::string& expression);
    void push(std::string_view name, bool is_active);
    OpenCondition& innermost(std::string_view name);
    /// What a name in a condition, or behind the marker of a substitution, stands for; undefined: nobody set
    /// it.
    ConditionValue value_of_variable(const std::string& name) const;

    RequestReport& report_;
    const GraphicsStateStack& state_;
    const Access& access_;
    std::vector<OpenCondition> blocks_;
    size_t first_ = 0;  ///< of the stream that is read; those before it belong to outer streams
};

}  // namespace trapeze::rib
