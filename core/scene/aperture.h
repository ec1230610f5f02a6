/// The opening of the lens: a disk, or what blades leave open (Hider "aperture" of PRMan).
#pragma once

namespace trapeze {

struct Options;

/// Corners lie on the unit circle, where the lens' rim is, and all of the opening within it.
struct Aperture {
    /// Polygons of more sides are taken for the disk, from which they differ by less than .0003 of its
    /// radius.
    static constexpr int kMostBlades = 128;

    int blades = 0;       ///< sides; fewer than 3, or more than kMostBlades: round, whatever its roundness
    float angle = 0;      ///< of a corner, in degrees, from x towards y of camera space
    float roundness = 0;  ///< 0: straight sides; 1: a disk; below 0 the sides bow in; -1 to 1
    float density = 0;    ///< 1: dark in the middle, bright at the rim; 0: even; -1: the reverse

    bool is_round() const { return blades < 3 || blades > kMostBlades || roundness >= 1; }
    /// A disk that is as bright everywhere.
    bool is_disk() const { return is_round() && density == 0; }
};

/// What the options' hider says; a disk where it does not. Numbers are finite.
Aperture aperture_of(const Options& options);

}  // namespace trapeze
