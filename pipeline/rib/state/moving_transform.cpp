#include "pipeline/rib/state/moving_transform.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "core/motion_keys.h"
#include "core/portable_math.h"

namespace trapeze::rib {
namespace {

/// A shutter is divided into 16 for given times at most.
constexpr int kMostKeysForTimes = 17;
/// Times between keys at which paths are looked at: each costs as much as a key.
constexpr size_t kMostUnmetTimes = 64;
/// A chord of ten degrees is 0.4 % of the radius off its arc.
constexpr float kDegreesPerSegment = 10;
constexpr double kLinearTolerance = 0.004;  ///< 1 - cos(5 degrees): as far as a chord of ten degrees is off

/// RISpec gives angles in degrees.
double radians(double degrees) {
    return degrees * (M_PI / 180);
}

/// RISpec: about an axis, in the sense in which x goes to y about z. Written for row vectors: the rows are
/// what becomes of the axes.
M44d rotation(const TransformArguments& a) {
    V3d axis(a[1], a[2], a[3]);
    if (axis.length() == 0) return M44d();
    axis.normalize();
    const double c = portable::cos(radians(a[0])), s = portable::sin(radians(a[0])), k = 1 - c;
    const double x = axis.x, y = axis.y, z = axis.z;
    return M44d(k * x * x + c, k * x * y + s * z, k * x * z - s * y, 0,  //
                k * x * y - s * z, k * y * y + c, k * y * z + s * x, 0,  //
                k * x * z + s * y, k * y * z - s * x, k * z * z + c, 0,  //
                0, 0, 0, 1);
}

/// RISpec: shifts points along the second vector so that the first is moved by the angle towards it.
M44d skew(const TransformArguments& a) {
    V3d from(a[1], a[2], a[3]), to(a[4], a[5], a[6]);
    if (from.length() == 0 || to.length() == 0) return M44d();
    from.normalize(), to.normalize();
    const double cosine = from.dot(to);
    const V3d across_vector = from - to * cosine;
    const double sine = across_vector.length();
    if (sine < 1e-9) return M44d();
    const V3d across = across_vector / sine;
    // In the plane of both, `from` is (cosine along `to`, sine across): after the shear its angle to `to` is
    // smaller.
    const double angle = portable::atan2(sine, cosine);
    const double shifted = angle - radians(a[0]);
    const double shear = std::abs(portable::sin(shifted)) < 1e-9
                             ? 0
                             : sine * portable::cos(shifted) / portable::sin(shifted) - cosine;
    const double amount = shear / sine;
    M44d m;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) m[i][j] += across[i] * amount * to[j];
    return m;
}

/// The key of the shutter that a time within it is: to a ten-thousandth of a segment, for times are floats.
std::optional<int> key_of(float time, float open, float close, int keys) {
    const float place = (time - open) / (close - open) * static_cast<float>(keys - 1);
    const float nearest = std::round(place);
    if (!(std::abs(place - nearest) < 1e-4f)) return {};
    return static_cast<int>(nearest);
}

/// Leaves so many of some times, evenly.
void thin_out(std::vector<float>& times) {
    if (times.size() <= kMostUnmetTimes) return;
    for (size_t i = 0; i < kMostUnmetTimes; ++i) times[i] = times[i * times.size() / kMostUnmetTimes];
    times.resize(kMostUnmetTimes);
}

}  // namespace

/// RISpec 4.3. Perspective divides by z times the tangent of half the angle: z = 1 comes to 0, what is
/// infinitely far to 1.
M44d transform_matrix(TransformKind kind, const TransformArguments& a) {
    M44d m;
    switch (kind) {
        case TransformKind::Translate:
            m.setTranslation(V3d(a[0], a[1], a[2]));
            break;
        case TransformKind::Scale:
            m.setScale(V3d(a[0], a[1], a[2]));
            break;
        case TransformKind::Rotate:
            m = rotation(a);
            break;
        case TransformKind::Skew:
            m = skew(a);
            break;
        case TransformKind::Matrix:
            for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = a[i];
            break;
        case TransformKind::Perspective: {
            const double t = portable::tan(radians(a[0]) / 2);
            m = M44d(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, t, t, 0, 0, -t, 0);
            break;
        }
    }
    return m;
}

/// Arguments are mixed, not matrices: half of a rotation is a rotation by half the angle.
M44d MovingFactor::at(float time) const {
    if (time <= times.front()) return transform_matrix(kind, arguments.front());
    if (time >= times.back()) return transform_matrix(kind, arguments.back());
    const size_t next = std::upper_bound(times.begin(), times.end(), time) - times.begin();
    const float t = (time - times[next - 1]) / (times[next] - times[next - 1]);
    TransformArguments between = arguments[next - 1];
    for (size_t i = 0; i < between.size(); ++i) between[i] += t * (arguments[next][i] - between[i]);
    return transform_matrix(kind, between);
}

/// Nothing moves in a shutter that closes before the first time or opens after the last.
bool MovingFactor::moves_between(float open, float close) const {
    if (!(close > open) || close <= times.front() || open >= times.back()) return false;
    return std::any_of(arguments.begin(), arguments.end(),
                       [&](const auto& a) { return a != arguments.front(); });
}

/// The angle is taken from the request: axes that change are seen by is_nearly_linear().
float MovingFactor::fastest_turn(float open, float close) const {
    if (kind != TransformKind::Rotate) return 0;
    float fastest = 0;
    for (size_t i = 1; i < times.size(); ++i) {
        if (times[i] <= open || times[i - 1] >= close) continue;
        const float shutters = (times[i] - times[i - 1]) / (close - open);
        fastest =
            std::max(fastest, std::abs(arguments[i][0] - arguments[i - 1][0]) / std::max(shutters, 1e-6f));
    }
    return fastest;
}

/// Neighbouring fixed matrices are multiplied at once; the chain is as long as there are motions.
void MovingTransform::concat(const M44d& matrix) {
    if (newest_ && newest_.use_count() == 1 && !newest_->moving) {  // nobody else has it
        newest_->fixed = matrix * newest_->fixed;
        return;
    }
    auto factor = std::make_shared<Factor>();
    factor->fixed = matrix;
    if (newest_) {
        factor->older = newest_;
        factor->moving_factors = newest_->moving_factors;
        if (!newest_->moving) factor->fixed = matrix * newest_->fixed, factor->older = newest_->older;
    }
    newest_ = std::move(factor);
}

/// A moving factor starts a new link of the chain; what was before it is shared.
void MovingTransform::concat(MovingFactor moving) {
    auto factor = std::make_shared<Factor>();
    factor->moving_factors = moving_factors() + 1;
    factor->older = std::move(newest_);
    factor->moving = std::move(moving);
    newest_ = std::move(factor);
}

/// Oldest of the newer ones first, each as if it had been given here.
void MovingTransform::concat(const MovingTransform& newer) {
    std::vector<const Factor*> factors;
    for (const Factor* f = newer.newest_.get(); f; f = f->older.get()) factors.push_back(f);
    for (size_t i = factors.size(); i-- > 0;)
        if (factors[i]->moving)
            concat(*factors[i]->moving);
        else
            concat(factors[i]->fixed);
}

/// Newest first, for row vectors: p' = p * newest * ... * oldest.
M44d MovingTransform::at(float time) const {
    if (!newest_) return M44d();
    M44d m = newest_->at(time);
    for (const Factor* f = newest_->older.get(); f; f = f->older.get()) m = m * f->at(time);
    return m;
}

/// Fixed factors never move, so that a still scene costs a walk along a chain of one.
bool MovingTransform::moves_between(float open, float close) const {
    for (const Factor* f = newest_.get(); f; f = f->older.get())
        if (f->moving && f->moving->moves_between(open, close)) return true;
    return false;
}

/// Scales and translations alone move every point along a line, at a steady speed within a segment.
bool MovingTransform::may_bend(float open, float close, bool deforms) const {
    int moving = 0;
    for (const Factor* f = newest_.get(); f; f = f->older.get()) {
        if (!f->moving || !f->moving->moves_between(open, close)) continue;
        const TransformKind kind = f->moving->kind;
        if (kind == TransformKind::Rotate || kind == TransformKind::Skew || ++moving > 1) return true;
        if (deforms && kind != TransformKind::Translate) return true;
    }
    return false;
}

std::vector<float> MovingTransform::unmet_times(float open, float close, int keys) const {
    std::vector<float> unmet;
    for (const Factor* f = newest_.get(); f; f = f->older.get())
        if (f->moving && f->moving->moves_between(open, close))
            std::ranges::copy(times_between_keys(f->moving->times, open, close, keys),
                              std::back_inserter(unmet));
    std::ranges::sort(unmet);
    thin_out(unmet);
    return unmet;
}

/// Matrix elements halfway between two keys, against the mean of the keys', relative to the largest.
bool MovingTransform::is_nearly_linear(float open, float close, int keys) const {
    const auto segment = static_cast<double>(close - open) / (keys - 1);
    M44d from = at(open);
    for (int k = 0; k + 1 < keys; ++k) {
        const M44d middle = at(static_cast<float>(open + (k + 0.5) * segment));
        const M44d to = at(static_cast<float>(open + (k + 1) * segment));
        double largest = 0, error = 0;
        for (int i = 0; i < 16; ++i) {
            const double exact = middle[i / 4][i % 4], linear = (from[i / 4][i % 4] + to[i / 4][i % 4]) / 2;
            largest = std::max(largest, std::abs(exact));
            error = std::max(error, std::abs(exact - linear));
        }
        if (error > kLinearTolerance * largest) return false;
        from = to;
    }
    return true;
}

/// The most that any of its motions wants, and more while their product bends.
int MovingTransform::wanted_keys(float open, float close) const {
    int keys = 1, moving = 0;
    for (const Factor* f = newest_.get(); f; f = f->older.get()) {
        if (!f->moving || !f->moving->moves_between(open, close)) continue;
        ++moving;
        keys = std::max(keys, keys_meeting(f->moving->times, open, close));
        const float degrees = f->moving->fastest_turn(open, close);
        while (keys < kMaxKeyCount && degrees / static_cast<float>(keys - 1) > kDegreesPerSegment)
            keys = 2 * keys - 1;
    }
    // The product of several motions bends even when each is straight.
    while (moving > 1 && keys < kMaxKeyCount && !is_nearly_linear(open, close, keys)) keys = 2 * keys - 1;
    return keys;
}

std::vector<float> times_between_keys(const std::vector<float>& times, float open, float close, int keys) {
    std::vector<float> between;
    std::optional<int> last;
    for (size_t i = 0; i < times.size(); ++i) {
        const bool is_within = times[i] > open && times[i] < close;
        const std::optional<int> key = is_within ? key_of(times[i], open, close, keys)
                                                 : std::optional<int>(times[i] < close ? 0 : keys - 1);
        // Of two times at one key something happens between them.
        if (is_within && (!key || key == last)) between.push_back(times[i]);
        if (times[i] >= close) {
            if (i > 0 && times[i - 1] > open && times[i - 1] < close && key == last)
                between.push_back(times[i - 1]);
            break;
        }
        last = key;
    }
    thin_out(between);
    return between;
}

int keys_meeting(const std::vector<float>& times, float open, float close) {
    for (int keys = 2; keys < kMostKeysForTimes; keys = 2 * keys - 1)
        if (times_between_keys(times, open, close, keys).empty()) return keys;
    return kMostKeysForTimes;
}

}  // namespace trapeze::rib
