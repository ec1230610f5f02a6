#!/usr/bin/env python3
"""Writes a herd to standard output: instances of one animal of 180 faces, on a floor, lit by occlusion.

herd.py SIDE [turn]: SIDE x SIDE animals; with "turn" each turns by 30 degrees while the shutter is open, for
rays as well. The scene reads scenes/gallery/spot_mesh.rib.
"""
import pathlib
import random
import sys

GALLERY = pathlib.Path(__file__).resolve().parents[2] / "scenes/gallery"
APART = 1.8
HEAD = """Option "searchpath" "archive" ["{gallery}"]
Display "herd.exr" "openexr" "rgba"
Format 640 360 1
PixelSamples 2 2
Projection "perspective" "fov" [35]
Shutter 0 1
Rotate -12 1 0 0
Translate 0 -4 0
WorldBegin
ShadingInterpolation "smooth"
Attribute "visibility" "int diffuse" 1 "int specular" 1 "int transmission" 1
Attribute "trace" "int samplemotion" {turns}
LightSource "distantlight" 2 "intensity" [.7] "from" [-.55 .75 -.45] "to" [0 0 0]
LightSource "occlusionlight" 1 "samples" 16 "intensity" .8
Surface "plastic"
ObjectBegin 1
ReadArchive "spot_mesh.rib"
ObjectEnd
AttributeBegin
Color .5 .6 .4
Patch "bilinear" "P" [-20 0 40 20 0 40 -20 0 6 20 0 6]
AttributeEnd"""


def animal(draw, column, row, side, turns):
    x = (column - side / 2) * APART + draw.uniform(-0.3, 0.3)
    z = 8 + row * APART + draw.uniform(-0.3, 0.3)
    angle = draw.uniform(0, 360)
    color = " ".join(f"{draw.uniform(0.3, 1):.3g}" for _ in range(3))
    turn = f"Rotate {angle:.6g} 0 1 0"
    if turns:
        turn = f"MotionBegin [0 1] {turn} Rotate {angle + 30:.6g} 0 1 0 MotionEnd"
    return f"AttributeBegin Color [{color}] Translate {x:.6g} .74 {z:.6g} {turn} ObjectInstance 1 AttributeEnd"


def main():
    side, turns = int(sys.argv[1]), "turn" in sys.argv[2:]
    draw = random.Random(3)
    print(HEAD.format(gallery=GALLERY, turns=int(turns)))
    for column in range(side):
        for row in range(side):
            print(animal(draw, column, row, side, turns))
    print("WorldEnd")


if __name__ == "__main__":
    main()
