/// Figures of Hou et al. 2010, measured on one NVIDIA GTX 285. In seconds unless something else is said.
#pragma once

#include <array>
#include <string_view>

namespace trapeze::paper {

/// The rows of tables 1, 2 and 5.
inline constexpr std::array<std::string_view, 4> kMethods = {"raytrace", "interval", "interleaveuvt:k=2",
                                                             "interleaveuvt:k=4"};

/// Table 1, the Car scene of figure 6: by method, then defocus, motion blur, both.
inline constexpr double kTable1[4][3] = {
    {10.5, 13.2, 17.2}, {42.9, 18.6, 91.9}, {77.1, 68.7, 80.7}, {261.3, 227.8, 266.8}};

/// The columns of tables 2 and 4.
inline constexpr std::array<std::string_view, 4> kScenes = {"Furball", "Ladybug", "Fairy", "Car"};

/// Samples along each side of a pixel in tables 2 and 5's Ref, as figures 7 and 1 have them.
inline constexpr int kReferenceSide[4] = {13, 23, 13, 23};

/// Table 2: by method, then by scene.
inline constexpr double kTable2[4][4] = {{52.7, 44.4, 10.9, 28.2},
                                         {119.3, 163.4, 32.3, 178.0},
                                         {57.5, 148.1, 20.2, 214.4},
                                         {155.9, 484.4, 64.2, 710.6}};

/// What table 3 has of a whole frame: seconds.
struct FrameParts {
    double tessellation, shading, sampling, composition, total;
};
/// Table 3, by scene. Most of the Car's shading is point-based occlusion.
inline constexpr FrameParts kTable3[4] = {{1.4, 8.1, 52.7, 158.8, 221.0},
                                          {2.6, 81.0, 44.4, 5.5, 133.5},
                                          {.1, 7.7, 10.9, 44.6, 63.3},
                                          {1.1, 213.2, 28.2, 15.9, 258.4}};
/// Micropolygons of the scenes, in millions, and the height of their pictures, 1280 wide.
inline constexpr double kMicropolygons[4] = {17.6, 24.1, 5.96, 48.9};
inline constexpr int kHeight[4] = {960, 960, 720, 720};

/// Table 4: by structure, then by scene; build, trace. Negative where the paper has none.
struct BuildTrace {
    double build, trace;
};
inline constexpr BuildTrace kTable4[7][4] = {
    {{5.0, 47.6}, {6.7, 38.2}, {.8, 10.0}, {4.6, 23.5}},       // ours
    {{-1, -1}, {-1, -1}, {.7, 13.5}, {3.6, 60.0}},             // AABB hyper-trapezoids
    {{4.4, 62.3}, {5.6, 79.2}, {.7, 16.9}, {3.7, 5077.4}},     // 3D/4D AABB
    {{51.5, 60.9}, {67.8, 84.0}, {8.2, 10.0}, {104.3, 53.0}},  // no parametric-space split
    {{5.1, 47.6}, {6.8, 42.9}, {.8, 10.0}, {4.7, 23.5}},       // no orientation-aware split
    {{5.1, 43.6}, {6.6, 57.2}, {.7, 10.3}, {4.3, 26.7}},       // no orientation propagation
    {{5.0, 51.2}, {6.7, 38.1}, {.8, 10.2}, {4.6, 23.3}}};      // no ray sort; its build is not in the table

/// Table 5: by scene, method, then 1x1, 4x4, 8x8, Ref, SRx4, SRx16.
/// Negative where our copy of the paper is not legible.
inline constexpr double kTable5[4][4][6] = {{{5.2, 10.2, 24.9, 52.7, 64.4, 153.4},
                                             {18.7, 34.6, 65.2, 119.3, 74.0, 71.6},
                                             {.6, 5.6, 21.9, 57.5, 33.3, 31.6},
                                             {1.2, 15.0, 59.1, 155.9, 70.2, 52.2}},
                                            {{3.0, 4.2, 7.9, 44.4, 40.7, 38.1},
                                             {7.2, 15.8, 32.9, 163.4, 137.3, 52.3},
                                             {.5, 4.6, 17.9, 148.1, 124.4, 35.0},
                                             {1.1, 15.0, 59.4, 484.4, 406.9, 74.6}},
                                            {{1.0, 1.9, 4.5, 10.9, 8.4, 7.7},
                                             {3.6, 7.9, 16.5, 32.3, 15.6, 11.3},
                                             {.2, 1.9, 7.7, 20.2, 9.3, 5.7},
                                             {.4, 6.1, 24.3, 64.2, 23.9, 11.7}},
                                            {{4.4, 5.3, 7.5, 28.2, 24.3, 24.7},
                                             {-1, -1, -1, 178.0, -1, -1},
                                             {-1, -1, -1, 214.4, -1, -1},
                                             {-1, -1, -1, 710.6, -1, -1}}};

/// Section 5.2, figure 9, of the relative difference in SAH cost: its mean, the parts of grids where it is at
/// most 0 and at most .2, its range.
inline constexpr double kFigure9Mean = -.074, kFigure9Better = .75, kFigure9NotMuchWorse = .94,
                        kFigure9Least = -.76, kFigure9Most = 1.01;

}  // namespace trapeze::paper
