/// The predefined variables that a program names, and which of them must hold their values when it starts.
#pragma once

#include <cstdint>
#include <vector>

#include "shade/code/program.h"

namespace trapeze::vm {

/// RISpec 3.2, tables 12.1 to 12.5; RayOrigin and RayWay: where the ray began that has hit the point, and its
/// way from there, which rayinfo() tells; SurfaceU and SurfaceV: what derivatives are by; Other: what the
/// renderer has no value for, and is zero.
enum class Predefined : uint8_t {
    P,
    Ps,
    N,
    Ns,
    Ng,
    dPdu,
    dPdv,
    Cs,
    Os,
    Ci,
    Oi,
    u,
    v,
    s,
    t,
    du,
    dv,
    I,
    ncomps,
    time,
    dtime,
    dPdtime,
    RayOrigin,
    RayWay,
    SurfaceU,
    SurfaceV,
    Other
};

/// A predefined variable that the program names.
struct StartValue {
    rsl::RegisterId id = 0;
    Predefined variable = Predefined::Other;
    /// False: the program sets the variable in all lanes before it looks at it. Others may still look: the
    /// lights that it asks meanwhile.
    bool needed = true;
};

/// One for each of program.globals. A value that nobody can see is not computed or copied into the registers:
/// a constant surface over a grid costs mostly that.
std::vector<StartValue> start_values(const rsl::Program& program);

}  // namespace trapeze::vm
