#!/usr/bin/env python3
"""Writes still_life.rib: glass and metal on a stone table under a soft light, lights of a town far behind.

    make_still_life.py > still_life.rib

World space is left-handed: x right, y up, z away from the camera; the table is at y = 0, units are decimetres. Every
reflection, refraction and shadow is traced.
"""

import math
import random

FOCUS = 9.1  # the rim of the glass


def fmt(value):
    text = f"{value:.4g}"
    return "0" if text == "-0" else text


def lathe(profile, sides=16):
    """A surface of revolution about y as a subdivision mesh: a profile of (radius, height, sharpness of its ring)."""
    points, faces, creases = [], [], []
    for radius, height, _ in profile:
        for i in range(sides):
            angle = -2 * math.pi * i / sides
            points += [radius * math.cos(angle), height, radius * math.sin(angle)]
    for ring in range(len(profile) - 1):
        for i in range(sides):
            a, b = ring * sides + i, ring * sides + (i + 1) % sides
            faces.append((a, b, b + sides, a + sides))
    for ring, (_, _, sharpness) in enumerate(profile):
        if sharpness > 0:
            creases.append(([ring * sides + i % sides for i in range(sides + 1)], sharpness))
    tags = " ".join(['"interpolateboundary"'] + ['"crease"'] * len(creases))
    counts = " ".join(["0 0"] + [f"{len(ids)} 1" for ids, _ in creases])
    integers = " ".join(str(i) for ids, _ in creases for i in ids)
    return (
        f'SubdivisionMesh "catmull-clark" [{" ".join(["4"] * len(faces))}]\n'
        f'  [{" ".join(str(i) for face in faces for i in face)}]\n'
        f'  [{tags}] [{counts}] [{integers}] [{" ".join(fmt(s) for _, s in creases)}]\n'
        f'  "P" [{" ".join(fmt(c) for c in points)}]'
    )


# From the middle of the foot's underside up the outside, over the rim, down the inside: thick glass.
WINE_GLASS = [
    (.001, 0, 0), (.35, 0, 0), (.74, 0, 2), (.76, .03, 2), (.3, .1, 0), (.1, .2, 0), (.075, .6, 0), (.08, 1.1, 0),
    (.16, 1.3, 0), (.55, 1.55, 0), (.8, 2.05, 0), (.78, 2.7, 0), (.64, 3.25, 1), (.615, 3.25, 1), (.75, 2.7, 0),
    (.765, 2.05, 0), (.52, 1.62, 0), (.2, 1.42, 0), (.001, 1.38, 0),
]
# A little beneath the glass' inside, so that no two surfaces coincide.
WINE = [(.001, 1.41, 0), (.2, 1.45, 0), (.51, 1.65, 0), (.745, 2.05, 0), (.75, 2.2, 4), (.4, 2.2, 0), (.001, 2.2, 0)]
BOWL = [
    (.001, .04, 0), (.4, .05, 0), (.42, 0, 2), (.5, 0, 2), (.55, .08, 0), (1.1, .4, 0), (1.32, .95, 2), (1.26, .95, 2),
    (1.02, .44, 0), (.5, .15, 0), (.001, .13, 0),
]

HEAD = """##RenderMan RIB
# A still life of glass and metal; made by make_still_life.py.
# Right: a wine glass, half full, in focus; its rim and stem are bright at their edges, the table and the lights are seen
# through it upside down. A gold teapot left of it, a chrome ball and a bowl of copper with glass marbles in front. All
# stand in soft shadows and are mirrored in the polished stone. Far behind lights out of focus, hexagons.
Option "searchpath" "string shader" ["shaders:&"]
Option "trace" "int maxdepth" [8]
Display "still_life.exr" "openexr" "rgba"
Format 1280 720 1
PixelSamples 16 16
PixelFilter "gaussian" 2 2
ShadingInterpolation "smooth"
ShadingRate 1
Projection "perspective" "fov" [28]
DepthOfField 2.4 .6 %s
Hider "hidden" "float[4] aperture" [6 12 0 0]
Imager "glow" "float amount" [.12] "float size" [.015] "float threshold" [1.2]
Rotate -11 1 0 0
Translate -.25 -2.95 8.9
WorldBegin
Attribute "visibility" "int diffuse" [1] "int specular" [1] "int transmission" [1]
Attribute "trace" "int maxspeculardepth" [8]
"""

LIGHTS = """
# A soft light above to the left, which reflections see too, a weak one from the right, and a dim sky.
AttributeBegin
  Translate -5 7.5 -1
  Rotate 55 0 0 1
  Rotate 90 1 0 0
  Scale 5 4 1
  Light "PxrRectLight" "key" "float intensity" [17] "color lightColor" [1 .93 .84] "int fixedSampleCount" [16]
AttributeEnd
AttributeBegin
  Attribute "visibility" "int camera" [0] "int diffuse" [0] "int transmission" [0]
  Translate -5 7.5 -1
  Rotate 55 0 0 1
  Surface "constant"
  Color 17 15.8 14.3
  Polygon "P" [-2.5 0 -2  2.5 0 -2  2.5 0 2  -2.5 0 2]
AttributeEnd
AttributeBegin
  Attribute "visibility" "int camera" [0] "int diffuse" [0] "int transmission" [0]
  Translate 7 4 1
  Rotate -75 0 0 1
  Surface "constant"
  Color .9 1.1 1.6
  Polygon "P" [-3 0 -.7  3 0 -.7  3 0 .7  -3 0 .7]
AttributeEnd
# What mirrors see where nothing is: a dusky sky.
AttributeBegin
  Attribute "visibility" "int camera" [0] "int diffuse" [0] "int transmission" [0]
  Surface "constant"
  Color .10 .12 .17
  Sphere 95 -95 95 360
AttributeEnd
Light "PxrDomeLight" "sky" "color lightColor" [.10 .12 .17] "int fixedSampleCount" [4]
"""


def town():
    """The lights behind: small bright balls before a wall of night."""
    rng = random.Random(5)
    lines = ["AttributeBegin", '  Attribute "visibility" "int diffuse" [0] "int transmission" [0]', '  Surface "constant"']
    lines += [
        "  Color .006 .009 .02",
        '  Polygon "P" [-90 -30 90  90 -30 90  90 60 90  -90 60 90]',
    ]
    for _ in range(110):
        x, z = rng.uniform(-26, 26), rng.uniform(34, 60)
        y = .2 + rng.expovariate(.35) - 2
        warm = rng.random()
        color = (1, .5 + .3 * rng.random(), .15 + .2 * rng.random()) if warm < .7 else (.35, .6, 1) if warm < .9 else (1, .2, .12)
        bright = 9 * math.exp(rng.gauss(0, .6))
        radius = .11
        lines.append(
            f"  AttributeBegin Color {' '.join(fmt(bright * c) for c in color)} "
            f"Translate {fmt(x)} {fmt(y)} {fmt(z)} Sphere {radius} {-radius} {radius} 360 AttributeEnd"
        )
    return "\n".join(lines + ["AttributeEnd"])


def main():
    print(HEAD % fmt(FOCUS) + LIGHTS)
    print(town())
    print("""
AttributeBegin
  Surface "tabletop"
  Patch "bilinear" "P" [-14 0 -7  14 0 -7  -14 0 9  14 0 9]
AttributeEnd""")
    print('AttributeBegin\n  Attribute "identifier" "name" ["wine glass"]\n  Translate .75 0 .2')
    print('  Surface "clear_glass" "float eta" [1.45]')
    print('  Attribute "shade" "string transmissionhitmode" ["primitive"]\n  Opacity .25 .25 .25')
    print(lathe(WINE_GLASS))
    print('  Color .6 .02 .04\n  Opacity .55 .8 .8')
    print('  Surface "clear_glass" "float eta" [1.05] "color tint" [.5 .03 .05]')
    print(lathe(WINE))
    print("AttributeEnd")
    print("""AttributeBegin
  Translate -1.9 0 1.5
  Rotate -35 0 1 0
  Rotate -90 1 0 0
  Scale .62 .62 .62
  Color 1 .71 .29
  Surface "polished_metal"
  Geometry "teapot"
AttributeEnd
AttributeBegin
  Translate 2.75 .55 -.75
  Color .95 .96 1
  Surface "polished_metal"
  Sphere .55 -.55 .55 360
AttributeEnd
AttributeBegin
  Translate -1.3 0 -1.6
  Color .95 .48 .32
  Scale .8 .8 .8
  Surface "polished_metal" "float samples" [4] "float blur" [.06]""")
    print(lathe(BOWL))
    print("AttributeEnd")
    marbles = [(-1.3, .38, -1.6, .27, (.35, .8, .55)), (-1.85, .47, -1.5, .25, (.9, .75, .3)), (-.85, .47, -1.85, .24, (.45, .6, .95)),
               (-1.35, .5, -1.05, .26, (.95, .4, .45)), (-1.4, .5, -2.1, .22, (.9, .9, .9)), (.45, .26, -1.9, .26, (.5, .85, .9))]
    for x, y, z, radius, (r, g, b) in marbles:
        print(f'AttributeBegin Translate {x} {y} {z} Opacity .3 .3 .3\n'
              f'  Attribute "shade" "string transmissionhitmode" ["primitive"]\n'
              f'  Surface "clear_glass" "color tint" [{r} {g} {b}]\n'
              f'  Sphere {radius} {-radius} {radius} 360\nAttributeEnd')
    print("WorldEnd")


main()
