/// RIB of many small requests, kind by kind, for rib_bench.
#include "tests/bench/small_requests.h"

#include <cstdio>

namespace trapeze::bench {
namespace {

/// So many pieces of text, each made by its number.
template <class Piece>
std::string repeated(int count, Piece&& piece) {
    std::string text;
    for (int i = 0; i < count; ++i) text += piece(i);
    return text;
}

/// A piece of text with some numbers that change from piece to piece.
template <class... Values>
std::string formatted(const char* format, Values... values) {
    char text[1024];
    std::snprintf(text, sizeof text, format, values...);
    return text;
}

/// A number that is written with so many decimals, and differs from piece to piece.
double number(int i, int k = 0) {
    return ((i * 7919 + k * 104729) % 100000) * 1e-4 - 3;
}

std::string blocks() {
    return repeated(100000,
                    [](int) { return "AttributeBegin\nTransformBegin\nTransformEnd\nAttributeEnd\n"; });
}

std::string comments() {
    return repeated(100000,
                    [](int i) { return formatted("# object number %d of the scene follows here\n", i); });
}

/// Each in a block of its own, and taken by a primitive.
std::string colors() {
    return repeated(50000, [](int i) {
        return formatted(
            "AttributeBegin\nColor [%.4f 0.5 0.25]\nOpacity 1 %.4f 1\nShadingRate 2\nSides 1\n"
            "Sphere 1 -1 1 360\nAttributeEnd\n",
            number(i) + 3, number(i, 1) + 3);
    });
}

std::string transforms() {
    return repeated(50000, [](int i) {
        return formatted(
            "TransformBegin\nTranslate %.4f 0.5 -1.25\nRotate %.4f 0 1 0\nScale 1 1 %.4f\n"
            "ConcatTransform [1 0 0 0  0 1 0 0  0 0 1 0  %.4f %.4f %.4f 1]\nTransformEnd\n",
            number(i), number(i, 1), number(i, 2) + 4, number(i, 3), number(i, 4), number(i, 5));
    });
}

std::string shaders() {
    return repeated(50000, [](int i) {
        return formatted(
            "Surface \"plastic\" \"Kd\" [%.4f] \"uniform float roughness\" [0.1] "
            "\"color specularcolor\" [1 1 %.4f]\nSphere 1 -1 1 360\n",
            number(i) + 3, number(i, 1) + 3);
    });
}

std::string user_attributes() {
    return repeated(50000, [](int i) {
        return formatted(
            "AttributeBegin\nAttribute \"identifier\" \"name\" [\"thing%d\"]\n"
            "Attribute \"visibility\" \"int diffuse\" [1] \"int specular\" [1]\n"
            "Disk %.4f 1 360\nAttributeEnd\n",
            i, number(i));
    });
}

std::string quadrics() {
    return repeated(50000, [](int i) {
        return formatted("Sphere %.4f -1 1 360\nCylinder 1 -1 %.4f 360\nTorus 1 %.4f 0 360 360\n",
                         number(i) + 4, number(i, 1), number(i, 2) + 4);
    });
}

std::string polygons() {
    return repeated(50000, [](int i) {
        return formatted("Polygon \"P\" [%.4f 0 0 1 %.4f 0 1 1 %.4f] \"Cs\" [1 0 0 0 1 0 0 0 1]\n", number(i),
                         number(i, 1), number(i, 2));
    });
}

std::string patches() {
    return repeated(50000, [](int i) {
        return formatted(
            "Patch \"bilinear\" \"P\" [%.4f 0 0 1 0 %.4f 0 1 0 1 1 %.4f] \"st\" [0 0 1 0 0 1 1 1]\n",
            number(i), number(i, 1), number(i, 2));
    });
}

std::string points_polygons() {
    return repeated(50000, [](int i) {
        return formatted(
            "PointsPolygons [3 3] [0 1 2 2 1 3] \"vertex point P\" [%.4f 0 0 1 0 %.4f 0 1 0 1 1 %.4f]\n",
            number(i), number(i, 1), number(i, 2));
    });
}

std::string curves() {
    return repeated(50000, [](int i) {
        return formatted(
            "Curves \"cubic\" [4] \"nonperiodic\" \"P\" [%.4f 0 0 0 1 %.4f 0 2 0 %.4f 3 0] "
            "\"varying float width\" [0.02 0.01]\n",
            number(i), number(i, 1), number(i, 2));
    });
}

std::string points() {
    return repeated(50000, [](int i) {
        return formatted("Points \"P\" [%.4f 0 0 1 %.4f 0] \"constantwidth\" [0.05]\n", number(i),
                         number(i, 1));
    });
}

std::string instances() {
    return "ObjectBegin 1\nSphere 1 -1 1 360\nObjectEnd\n" + repeated(50000, [](int i) {
               return formatted("TransformBegin\nTranslate %.4f 0 %.4f\nObjectInstance 1\nTransformEnd\n",
                                number(i), number(i, 1));
           });
}

std::string moving() {
    return repeated(50000, [](int i) {
        return formatted(
            "TransformBegin\nMotionBegin [0 1]\nTranslate %.4f 0 0\nTranslate 0 %.4f 0\nMotionEnd\n"
            "Sphere 1 -1 1 360\nTransformEnd\n",
            number(i), number(i, 1));
    });
}

/// A scene of objects such as exporters write: what all of the others have, a piece of each.
std::string mixed() {
    return "ObjectBegin 1\nSphere 1 -1 1 360\nObjectEnd\n" + repeated(20000, [](int i) {
               return formatted(
                          "# object %d\nAttributeBegin\n  Attribute \"identifier\" \"name\" [\"thing%d\"]\n"
                          "  Color [%.4f 0.5 0.25]\n  Surface \"plastic\" \"Kd\" [0.5] \"roughness\" [0.1]\n"
                          "  Translate %.4f 0.5 -1.25\n  Rotate 30 0 1 0\n",
                          i, i, number(i) + 3, number(i, 1)) +
                      formatted(
                          "  Sphere 1 -1 1 360\n  Polygon \"P\" [%.4f 0 0 1 %.4f 0 1 1 0]\n"
                          "  Patch \"bilinear\" \"P\" [%.4f 0 0 1 0 0 0 1 0 1 1 0]\n",
                          number(i), number(i, 1), number(i, 2)) +
                      formatted(
                          "  PointsPolygons [3] [0 1 2] \"P\" [%.4f 0 0 1 0 %.4f 0 1 0]\n"
                          "  Curves \"linear\" [2] \"nonperiodic\" \"P\" [%.4f 0 0 0 1 0] \"width\" [.1 .1]\n"
                          "  Points \"P\" [%.4f 0 0]\n  ObjectInstance 1\nAttributeEnd\n",
                          number(i), number(i, 1), number(i, 2), number(i, 3));
           });
}

/// What rib_bench has measured as "small requests" from its beginning.
std::string spheres_with_looks() {
    return repeated(50000, [](int i) {
        return formatted(
            "AttributeBegin\n  Color [%.3f 0.5 0.25]\n  Translate %d 0.5 -1.25\n  Rotate 30 0 1 0\n"
            "  Surface \"plastic\" \"Kd\" [0.5] \"roughness\" [0.1]\n  Sphere 1 -1 1 360\n"
            "AttributeEnd\n",
            i % 100 * 0.01, i);
    });
}

}  // namespace

const std::vector<SmallRequests>& small_request_kinds() {
    static const std::vector<SmallRequests> kinds = {
        {"blocks", blocks},       {"comments", comments},
        {"colors", colors},       {"transforms", transforms},
        {"shaders", shaders},     {"user_attributes", user_attributes},
        {"quadrics", quadrics},   {"polygons", polygons},
        {"patches", patches},     {"points_polygons", points_polygons},
        {"curves", curves},       {"points", points},
        {"instances", instances}, {"moving", moving},
        {"mixed", mixed},         {"spheres_with_looks", spheres_with_looks},
    };
    return kinds;
}

}  // namespace trapeze::bench
