#include "pipeline/rib/state/declarations.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <vector>

namespace trapeze::rib {
namespace {

/// Inline declarations that are remembered: more than a scene's programmers write, fewer than a program may.
constexpr size_t kMostInline = 4096;

/// In the order of StorageClass.
constexpr std::string_view kStorageNames[] = {"constant", "uniform",     "varying",
                                              "vertex",   "facevarying", "facevertex"};

/// RISpec 5; "facevertex" is PRMan's.
std::optional<StorageClass> storage_named(std::string_view word) {
    const auto* found = std::find(std::begin(kStorageNames), std::end(kStorageNames), word);
    if (found == std::end(kStorageNames)) return {};
    return static_cast<StorageClass>(found - std::begin(kStorageNames));
}

/// Names of RISpec 3.2, and those that exporters write for the same.
std::optional<ValueType> type_named(std::string_view word) {
    if (word == "float") return ValueType::Float;
    if (word == "integer" || word == "int") return ValueType::Integer;
    if (word == "string") return ValueType::String;
    if (word == "color") return ValueType::Color;
    if (word == "point") return ValueType::Point;
    if (word == "vector") return ValueType::Vector;
    if (word == "normal") return ValueType::Normal;
    if (word == "hpoint") return ValueType::HPoint;
    if (word == "matrix" || word == "mpoint") return ValueType::Matrix;  // mpoint: a point's, of blobbies
    return {};
}

/// Words and [n], which may stand apart or together.
std::vector<std::string> words_of(std::string_view text) {
    std::vector<std::string> words;
    std::string word;
    const auto flush = [&] {
        if (!word.empty()) words.push_back(std::move(word));
        word.clear();
    };
    for (const char c : text) {
        if (std::isspace(static_cast<unsigned char>(c))) {
            if (word.empty() || word[0] != '[') flush();
        } else if (c == '[') {
            flush();
            word = "[";
        } else if (c == ']' && !word.empty() && word[0] == '[') {
            word += c;
            flush();
        } else {
            word += c;
        }
    }
    flush();
    return words;
}

/// Class and length may be left out: uniform, 1. Nothing when a word is left over.
std::optional<Declaration> declaration_of(const std::vector<std::string>& words) {
    Declaration declaration;
    size_t i = 0;
    // "reference color tint": the name of another node's output, of RIS.
    const bool is_reference = !words.empty() && words[0] == "reference";
    if (is_reference) ++i;
    if (i < words.size())
        if (const auto storage = storage_named(words[i])) declaration.storage = *storage, ++i;
    if (i >= words.size()) return {};
    const auto type = type_named(words[i++]);
    if (!type) return {};
    declaration.type = *type;
    if (i < words.size() && words[i][0] == '[') {
        const std::string& w = words[i++];
        int length = 0;
        auto [end, error] = std::from_chars(w.data() + 1, w.data() + w.size() - 1, length);
        if (error == std::errc() && *end == '.')  // programs that write all numbers as floats: [ 2.0 ]
            while (*++end == '0') continue;
        if (error != std::errc() || *end != ']' || length < 1 || length > kLongestArray) return {};
        declaration.array_length = length;
    }
    if (i != words.size()) return {};
    if (is_reference) declaration.type = ValueType::String;
    return declaration;
}

/// RISpec, table 5.1: variables of primitives. Of the three forms of points one is left when a primitive is
/// made (primitive_variables.h).
struct Predeclared {
    const char* name;
    Declaration declaration;
};

const Predeclared kPredeclared[] = {
    {"P", {StorageClass::Vertex, ValueType::Point, 1}},
    {"Pz", {StorageClass::Vertex, ValueType::Float, 1}},
    {"Pw", {StorageClass::Vertex, ValueType::HPoint, 1}},
    {"N", {StorageClass::Varying, ValueType::Normal, 1}},
    {"Np", {StorageClass::Uniform, ValueType::Normal, 1}},
    {"Ng", {StorageClass::Varying, ValueType::Normal, 1}},
    {"Cs", {StorageClass::Varying, ValueType::Color, 1}},
    {"Os", {StorageClass::Varying, ValueType::Color, 1}},
    {"s", {StorageClass::Varying, ValueType::Float, 1}},
    {"t", {StorageClass::Varying, ValueType::Float, 1}},
    {"st", {StorageClass::Varying, ValueType::Float, 2}},
    {"width", {StorageClass::Varying, ValueType::Float, 1}},
    {"constantwidth", {StorageClass::Constant, ValueType::Float, 1}},
    {"patchangle", {StorageClass::Varying, ValueType::Float, 1}},
    {"patchaspectratio", {StorageClass::Varying, ValueType::Float, 1}},
};

/// Parameters of RISpec's standard shaders and options, and some that files use as if they were: uniform, of
/// one value.
const char* const kFloats[] = {"Ka",
                               "Kd",
                               "Ks",
                               "Kr",
                               "Km",
                               "roughness",
                               "intensity",
                               "coneangle",
                               "conedeltaangle",
                               "beamdistribution",
                               "mindistance",
                               "maxdistance",
                               "distance",
                               "fov",
                               "amplitude",
                               "frequency",
                               "gain",
                               "gamma",
                               "jitter",
                               "endofframe",
                               "enable gaussian",
                               "enable lerp",
                               "veining"};
/// Colours by their names, likewise; then points, and strings.
const char* const kShaderColors[] = {"specularcolor", "lightcolor", "background", "opacity",
                                     "bgcolor",       "fogcolor",   "color"};
const char* const kShaderPoints[] = {"from", "to"};
const char* const kStrings[] = {"type",           "texturename",  "shadowname",       "mapname",
                                "name",           "archive",      "shader",           "texture",
                                "procedural",     "display",      "resource",         "depthfilter",
                                "filename",       "xmlfilename",  "coordinatesystem", "compression",
                                "displaymapname", "__instanceid", "__category"};

}  // namespace

std::string_view name_of(StorageClass storage) {
    return kStorageNames[static_cast<size_t>(storage)];
}

/// Declare's second argument.
std::optional<Declaration> parse_declaration(std::string_view text) {
    return declaration_of(words_of(text));
}

/// Names of shaders' parameters are RISpec's too, and files use them without declaring them. The names are
/// made once for each reading, so that a scene may declare them anew without an effect on the next.
Declarations::Declarations() {
    const auto add_one = [&](const char* name, const Declaration& declaration) {
        known_[name] = {name, declaration, true};
    };
    for (const Predeclared& entry : kPredeclared) add_one(entry.name, entry.declaration);
    const auto add = [&](const auto& names, ValueType type) {
        for (const char* name : names) add_one(name, {StorageClass::Uniform, type, 1});
    };
    add(kFloats, ValueType::Float);
    add(kShaderColors, ValueType::Color);
    add(kShaderPoints, ValueType::Point);
    add(kStrings, ValueType::String);
    add_one("sphere", {StorageClass::Uniform, ValueType::Float, 1});
}

/// An inline declaration ("uniform color tint") is only looked for where the whole token is no known name:
/// names with a space in them may be declared.
const Declarations::Meaning* Declarations::find(const std::string& token) const {
    if (const auto known = known_.find(token); known != known_.end()) return &known->second;
    if (const auto again = inline_.find(token); again != inline_.end()) return &again->second;
    std::vector<std::string> words = words_of(token);
    if (words.size() < 2) return nullptr;
    std::string name = std::move(words.back());
    words.pop_back();
    const auto declaration = declaration_of(words);
    if (!declaration) return nullptr;
    if (inline_.size() >= kMostInline) inline_.clear();
    return &inline_.emplace(token, Meaning{std::move(name), *declaration, false}).first->second;
}

}  // namespace trapeze::rib
