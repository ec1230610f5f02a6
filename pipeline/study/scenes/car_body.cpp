/// The body is one regular net of control points, from the nose to the tail and from sill to sill over the
/// roof, so that it is a B-spline surface but for its creases. What is paint, glass or lamp is the same net
/// again with holes in place of all other faces: the pieces meet exactly.
#include "pipeline/study/scenes/car_body.h"

#include <algorithm>
#include <array>

#include "pipeline/study/scenes/cage.h"

namespace trapeze::scenes {
namespace {

constexpr int kHalfColumns = 9;  ///< sill, lower door, door, shoulder, belt, pillar, rail, roof, middle
constexpr int kColumns = 2 * kHalfColumns - 1;
constexpr int kShoulder = 3, kBelt = 4, kPillar = 5, kRail = 6, kMiddle = 8;

using Section = std::array<V3d, kHalfColumns>;

/// The bumper's lower edge, the intake's upper edge, the widest line, and the bonnet's front edge.
const std::array<Section, 4> kNose = {{
    {{{.88, .19, 1.99},
      {.86, .19, 2.04},
      {.81, .19, 2.10},
      {.73, .19, 2.16},
      {.63, .19, 2.20},
      {.52, .19, 2.23},
      {.42, .19, 2.25},
      {.22, .19, 2.27},
      {0, .19, 2.28}}},
    {{{.90, .19, 1.95},
      {.90, .26, 2.00},
      {.86, .33, 2.07},
      {.78, .38, 2.15},
      {.68, .39, 2.20},
      {.56, .39, 2.24},
      {.45, .39, 2.27},
      {.24, .39, 2.30},
      {0, .39, 2.31}}},
    {{{.92, .19, 1.92},
      {.93, .32, 1.97},
      {.91, .43, 2.04},
      {.83, .50, 2.13},
      {.72, .52, 2.21},
      {.59, .52, 2.26},
      {.48, .51, 2.29},
      {.25, .50, 2.33},
      {0, .50, 2.34}}},
    {{{.93, .19, 1.88},
      {.95, .37, 1.90},
      {.94, .54, 1.93},
      {.88, .68, 1.97},
      {.76, .72, 2.06},
      {.61, .72, 2.13},
      {.49, .71, 2.16},
      {.25, .71, 2.19},
      {0, .71, 2.20}}},
}};

/// The lid's edge, the middle of the back, and the bumper's lower edge.
const std::array<Section, 3> kTail = {{
    {{{.92, .21, -1.92},
      {.95, .42, -1.95},
      {.94, .64, -2.00},
      {.88, .82, -2.06},
      {.77, .93, -2.12},
      {.66, .96, -2.17},
      {.53, .97, -2.20},
      {.28, .98, -2.22},
      {0, .98, -2.23}}},
    {{{.90, .21, -1.97},
      {.91, .36, -2.02},
      {.88, .52, -2.08},
      {.81, .66, -2.15},
      {.71, .74, -2.20},
      {.60, .76, -2.23},
      {.48, .76, -2.25},
      {.26, .76, -2.27},
      {0, .76, -2.28}}},
    {{{.88, .21, -2.02},
      {.86, .23, -2.07},
      {.82, .27, -2.13},
      {.75, .30, -2.18},
      {.65, .31, -2.21},
      {.54, .31, -2.24},
      {.44, .31, -2.25},
      {.24, .31, -2.26},
      {0, .31, -2.27}}},
}};

/// A section between: at z, which is less by `lead` at the sides than in the middle.
struct Station {
    double z, lead, bottom, width, shoulder;
    double belt_x, belt, pillar_x, pillar, rail_x, rail, top;
};

/// Cross sections of the body from nose to tail, in metres; columns as in Station.
const std::array<Station, 16> kStations = {{
    {1.83, .10, .21, .945, .72, .81, .76, .69, .770, .55, .770, .780},
    {1.69, .08, .635, .955, .78, .82, .815, .70, .810, .56, .795, .805},
    {1.40, .05, .755, .960, .83, .825, .86, .71, .850, .58, .830, .845},
    {1.11, .04, .635, .955, .82, .83, .87, .73, .870, .61, .865, .880},
    {.97, .06, .21, .935, .80, .835, .87, .74, .880, .65, .885, .900},
    {.84, .12, .18, .925, .79, .84, .875, .76, .890, .67, .905, .920},
    {.42, .12, .18, .920, .785, .845, .88, .725, 1.055, .62, 1.090, 1.120},
    {-.05, .10, .18, .920, .785, .845, .885, .665, 1.215, .56, 1.265, 1.300},
    {-.42, .06, .18, .920, .79, .845, .89, .655, 1.245, .545, 1.300, 1.335},
    {-.50, .05, .18, .920, .79, .845, .89, .655, 1.245, .545, 1.300, 1.335},
    {-.97, -.02, .21, .940, .80, .845, .895, .665, 1.215, .555, 1.265, 1.300},
    {-1.11, -.03, .635, .955, .82, .845, .90, .675, 1.180, .565, 1.230, 1.265},
    {-1.40, -.05, .755, .965, .85, .84, .915, .700, 1.085, .60, 1.130, 1.165},
    {-1.69, -.07, .635, .960, .86, .83, .935, .725, 1.005, .635, 1.030, 1.055},
    {-1.80, -.08, .21, .950, .86, .825, .945, .730, .980, .64, .995, 1.010},
    {-1.88, -.10, .21, .945, .86, .82, .95, .720, .970, .62, .980, .990},
}};

/// Indices of sections: where the screens and side windows are.
constexpr int kFrontEdge = 3, kArchEnd = 8, kCowl = 9, kScreenTop = 11, kDoorPost = 12;
constexpr int kRearTop = 14, kRearFoot = 17, kLid = 20, kSections = 23;

/// The points of a cross section, one for each column of the cage. The section is bent: the middle leads the
/// sides by `lead`.
Section section_of(const Station& s) {
    const auto at = [&](double x, double y) {
        return V3d(x, y, s.z - s.lead * (x * x) / (s.width * s.width) + s.lead);
    };
    const auto side = [&](double part) { return s.bottom + part * (s.shoulder - s.bottom); };
    return {at(.975 * s.width, s.bottom),  at(.995 * s.width, side(.3)), at(s.width, side(.65)),
            at(.99 * s.width, s.shoulder), at(s.belt_x, s.belt),         at(s.pillar_x, s.pillar),
            at(s.rail_x, s.rail),          at(.55 * s.rail_x, s.top),    at(0, s.top + .012)};
}

void add_points(Cage& cage) {
    std::vector<Section> sections(kNose.begin(), kNose.end());
    for (const Station& station : kStations) sections.push_back(section_of(station));
    sections.insert(sections.end(), kTail.begin(), kTail.end());
    for (const Section& section : sections)
        for (int c = 0; c < kColumns; ++c) {
            V3d p = section[static_cast<size_t>(std::min(c, kColumns - 1 - c))];
            if (c > kMiddle) p.x = -p.x;
            cage.points.push_back(p);
        }
}

/// The piece that a face belongs to: the face behind section i and above column j of a half.
BodyPiece piece_of(int i, int j) {
    const bool side_window = j == kBelt && i >= kCowl && i < kRearTop;
    if (side_window) return i == kDoorPost ? BodyPiece::kTrim : BodyPiece::kGlass;
    const bool screen = (i >= kCowl && i < kScreenTop) || (i >= kRearTop && i < kRearFoot);
    if (j >= kRail && screen) return BodyPiece::kGlass;
    const bool sill = j == 0 && i >= kArchEnd && i < kRearTop;
    const bool intake = i == 0 && j > kShoulder, grille = i == 2 && j >= kRail;
    const bool number_plate = i == kLid + 1 && j >= kBelt;
    if (sill || intake || grille || number_plate) return BodyPiece::kTrim;
    if (i == 2 && (j == kBelt || j == kShoulder)) return BodyPiece::kGlass;  // of the head lamps
    if (i == kLid && (j == kBelt || j == kPillar)) return BodyPiece::kTailLamps;
    return BodyPiece::kPaint;
}

void add_faces(Cage& cage, BodyPiece piece) {
    int face = 0;
    for (int i = 0; i + 1 < kSections; ++i)
        for (int c = 0; c + 1 < kColumns; ++c, ++face) {
            const int v = i * kColumns + c;
            cage.face({v, v + 1, v + 1 + kColumns, v + kColumns});
            if (piece_of(i, std::min(c, kColumns - 2 - c)) != piece) cage.holes.push_back(face);
        }
}

void add_lengthwise_crease(Cage& cage, int column, int from, int to, double sharpness) {
    for (const int c : {column, kColumns - 1 - column}) {
        Integers chain;
        for (int i = from; i <= to; ++i) chain.push_back(i * kColumns + c);
        cage.crease(chain, sharpness);
    }
}

void add_crossing_crease(Cage& cage, int section, int from_column, double sharpness) {
    Integers chain;
    for (int c = from_column; c <= kColumns - 1 - from_column; ++c) chain.push_back(section * kColumns + c);
    cage.crease(chain, sharpness);
}

void add_creases(Cage& cage) {
    add_lengthwise_crease(cage, kShoulder, kFrontEdge, kLid, 1.6);
    add_lengthwise_crease(cage, kBelt, kCowl, kRearTop, 3);
    add_lengthwise_crease(cage, kPillar, kCowl, kRearTop, 2.5);
    add_lengthwise_crease(cage, kRail, kFrontEdge, kCowl, 1.5);
    add_lengthwise_crease(cage, kRail, kCowl, kScreenTop, 2.5);
    add_lengthwise_crease(cage, kRail, kRearTop, kRearFoot, 2);
    add_crossing_crease(cage, 1, kShoulder, 2);
    add_crossing_crease(cage, 2, kShoulder, 1.6);
    add_crossing_crease(cage, kFrontEdge, kShoulder, 1.6);
    add_crossing_crease(cage, kCowl, kPillar, 2.5);
    add_crossing_crease(cage, kScreenTop, kRail, 2);
    add_crossing_crease(cage, kRearTop, kRail, 1.5);
    add_crossing_crease(cage, kLid, kBelt, 3);
    add_crossing_crease(cage, kLid + 1, kBelt, 2);
}

}  // namespace

void write_car_body(RibWriter& rib, BodyPiece piece) {
    Cage cage;
    add_points(cage);
    add_faces(cage, piece);
    add_creases(cage);
    cage.write(rib);
}

}  // namespace trapeze::scenes
