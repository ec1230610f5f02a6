#include "tessellate/split.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace trapeze {
namespace {

/// Intervals of a made edge that take about as much memory as a part.
constexpr size_t kIntervalsLikeAPart = 8;
/// Pieces of a rectangle along u and v between samples: at first, and where a small rectangle's do not tell
/// enough.
constexpr int kCoarse = kCoarseLatticePieces, kFine = 4;

/// A rectangle on its way; depth_u and depth_v: how often it was halved along each. `sides` says where each
/// of its sides lies on an edge: of the face, or one that was made by an earlier split.
struct SplitNode {
    V2f lo{0, 0}, hi{1, 1};
    std::array<SurfaceSide, 4> sides;
    int depth_u = 0, depth_v = 0;
    bool inside = false;  ///< the picture holds it: no culling
};

/// One line of a lattice at all keys.
using SplitLine = std::array<V3f, (kFine + 1) * LineMeasure::kMostKeys>;

/// Positions of (pieces + 1)^2 points spread evenly over a rectangle, at one key or all, in camera space.
struct Lattice {
    int pieces = 0, keys = 0;
    std::span<const V3f> P;

    int row() const { return pieces + 1; }
    const V3f& at(int key, int i, int j) const { return P[(key * row() + j) * row() + i]; }
    /// The lattice's points along u (axis 0) or v on line `number`, key by key, copied to `points`.
    std::span<const V3f> line(int axis, int number, SplitLine& points) const {
        size_t count = 0;
        for (int key = 0; key < keys; ++key)
            for (int k = 0; k <= pieces; ++k)
                points[count++] = axis == 0 ? at(key, k, number) : at(key, number, k);
        return {points.data(), count};
    }
};

/// How many micropolygons a rectangle wants along u or v: the most that any of its lattice's lines wants.
struct Want {
    bool split = false;
    int segments = 1;
    float pixels = 0;
    bool less = false;  ///< perhaps, looked at more closely
};

/// Splits one face after another. It depends on nothing but the face and the context, so that faces may be
/// split in any order and by any thread; made edges are numbered as they come, and renumbered when lists are
/// joined.
class FaceSplitter {
  public:
    FaceSplitter(const SplitContext& context, Splits& out)
        : context_(context),
          surface_(*context.surface),
          out_(out),
          edges_{&surface_.surface(), context.surface_edges, &out.made_lines, &out.made} {}

    void split_face(int face) {
        const SplitNode node = start(face);
        if (!emit_whole(node)) split(node);
    }

    /// The part of a face that split_face() reaches by some of the halves.
    void split_part(const FacePart& part) {
        SplitNode node = start(part.face);
        for (int depth = 0; depth < part.depth; ++depth) {
            const std::optional<std::array<SplitNode, 2>> halves = divide(node);
            if (!halves) return;  // never: it was divided when the part was found
            node = (*halves)[part.path >> depth & 1];
        }
        split(node);
    }

    /// The parts of a face, in the order of their subpatches.
    FaceParts find_parts(int face, uint32_t most_subpatches) {
        FaceParts found;
        const uint64_t culled = out_.culled;
        const uint32_t all = find_parts(start(face), {face, 0, 0}, most_subpatches, found);
        found.culled = out_.culled - culled;
        // Where parts are too many, how a rectangle is divided depends on those before it.
        if (parts_ >= context_.most_parts_of_face) found.parts = {{{face, 0, 0}, all}};
        return found;
    }

  private:
    SplitNode start(int face) {
        face_ = face;
        stands_alone_ = surface_.surface().stands_alone(face);
        parts_ = 0;
        SplitNode node;
        node.sides = surface_.surface().sides(face);
        return node;
    }

    /// Adds a rectangle's parts, of `most_subpatches` at most, and tells how many subpatches there are.
    /// Leaves no lists: what lies beside a rectangle does not need those within it.
    uint32_t find_parts(const SplitNode& node, const FacePart& part, uint32_t most_subpatches,
                        FaceParts& found) {
        const size_t first = found.parts.size(), subpatches = out_.subpatches.size(),
                     lines = out_.made_lines.size();
        uint32_t count = 0;
        if (const std::optional<std::array<SplitNode, 2>> halves = divide(node)) {
            for (const uint64_t half : {0, 1})
                count +=
                    find_parts((*halves)[half], {part.face, part.path | half << part.depth, part.depth + 1},
                               most_subpatches, found);
        } else if (out_.subpatches.size() > subpatches) {
            count = 1;
            found.micropolygons += static_cast<uint64_t>(out_.subpatches.back().shape.micropolygon_count());
        }
        if (count <= most_subpatches || part.depth >= FacePart::kMostDepth) {
            found.parts.resize(first);
            if (count > 0) found.parts.push_back({part, count});
        }
        out_.subpatches.resize(subpatches), out_.bounds.resize(subpatches);
        out_.made_lines.resize(lines), out_.made.resize(lines);
        return count;
    }

    /// Halves a rectangle again and again, and emits what is left.
    void split(const SplitNode& node) {
        if (const std::optional<std::array<SplitNode, 2>> halves = divide(node))
            for (const SplitNode& half : *halves) split(half);
    }

    /// Halves a rectangle along the direction that is longer in pixels, unless sides lie within intervals and
    /// the interior is small enough: then it is emitted. What no sample sees is dropped before it is split
    /// on.
    std::optional<std::array<SplitNode, 2>> divide(SplitNode node) {
        const std::array<Want, 2> want = wanted(node);
        const bool must_u = !in_interval(node.sides[kBottom]) || !in_interval(node.sides[kTop]);
        const bool must_v = !in_interval(node.sides[kLeft]) || !in_interval(node.sides[kRight]);
        const bool room = parts_ < context_.most_parts_of_face;
        const bool split_u = must_u || (want[0].split && room && node.depth_u < context_.rate.max_depth);
        const bool split_v = must_v || (want[1].split && room && node.depth_v < context_.rate.max_depth);
        out_.limited |= !room && (want[0].split || want[1].split);
        if (!split_u && !split_v) {
            emit(node, want);
            return {};
        }
        if (!node.inside) {
            const RasterBound::Result seen = bound(node);
            if (seen.rect.empty()) {
                ++out_.culled;
                return {};
            }
            node.inside = seen.inside;
        }
        ++parts_;
        const bool along_u = split_u && (!split_v || want[0].pixels >= want[1].pixels);
        return halves(node, along_u, room);
    }

    /// Adds a face that is known to need no split, its sides neither.
    bool emit_whole(const SplitNode& node) {
        if (context_.estimates.empty()) return false;
        const FaceEstimate& estimate = context_.estimates[face_];
        if (estimate.nu == 0) return false;
        if (!std::ranges::all_of(node.sides, [&](const SurfaceSide& s) { return in_interval(s); }))
            return false;
        emit(node, {Want{false, estimate.nu}, Want{false, estimate.nv}});
        return true;
    }

    static bool is_whole(const SplitNode& node) { return node.depth_u == 0 && node.depth_v == 0; }

    bool in_interval(const SurfaceSide& side) const {
        return edges_.interval(side.edge, side.begin, side.end) != nullptr;
    }

    /// Evaluates a rectangle's lattice; it stays valid until the next call.
    Lattice sample(const SplitNode& node, int pieces, int keys) {
        std::array<V2f, (kFine + 1) * (kFine + 1)> uv;
        const size_t n = static_cast<size_t>((pieces + 1) * (pieces + 1));
        for (int j = 0; j <= pieces; ++j)
            for (int i = 0; i <= pieces; ++i) {
                const V2f share(static_cast<float>(i) / static_cast<float>(pieces),
                                static_cast<float>(j) / static_cast<float>(pieces));
                uv[j * (pieces + 1) + i] = node.lo + (node.hi - node.lo) * share;
            }
        const std::span<V3f> P = scratch_.points(3, n * keys);
        surface_.positions(face_, {uv.data(), n}, keys, scratch_, P);
        return {pieces, keys, P};
    }

    /// What a rectangle wants along u and v. The closer look, at all keys, costs more and is taken only where
    /// foreshortening may make micropolygons fewer.
    std::array<Want, 2> wanted(const SplitNode& node) {
        Lattice lattice = sample(node, kCoarse, 1);
        std::array<Want, 2> want = wanted(lattice);
        if (std::max(want[0].segments, want[1].segments) > kCoarse || want[0].split || want[1].split) {
            lattice = sample(node, kFine, 1);
            want = wanted(lattice);
        }
        if (context_.flat_cuts.may_cut(surface_.surface(), face_)) cut_flat(lattice, want);
        if (!want[0].less && !want[1].less) return want;
        const int keys = context_.measure->keys();
        if (lattice.pieces != kFine || keys != 1) lattice = sample(node, kFine, keys);
        return foreshortened(lattice);
    }

    /// Has a rectangle of a flat face want what its values need.
    void cut_flat(const Lattice& lattice, std::array<Want, 2>& want) const {
        const int last = lattice.pieces;
        const std::array<int, 2> segments = context_.flat_cuts.segments(
            {lattice.at(0, 0, 0), lattice.at(0, last, 0), lattice.at(0, 0, last), lattice.at(0, last, last)},
            {want[0].segments, want[1].segments});
        for (size_t axis = 0; axis < 2; ++axis) {
            want[axis].split |= segments[axis] > kMaxGridSide;
            want[axis].segments = std::min(segments[axis], kMaxGridSide);
        }
    }

    /// By lengths at the first key alone, of all lines of the lattice together.
    std::array<Want, 2> wanted(const Lattice& lattice) const {
        std::array<Want, 2> want;
        const size_t row = lattice.row(), pieces = lattice.pieces;
        const std::span<const V3f> P = lattice.P.first(row * row);
        std::array<float, LineMeasure::kMostLengths> lengths;
        for (int d = 0; d < 2; ++d) {
            // Along u from the last of a line to the first of the next, too, which nobody asks for.
            const size_t step = d == 0 ? 1 : row, next_line = d == 0 ? row : 1;
            context_.measure->lengths(P.first(P.size() - step), P.subspan(step), lengths);
            for (size_t line = 0; line < row; ++line) {
                RateEstimate along;
                for (size_t i = 0; i < pieces; ++i) along.add(lengths[line * next_line + i * step]);
                take_in(along, want[d]);
            }
        }
        return want;
    }

    /// By what is seen of the lengths at all keys that the measure looks at.
    std::array<Want, 2> foreshortened(const Lattice& lattice) const {
        std::array<Want, 2> want;
        SplitLine points, beside;
        for (int d = 0; d < 2; ++d)
            for (int line = 0; line <= lattice.pieces; ++line)
                take_in(
                    context_.measure->foreshortened(lattice.line(d, line, points),
                                                    lattice.line(d, line > 0 ? line - 1 : line + 1, beside)),
                    want[d]);
        return want;
    }

    /// One more line of the lattice.
    void take_in(const RateEstimate& along, Want& want) const {
        want.split |= along.wants_split(context_.rate.pixels_per_segment);
        want.segments = std::max(want.segments, along.clamped_segments(context_.rate));
        want.pixels = std::max(want.pixels, along.sum);
        want.less |= context_.measure->may_want_less(along);
    }

    /// The two halves of a rectangle, and the edge made between them, whose ends lie on the rectangle's
    /// sides.
    std::array<SplitNode, 2> halves(const SplitNode& node, bool along_u, bool room) {
        const int axis = along_u ? 0 : 1;
        const SideName low = along_u ? kBottom : kLeft, high = along_u ? kTop : kRight;
        const SideName before = along_u ? kLeft : kBottom, after = along_u ? kRight : kTop;
        const float middle = (node.lo[axis] + node.hi[axis]) / 2;
        const float at_low = (node.sides[low].begin + node.sides[low].end) / 2;
        const float at_high = (node.sides[high].begin + node.sides[high].end) / 2;
        EdgeLine line;
        line.face = face_;
        line.from = node.lo, line.to = node.hi;
        line.from[axis] = line.to[axis] = middle;
        line.start = {true, node.sides[low].edge, at_low};
        line.finish = {true, node.sides[high].edge, at_high};
        const uint32_t edge = make_edge(line, room ? (along_u ? node.depth_v : node.depth_u) : -1);

        std::array<SplitNode, 2> half{node, node};
        half[0].hi[axis] = half[1].lo[axis] = middle;
        half[0].sides[low].end = half[1].sides[low].begin = at_low;
        half[0].sides[high].end = half[1].sides[high].begin = at_high;
        half[0].sides[after] = half[1].sides[before] = {edge, 0, 1};
        for (SplitNode& h : half) ++(along_u ? h.depth_u : h.depth_v);
        return half;
    }

    /// depth: of the node along the edge; -1 when the edge must not be split. Depths add up to the surface
    /// parameter's, which stays exact.
    uint32_t make_edge(const EdgeLine& line, int depth) {
        EdgeRate rate = context_.rate;
        rate.max_depth = depth < 0 ? 0 : std::max(0, rate.max_depth - depth);
        const size_t number = context_.surface_edges->size() + out_.made_lines.size();
        out_.made_lines.push_back(line);
        out_.made.add(surface_, line, *context_.measure, rate, scratch_);
        parts_ += out_.made.of(static_cast<uint32_t>(out_.made.size() - 1)).size() / kIntervalsLikeAPart;
        return static_cast<uint32_t>(number);
    }

    /// Adds a subpatch, unless it cannot be seen: as fine as its finest side and its interior want.
    void emit(const SplitNode& node, const std::array<Want, 2>& want) {
        const RasterBound::Result seen = bound(node);
        if (seen.rect.empty()) {
            ++out_.culled;
            return;
        }
        const auto count = [&](SideName side) { return border_side(edges_, node.sides[side]).count; };
        Subpatch subpatch;
        subpatch.face = face_;
        subpatch.lo = node.lo, subpatch.hi = node.hi;
        subpatch.sides = node.sides;
        const int bottom = count(kBottom), top = count(kTop), left = count(kLeft), right = count(kRight);
        const int nu = std::max({bottom, top, want[0].segments}),
                  nv = std::max({left, right, want[1].segments});
        subpatch.shape.nu = static_cast<uint8_t>(nu);
        subpatch.shape.nv = static_cast<uint8_t>(nv);
        subpatch.alone =
            bottom == nu && top == nu && left == nv && right == nv && is_whole(node) && stands_alone_;
        out_.subpatches.push_back(subpatch);
        out_.bounds.push_back(seen.rect);
    }

    /// The pixels that may see a rectangle: a box at each key, grown by displacement and rounding.
    RasterBound::Result bound(const SplitNode& node) {
        const int keys = surface_.key_count();
        boxes_.assign(keys, {});
        const FaceEstimate* const known =
            is_whole(node) && !context_.estimates.empty() ? &context_.estimates[face_] : nullptr;
        for (int key = 0; key < keys; ++key)
            boxes_[key] = known && known->bounded ? surface_.bound(known->bound, key)
                                                  : surface_.bound(face_, node.lo, node.hi, key);
        if (boxes_[0].isEmpty()) sampled_bound(node);
        if (!stands_alone_ || !is_whole(node)) add_moved_corners(node);
        for (Box3f& box : boxes_) {
            if (box.isEmpty()) continue;
            box = grown(box, context_.displacement_bound);
        }
        return context_.raster->of(boxes_);
    }

    /// Boxes of samples, for surfaces that know no bound, grown by half their second differences: four times
    /// what a curve with that second derivative departs from its chords.
    void sampled_bound(const SplitNode& node) {
        const Lattice lattice = sample(node, kFine, surface_.key_count());
        for (int key = 0; key < lattice.keys; ++key) {
            Box3f& box = boxes_[key];
            box.makeEmpty();
            V3f bend_u(0, 0, 0), bend_v(0, 0, 0);
            const auto second = [](const V3f& a, const V3f& b, const V3f& c, V3f& largest) {
                for (int k = 0; k < 3; ++k)
                    largest[k] = std::max(largest[k], std::abs((a[k] - b[k]) + (c[k] - b[k])));
            };
            for (int j = 0; j <= lattice.pieces; ++j)
                for (int i = 0; i <= lattice.pieces; ++i) {
                    box.extendBy(lattice.at(key, i, j));
                    if (i > 0 && i < lattice.pieces)
                        second(lattice.at(key, i - 1, j), lattice.at(key, i, j), lattice.at(key, i + 1, j),
                               bend_u);
                    if (j > 0 && j < lattice.pieces)
                        second(lattice.at(key, i, j - 1), lattice.at(key, i, j), lattice.at(key, i, j + 1),
                               bend_v);
                }
            const V3f grow = (bend_u + bend_v) * 0.5f;
            box.min -= grow, box.max += grow;
        }
    }

    /// Corners that snap to a vertex of an edge may leave the rectangle, by up to half a segment.
    void add_moved_corners(const SplitNode& node) {
        std::array<BorderPoint, 8> corners;
        size_t count = 0;
        for (const SurfaceSide& side : node.sides)
            for (const float parameter : {side.begin, side.end}) {
                if (edges_.is_vertex(side.edge, parameter)) continue;
                const BorderPoint corner = edges_.end({true, side.edge, parameter});
                if (corner.moved) corners[count++] = corner;
            }
        if (count == 0) return;
        const size_t keys = boxes_.size();
        const std::span<V3f> P = scratch_.points(4, count * keys);
        border_positions(surface_, *context_.vertices, {corners.data(), count}, scratch_, P);
        for (size_t i = 0; i < count * keys; ++i) boxes_[i % keys].extendBy(P[i]);
    }

    const SplitContext& context_;
    const PlacedSurface& surface_;
    Splits& out_;
    const Edges edges_;
    EvaluationScratch scratch_;
    std::vector<Box3f> boxes_;
    int face_ = 0;
    bool stands_alone_ = false;  ///< the face
    size_t parts_ = 0;           ///< of the face, seen or not, and its made edges' likes
};

}  // namespace

size_t Splits::bytes() const {
    return subpatches.capacity() * sizeof(Subpatch) + bounds.capacity() * sizeof(PixelRect) +
           made_lines.capacity() * sizeof(EdgeLine) + made.bytes();
}

/// Takes the other's lists; numbers of its made edges, in their own ends and in sides of subpatches, move
/// behind these.
void Splits::append(Splits&& other, uint32_t surface_edges) {
    const uint32_t offset = static_cast<uint32_t>(made_lines.size());
    const auto moved = [&](uint32_t edge) { return edge < surface_edges ? edge : edge + offset; };
    for (EdgeLine& line : other.made_lines) {
        line.start.id = moved(line.start.id), line.finish.id = moved(line.finish.id);
        made_lines.push_back(line);
    }
    for (Subpatch& subpatch : other.subpatches) {
        for (SurfaceSide& side : subpatch.sides) side.edge = moved(side.edge);
        subpatches.push_back(subpatch);
    }
    bounds.insert(bounds.end(), other.bounds.begin(), other.bounds.end());
    made.append(other.made);
    culled += other.culled;
    limited |= other.limited;
}

/// Faces are split independently of one another, so ranges of them can be given to threads; borders meet
/// since both sides ask for the same edge.
Splits split_faces(const SplitContext& context, int first_face, int end_face) {
    Splits splits;
    FaceSplitter splitter(context, splits);
    for (int face = first_face; face < end_face; ++face)
        if (!context.surface->surface().is_hole(face)) splitter.split_face(face);
    return splits;
}

void find_parts(const SplitContext& context, int first_face, uint32_t most_subpatches,
                std::span<FaceParts> found) {
    Splits passing;
    FaceSplitter splitter(context, passing);
    for (size_t i = 0; i < found.size(); ++i) {
        const int face = first_face + static_cast<int>(i);
        if (context.surface->surface().is_hole(face)) continue;
        found[i] = splitter.find_parts(face, most_subpatches);
        found[i].limited = std::exchange(passing.limited, false);
    }
}

Splits split_part(const SplitContext& context, const FacePart& part) {
    Splits splits;
    FaceSplitter(context, splits).split_part(part);
    return splits;
}

}  // namespace trapeze
