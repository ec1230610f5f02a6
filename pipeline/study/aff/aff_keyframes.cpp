#include "pipeline/study/aff/aff_keyframes.h"

#include <limits>

namespace trapeze {
namespace {

constexpr int kMostKeys = std::numeric_limits<int>::max();  ///< the file's end will tell
constexpr int kFewestSplineKeys = 4;

/// A key's time, which must not be before that of the key before.
template <class Key>
double read_key_time(AffWords& words, const std::vector<Key>& before) {
    const double time = words.number("a key's time");
    if (!before.empty() && time < before.back().time)
        words.fail("the time of a key is before that of the key before");
    return time;
}

/// time, value, degrees of rotations alone, tension, continuity, bias.
std::vector<AffKey> read_spline_keys(AffWords& words, bool are_rotations) {
    std::vector<AffKey> keys;
    const int count = words.integer("a count of keys", kFewestSplineKeys, kMostKeys);
    for (int i = 0; i < count && !words.failed(); ++i) {
        AffKey key;
        key.time = read_key_time(words, keys);
        key.value = words.vector("a key's value");
        if (are_rotations) key.degrees = words.number("an angle");
        key.tension = words.number("a tension");
        key.continuity = words.number("a continuity");
        key.bias = words.number("a bias");
        keys.push_back(key);
    }
    return keys;
}

std::vector<AffVisibilityKey> read_visibility_keys(AffWords& words) {
    std::vector<AffVisibilityKey> keys;
    const int count = words.integer("a count of keys", 1, kMostKeys);
    for (int i = 0; i < count && !words.failed(); ++i) {
        const double time = read_key_time(words, keys);
        keys.push_back({time, words.integer("0 or 1", 0, 1) != 0});
    }
    return keys;
}

/// Of one kind, named by `kind`.
void read_motion(AffWords& words, std::string_view kind, AffAnimation* animation) {
    if (kind == "visibility") {
        animation->visible = visible_spans(read_visibility_keys(words));
        return;
    }
    if (kind != "transl" && kind != "scale" && kind != "rot")
        return words.fail_on("transl, rot, scale, visibility or } expected, and not", kind);
    const std::vector<AffKey> keys = read_spline_keys(words, kind == "rot");
    if (words.failed()) return;
    if (kind == "rot")
        animation->rotation.emplace(keys);
    else
        (kind == "scale" ? animation->scale : animation->translation).emplace(keys);
}

}  // namespace

AffAnimation read_keyframes(AffWords& words) {
    AffAnimation animation;
    words.expect("{");
    while (!words.failed()) {
        const std::string_view kind = words.word("transl, rot, scale, visibility or }");
        if (kind == "}") break;
        if (!words.failed()) read_motion(words, kind, &animation);
    }
    return animation;
}

}  // namespace trapeze
