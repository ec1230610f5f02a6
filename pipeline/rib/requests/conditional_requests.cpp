/// IfBegin, ElseIf, Else, IfEnd, and blocks that are skipped whole.
#include "pipeline/rib/requests/request_table.h"

namespace trapeze::rib {
namespace {

std::string condition(Reader& r, ArgumentCursor& c) {
    std::string expression = c.string("the condition");
    r.parameters(c, Undeclared::Guess);
    return expression;
}

void else_if(Reader& r, ArgumentCursor& c) {
    const std::string expression = condition(r, c);
    r.else_if(&expression);
}

/// What else stands there means nothing here.
void skip_block(Reader& r, ArgumentCursor& c) {
    while (!c.done()) c.take("");
    r.skip_block();
}

constexpr RequestRow kConditionalRequests[] = {
    {"IfBegin", [](Reader& r, ArgumentCursor& c) { r.if_begin(condition(r, c)); }},
    {"ElseIf", else_if},
    {"Else", [](Reader& r, ArgumentCursor&) { r.else_if(nullptr); }},
    {"IfEnd", [](Reader& r, ArgumentCursor&) { r.if_end(); }},
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
