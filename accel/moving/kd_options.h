/// The choices of the k-d tree for what moves.
#pragma once

namespace trapeze {

/// Defaults are the paper's [Yang17], but for the mail-box, which it does not speak of.
struct KdTreeOptions {
    /// What a micropolygon counts on a side of a plane that it crosses.
    enum class Weight {
        Time,  ///< the part of the shutter that it is there [Yang17 sec. 3.1.1]
        Whole  ///< one, as in the usual heuristic
    };

    /// Which duplicates of what moves across planes take part in the choice of planes further down.
    enum class Guests {
        Silent,  ///< none: a guest's parts are not counted in any cell below [Yang17 sec. 3.1]
        Return,  ///< all but those of the plane just above
    };

    float plane_time = 0.5f;  ///< planes are chosen for the pose at this time of [0, 1]
    Weight weight = Weight::Time;
    Guests guests = Guests::Silent;
    /// References that may be added for each micropolygon; nodes that would need more are leaves.
    double budget = 16;
    /// Nodes of as many references are divided while the depth limit and planes allow, whatever it costs.
    int leaf = 8;
    bool mailbox = true;  ///< rays remember the last micropolygons that they tested
};

}  // namespace trapeze
