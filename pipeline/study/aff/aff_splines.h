/// Splines through keys in time, as BART's animations have them: cubic ones of Kochanek and Bartels
/// (Interpolating splines with local tension, continuity, and bias control, SIGGRAPH 1984) for places and
/// scales, and what corresponds to them for rotations.
///
/// There are 4 keys or more. The first and the last one give tangents only: a spline lasts from the second
/// key to the last but one; before and after it stays where it is at these. Of keys at the same time the
/// later one holds at that time.
#pragma once

#include <Imath/ImathQuat.h>

#include <vector>

#include "core/math.h"

namespace trapeze {

/// A key. Times never fall from key to key.
struct AffKey {
    double time = 0;
    V3d value;           ///< of a rotation: the axis, of any length; 0 0 0: no rotation
    double degrees = 0;  ///< of a rotation: about the axis, counterclockwise as seen from where it points to
    double tension = 0, continuity = 0, bias = 0;
};

/// The rotation by an angle about an axis that need not have length 1; none where it has length 0.
Imath::Quatd aff_rotation(const V3d& axis, double degrees);

class AffSpline {
  public:
    explicit AffSpline(const std::vector<AffKey>& keys);
    V3d at(double time) const;

  private:
    struct Segment {
        V3d c0, c1, c2, c3;  ///< coefficients of powers of u, which goes from 0 to 1
    };
    std::vector<double> times_;  ///< at which segments begin, and when the last one ends
    std::vector<Segment> segments_;
};

/// Each segment is a spherical curve of four quaternions (squad, of Shoemake: Animating rotation with
/// quaternion curves, SIGGRAPH 1985), the inner two of which are chosen by the tangents of Kochanek and
/// Bartels.
class AffRotationSpline {
  public:
    explicit AffRotationSpline(const std::vector<AffKey>& keys);
    Imath::Quatd at(double time) const;

  private:
    struct Segment {
        Imath::Quatd begin, after_begin, before_end, end;
    };
    std::vector<double> times_;
    std::vector<Segment> segments_;
};

}  // namespace trapeze
