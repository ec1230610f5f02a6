/// Figures of the papers on trees for what moves, as our copies have them. NaN where one has none.
#pragma once

#include <limits>
#include <string_view>

namespace trapeze::paper {

/// A structure's figures on a scene, by those of boxes that are interpolated between motion keys.
struct TreeRatios {
    double references, nodes, tests, steps, time, build, bytes;  ///< tests and steps: means of a pixel
    double sah;                                                  ///< cost by the surface area heuristic
};
inline constexpr double kNoFigure = std::numeric_limits<double>::quiet_NaN();

/// The scenes that there is a counterpart of here.
enum MovingScene { kHairball, kRotatedSponza, kMovingScenes };
inline constexpr std::string_view kMovingSceneNames[kMovingScenes] = {"Hairball", "Rotated Sponza"};

/// The MSBVH: [Gruenschloss11 table 1]; builds and bytes are of [Yang17 tables 1 and 3]. "Time" is of
/// rendering, without building.
inline constexpr TreeRatios kMsbvh[kMovingScenes] = {
    {871321.0 / 348000, 599276.0 / 182450, .43, 1.05, .85, 6.74 / 5.66, 503.0 / 470, 106.0 / 111},
    {140525.0 / 76081, 121486.0 / 63830, .47, .77, .72, 1.05 / .69, 101.0 / 93, 102.0 / 124}};

/// The k-d tree for motion blur: [Yang17 tables 1 and 3].
inline constexpr TreeRatios kMbkd[kMovingScenes] = {
    {kNoFigure, kNoFigure, kNoFigure, kNoFigure, 11.39 / 17.59, 7.04 / 5.66, 578.0 / 470, kNoFigure},
    {kNoFigure, kNoFigure, kNoFigure, kNoFigure, 14.90 / 23.87, 1.09 / .69, 122.0 / 93, kNoFigure}};
/// What planes at the middle of the shutter save of tests, beside those at its ends, and what the weight by
/// time saves of duplicates [Yang17 sec. 5].
inline constexpr double kMiddlePlanesSave = .12, kTimeWeightSaves = .07;

/// What a sequence costs a frame, in seconds [DynBvh06 table 1, falling triangles].
struct SequenceCosts {
    double update, trace;
};
/// Inserted anew each frame (Goldsmith-Salmon); updated (dynamic); loose.
inline constexpr SequenceCosts kFalling[3] = {{7.478, 22.298}, {.907, 11.420}, {.404, 3.182}};

}  // namespace trapeze::paper
