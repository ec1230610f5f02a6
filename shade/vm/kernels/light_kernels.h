/// What built-in functions add up over lights (RISpec 3.2, section 15.6), one light at a time, and cones of
/// light. `L` is the unit direction to the light, `Cl` its colour there, zero where it does not reach;
/// `share` scales it. Outputs are varying.
#pragma once

#include <cstddef>

#include "shade/vm/kernels/kernel.h"

namespace trapeze::vm {

/// out += Cl: ambient().
void add_light(size_t lanes, const Operand& Cl, float share, const Operand& out);

/// out += Cl * max(0, N.L), N of unit length: diffuse().
void add_diffuse(size_t lanes, const Operand& N, const Operand& L, const Operand& Cl, float share,
                 const Operand& out);

/// out += Cl * max(0, N.H)^(8 / roughness) where N.L > 0, with H = normalize(L + V), N and V of unit length:
/// specular(). Roughness is at least 1e-5.
void add_specular(size_t lanes, const Operand& N, const Operand& V, const Operand& roughness,
                  const Operand& L, const Operand& Cl, float share, const Operand& out);

/// out += Cl * max(0, R.L)^size with R = 2 (N.V) N - V, normalised; N and V may have any length: phong().
void add_phong(size_t lanes, const Operand& N, const Operand& V, const Operand& size, const Operand& L,
               const Operand& Cl, float share, const Operand& out);

/// Lanes where v lies within an angle (radians) of an axis; all do from half a turn on, and a vector or an
/// axis of no length lies in no smaller cone. In illuminance, v is L; in illuminate, the way from the light.
void cone_mask(size_t lanes, const Operand& v, const Operand& axis, const Operand& angle, const Operand& out);

/// What a light sends, as surfaces see it. L comes in as the way from the light and goes out as the way to
/// it, `direction` is that of unit length, and `Cl` is `color` where lanes are lit. A light does not reach
/// the point at which it is: there is no direction to it, and 1 / L.L is nothing.
void receive_light(size_t lanes, const Operand& lit, const Operand& color, const Operand& L,
                   const Operand& direction, const Operand& Cl);

}  // namespace trapeze::vm
