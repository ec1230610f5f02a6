/// The calls with "...", from the table in ri.h. Their V forms do the work, in the file of their subject.
#include <cstdarg>

#include "pipeline/ri/pairs.h"

#define RI_DEFINE_WITH_ELLIPSIS(Type, Name, parameters, names, last)                                  \
    Type Ri##Name(RI_WITHOUT_BRACKETS parameters, ...) {                                              \
        va_list rest;                                                                                 \
        va_start(rest, last);                                                                         \
        trapeze::ri::PairList pairs(rest);                                                            \
        va_end(rest);                                                                                 \
        return Ri##Name##V(RI_WITHOUT_BRACKETS names, pairs.count(), pairs.tokens(), pairs.values()); \
    }

RI_CALLS(RI_DEFINE_WITH_ELLIPSIS)
