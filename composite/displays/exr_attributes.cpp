#include "composite/displays/exr_attributes.h"

#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFloatVectorAttribute.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfStringVectorAttribute.h>
#include <OpenEXR/ImfVecAttribute.h>

#include <algorithm>
#include <iterator>
#include <string_view>

namespace trapeze {
namespace {

constexpr size_t kLongestName = 255;  ///< the most that OpenEXR takes

/// Attributes that say how the file's pixels lie, which scenes must not change.
constexpr std::string_view kOfTheFile[] = {
    "channels",           "chunkCount",        "compression", "dataWindow", "displayWindow",    "lineOrder",
    "maxSamplesPerPixel", "multiView",         "name",        "part",       "pixelAspectRatio", "preview",
    "screenWindowCenter", "screenWindowWidth", "tiles",       "type",       "version",          "view"};

/// Erases one of another type first, at which OpenEXR would throw. (It does not free what it erases.)
template <class Attribute, class Value>
void insert(Imf::Header& header, const std::string& name, Value value) {
    const auto known = header.find(name.c_str());
    if (known != header.end() &&
        std::string_view(known.attribute().typeName()) != Attribute::staticTypeName())
        header.erase(name.c_str());
    header.insert(name.c_str(), Attribute(value));
}

/// One to three whole numbers have a type in OpenEXR; more become floats. Values come as floats, and are kept
/// within what an int holds: 2147483520 is the largest float below 2^31.
void insert_integers(Imf::Header& header, const std::string& name, const std::vector<float>& v) {
    const auto whole = [&](size_t i) {
        return static_cast<int>(std::clamp(v[i], -2147483520.0f, 2147483520.0f));
    };
    if (v.size() == 1)
        insert<Imf::IntAttribute>(header, name, whole(0));
    else if (v.size() == 2)
        insert<Imf::V2iAttribute>(header, name, Imath::V2i(whole(0), whole(1)));
    else if (v.size() == 3)
        insert<Imf::V3iAttribute>(header, name, Imath::V3i(whole(0), whole(1), whole(2)));
    else
        insert<Imf::FloatVectorAttribute>(header, name, v);
}

void insert_floats(Imf::Header& header, const std::string& name, const std::vector<float>& v) {
    if (v.size() == 1)
        insert<Imf::FloatAttribute>(header, name, v[0]);
    else if (v.size() == 2)
        insert<Imf::V2fAttribute>(header, name, Imath::V2f(v[0], v[1]));
    else if (v.size() == 3)
        insert<Imf::V3fAttribute>(header, name, Imath::V3f(v[0], v[1], v[2]));
    else if (v.size() == 16)
        insert<Imf::M44fAttribute>(header, name,
                                   Imath::M44f(v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8], v[9],
                                               v[10], v[11], v[12], v[13], v[14], v[15]));
    else
        insert<Imf::FloatVectorAttribute>(header, name, v);
}

}  // namespace

std::string problem_of_attribute(const Parameter& attribute) {
    const std::string& name = attribute.name;
    const auto is_plain = [](unsigned char c) { return c >= 32 && c < 127; };
    if (name.empty() || name.size() > kLongestName || !std::all_of(name.begin(), name.end(), is_plain))
        return "is no name of an attribute";
    if (std::find(std::begin(kOfTheFile), std::end(kOfTheFile), name) != std::end(kOfTheFile))
        return "says how the file's pixels lie, which is settled";
    return attribute.strings.empty() && attribute.floats.empty() ? "has no value" : "";
}

void add_attributes(Imf::Header& header, const std::vector<Parameter>& attributes) {
    for (const Parameter& attribute : attributes) {
        if (attribute.strings.size() == 1)
            insert<Imf::StringAttribute>(header, attribute.name, attribute.strings[0]);
        else if (attribute.is_string())
            insert<Imf::StringVectorAttribute>(header, attribute.name, attribute.strings);
        else if (attribute.declaration.type == ValueType::Integer)
            insert_integers(header, attribute.name, attribute.floats);
        else
            insert_floats(header, attribute.name, attribute.floats);
    }
}

}  // namespace trapeze
