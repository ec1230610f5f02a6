#!/usr/bin/env python3
"""Writes hair.rib: two balls of half transparent hair on a polished marble floor.

    make_hair.py > hair.rib

100,000 hairs [Hou et al. 2010, figure 7a]: each ball is a hundred instances of three tufts of 500 hairs. World space is
left-handed: x right, y up, z away from the camera; the floor is at y = 0, balls have the radius 1 without their hair.
"""

import math
import random

TUFTS, HAIRS, CAPS = 3, 500, 100
LENGTH, WIDTH = .52, .006


def fmt(value):
    text = f"{value:.4g}"
    return "0" if text == "-0" else text


def numbers(values):
    return " ".join(fmt(value) for value in values)


def tuft(seed):
    """Hairs that grow from a cap of the ball about +z, combed a little to one side, each with a curl of its own."""
    rng = random.Random(seed)
    points, widths = [], []
    for _ in range(HAIRS):
        away, turn = .26 * math.sqrt(-math.log(1 - .95 * rng.random())) * .8, 2 * math.pi * rng.random()
        root = (math.sin(away) * math.cos(turn), math.sin(away) * math.sin(turn), math.cos(away))
        bend = (rng.gauss(.28, .2), rng.gauss(0, .2), rng.gauss(0, .1))
        length = LENGTH * rng.uniform(.7, 1.1)
        for k in range(4):
            t = k / 3
            points += [root[i] * (1 + length * t) + bend[i] * length * t * t * 1.3 for i in range(3)]
        widths += [WIDTH * rng.uniform(.8, 1.2), WIDTH * .25]
    return (
        f'Curves "cubic" [{" ".join(["4"] * HAIRS)}] "nonperiodic"\n  "P" [{numbers(points)}]\n'
        f'  "varying float width" [{numbers(widths)}]'
    )


def caps(seed):
    """Instances of tufts all over a ball, evenly: points of a spiral."""
    rng = random.Random(seed)
    lines = []
    for i in range(CAPS):
        y = 1 - 2 * (i + .5) / CAPS
        azimuth = math.degrees(i * math.pi * (3 - math.sqrt(5)))
        tilt = math.degrees(math.acos(y))
        lines.append(
            f"TransformBegin Rotate {fmt(azimuth % 360)} 0 1 0 Rotate {fmt(tilt - 90)} 1 0 0 "
            f"Rotate {fmt(rng.uniform(-60, 60) + 90)} 0 0 1 ObjectInstance {rng.randrange(TUFTS) + 1} TransformEnd"
        )
    return "\n".join(lines)


def ball(place, color, seed):
    return f"""
AttributeBegin
  Translate {place}
  AttributeBegin
    Surface "constant"
    Color {color[1]}
    Attribute "visibility" "int transmission" [1]
    Sphere 1 -1 1 360
  AttributeEnd
  Surface "fur" "color tipcolor" [{color[2]}]
  Color {color[0]}
  Opacity .5 .5 .5
{caps(seed)}
AttributeEnd"""


print("""##RenderMan RIB
# Two balls of half transparent hair on polished marble; made by make_hair.py.
# Right: 100,000 hairs, of which each lets half of the light through: the balls have soft edges where hairs thin out. The
# floor mirrors both, hair by hair; shadows on it are soft and let light through at their rims.
Option "searchpath" "string shader" ["shaders:&"]
Display "hair.exr" "openexr" "rgba"
Format 1280 720 1
PixelSamples 8 8
PixelFilter "gaussian" 2 2
ShadingInterpolation "smooth"
Projection "perspective" "fov" [30]
DepthOfField 4 .5 8.6
Imager "background" "color bgcolor" [.02 .022 .028]
Rotate -10 1 0 0
Translate 0 -2.75 8.9
WorldBegin
LightSource "ambientlight" 1 "intensity" [.12] "lightcolor" [.8 .9 1]
LightSource "distantlight" 2 "intensity" [1] "lightcolor" [1 .95 .86] "from" [-3 5 -3] "to" [0 0 0]
LightSource "distantlight" 3 "intensity" [.35] "lightcolor" [.6 .75 1] "from" [4 2 3] "to" [0 0 0]
Illuminate 2 0""")
for index in range(TUFTS):
    print(f"ObjectBegin {index + 1}\n{tuft(index)}\nObjectEnd")
print("""
# The floor has soft shadows of hairs, which stand for their own opacity there.
AttributeBegin
  AttributeBegin
    Attribute "light" "int nsamples" [12]
    Translate -6 10 2
    Rotate 108 0 1 0
    Rotate 58 1 0 0
    AreaLightSource "arealight" 4 "intensity" [85] "lightcolor" [1 .95 .86]
    Disk 0 1.6 360
  AttributeEnd
  Illuminate 3 0
  Illuminate 4 1
  Surface "polished_marble"
  Attribute "trace" "int maxspeculardepth" [1]
  Patch "bilinear" "P" [-30 0 40  30 0 40  -30 0 -7  30 0 -7]
AttributeEnd

Illuminate 2 1
Attribute "visibility" "int specular" [1] "int transmission" [1]
Attribute "shade" "string transmissionhitmode" ["primitive"]""")
print(ball("-1.55 1.5 .2", ("1 .62 .3", ".12 .05 .02", "1 .85 .6"), 1))
print(ball("1.6 1.5 .9", (".35 .38 .45", ".03 .03 .05", ".85 .9 1"), 2))
print("WorldEnd")
