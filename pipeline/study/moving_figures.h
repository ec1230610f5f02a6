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
inline constexpr TreeRatios kNoFigures = {kNoFigure, kNoFigure, kNoFigure, kNoFigure,
                                          kNoFigure, kNoFigure, kNoFigure, kNoFigure};

/// The scenes that there is a counterpart of here.
enum MovingScene { kHairball, kRotatedSponza, kBubs, kCroc, kHand, kFlake, kMovingScenes };
inline constexpr std::string_view kMovingSceneNames[kMovingScenes] = {"Hairball", "Rotated Sponza", "Bubs",
                                                                      "Croc",     "Hand",           "Flake"};

/// The MSBVH: [Gruenschloss11 table 1]; builds, bytes and all of Hand and Flake are of [Yang17 tables 1
/// and 3]. "Time" is of rendering, without building.
inline constexpr TreeRatios kMsbvh[kMovingScenes] = {
    {871321.0 / 348000, 599276.0 / 182450, .43, 1.05, .85, 6.74 / 5.66, 503.0 / 470, 106.0 / 111},
    {140525.0 / 76081, 121486.0 / 63830, .47, .77, .72, 1.05 / .69, 101.0 / 93, 102.0 / 124},
    {1940520.0 / 1888229, 2046742.0 / 1994490, .89, .93, .94, kNoFigure, kNoFigure, 29.0 / 40},
    {1625919.0 / 1292986, 1762402.0 / 1356650, .96, .95, .90, kNoFigure, kNoFigure, 133.0 / 139},
    {kNoFigure, kNoFigure, kNoFigure, kNoFigure, 3.96 / 5.33, .21 / .14, 47.0 / 42, kNoFigure},
    {kNoFigure, kNoFigure, kNoFigure, kNoFigure, kNoFigure, kNoFigure, 72.0 / 65, kNoFigure}};

/// The k-d tree for motion blur: [Yang17 tables 1 and 3].
inline constexpr TreeRatios kMbkd[kMovingScenes] = {
    {kNoFigure, kNoFigure, kNoFigure, kNoFigure, 11.39 / 17.59, 7.04 / 5.66, 578.0 / 470, kNoFigure},
    {kNoFigure, kNoFigure, kNoFigure, kNoFigure, 14.90 / 23.87, 1.09 / .69, 122.0 / 93, kNoFigure},
    kNoFigures,
    kNoFigures,
    {kNoFigure, kNoFigure, kNoFigure, kNoFigure, 2.91 / 5.33, .23 / .14, 55.0 / 42, kNoFigure},
    {kNoFigure, kNoFigure, kNoFigure, kNoFigure, kNoFigure, kNoFigure, 87.0 / 65, kNoFigure}};
/// What moves across planes: the part of primitives that are duplicated for it, and the parts of building
/// that duplicating them and propagating the duplicates take [Yang17 table 2].
struct Incoherence {
    double quantity, duplicating, propagating;
};
inline constexpr Incoherence kNoIncoherence = {kNoFigure, kNoFigure, kNoFigure};
inline constexpr Incoherence kIncoherence[kMovingScenes] = {{.105, .179, .059}, {.053, .217, .015},
                                                            kNoIncoherence,     kNoIncoherence,
                                                            {.139, .234, .155}, kNoIncoherence};
/// What planes at the middle of the shutter save of tests, beside those at its ends, and what the weight by
/// time saves of duplicates [Yang17 sec. 5].
inline constexpr double kMiddlePlanesSave = .12, kTimeWeightSaves = .07;

/// What a sequence costs a frame, in seconds.
struct SequenceCosts {
    double update, trace;
};
/// What the report has of a sequence [DynBvh06 table 1], and how many times less than trees inserted anew
/// others are to cost here, in updates and in all, for its claims to hold: half as much more as it says, or
/// what is asked for beside; 0: it claims nothing.
struct SequenceClaims {
    /// Inserted anew each frame (Goldsmith-Salmon); updated (dynamic); loose.
    SequenceCosts costs[3];
    double least_dynamic_update, least_loose_update, least_dynamic_total, least_loose_total;
};
inline constexpr SequenceClaims kFalling = {{{7.478, 22.298}, {.907, 11.420}, {.404, 3.182}}, 4, 9, 1.5, 5};
inline constexpr SequenceClaims kKitchen = {{{1.759, 6.142}, {.017, 6.082}, {.157, 11.771}}, 100, 6, 1.15, 0};
inline constexpr SequenceClaims kMuseum = {
    {{1.933, 11.839}, {.315, 7.950}, {.125, 10.323}}, 3.5, 8, 1.33, 1.16};

}  // namespace trapeze::paper
