/// IfBegin, ElseIf, Else, IfEnd, and blocks that are skipped whole.
#include "pipeline/rib/reader/conditional_blocks.h"
#include "pipeline/rib/requests/request_table.h"

namespace trapeze::rib {
namespace {

/// The expression; parameters after it are PRMan's, and are read past.
std::string condition(ConditionalContext& r, ArgumentCursor& c) {
    std::string expression = c.string("the condition");
    r.parameters(c, Undeclared::Guess);
    return expression;
}

/// ElseIf "condition": counts where no branch before it was taken.
void else_if(ConditionalContext& r, ArgumentCursor& c) {
    const std::string expression = condition(r, c);
    r.conditions.else_if(&expression);
}

/// What else stands there means nothing here.
void skip_block(ConditionalContext& r, ArgumentCursor& c) {
    c.skip_rest();
    r.conditions.skip_block();
}

/// Carried out even where others are skipped (ConditionalBlocks::is_conditional): add a name there too.
constexpr RequestRow kConditionalRequests[] = {
    {"IfBegin", [](ConditionalContext& r, ArgumentCursor& c) { r.conditions.if_begin(condition(r, c)); }},
    {"ElseIf", else_if},
    {"Else", [](ConditionalContext& r, ArgumentCursor&) { r.conditions.else_if(nullptr); }},
    {"IfEnd", [](ConditionalContext& r, ArgumentCursor&) { r.conditions.if_end(); }},
    {"EditBegin", skip_block},
    {"EditEnd", skip_block},
    {"EditAttributeBegin", skip_block},
    {"EditAttributeEnd", skip_block},
    {"EditWorldBegin", skip_block},
    {"EditWorldEnd", skip_block},
};

}  // namespace

std::span<const RequestRow> conditional_requests() {
    return kConditionalRequests;
}

}  // namespace trapeze::rib
