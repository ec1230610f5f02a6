#!/usr/bin/env python3
"""Writes studio.rib: a still life of the standard shaders under three shadow-mapped lights.

    make_studio.py > studio.rib

Rendering writes a score of files beside the picture into the working folder.

The file makes all that it looks up: frames 1 and 2 draw a glaze and a relief, 3 to 8 the six views of an environment
map, 9 to 11 the lights' depth maps; frame 12 is the picture. World space is left-handed: x right, y up, z away
from the camera, the floor at y = 0. All colours are linear.
"""

import math

EYE, AT, FOV = (0.3, 4.3, -14.0), (0.1, 1.32, 0.6), 24.5
CENTRE = (0.9, 1.2, -1.6)  # of the environment map
FACE_PIXELS, DEPTH_PIXELS = 384, 1024

# handle, from, to, cone in degrees, intensity, colour, blur of the shadow
LIGHTS = [
    (1, (-6.5, 9.0, -6.5), (-0.2, 0.6, 0.6), 34, 245, (1.0, 0.87, 0.70), 0.016),
    (2, (9.0, 5.5, -7.5), (0.4, 0.8, 0.6), 30, 58, (0.60, 0.76, 1.0), 0.040),
    (3, (3.5, 8.5, 9.5), (0.0, 0.8, 0.4), 33, 120, (1.0, 0.92, 0.82), 0.014),
]
# What the lights would look like, for reflections: middle, half width, half height, brightness.
SOFTBOXES = [
    ((-6.5, 7.5, -6.5), 2.4, 1.6, (7.0, 6.2, 5.2)),
    ((9.0, 5.0, -7.5), 1.2, 2.6, (2.4, 2.9, 3.6)),
    ((2.5, 9.0, 6.0), 3.0, 0.8, (4.6, 4.4, 4.2)),
]


def fmt(value):
    text = f"{value:.5g}"
    return "0" if text == "-0" else text


def vec(values):
    return " ".join(fmt(v) for v in values)


def add(a, b, scale=1.0):
    return tuple(x + scale * y for x, y in zip(a, b))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    return tuple(x / math.sqrt(dot(a, a)) for x in a)


def view(eye, forward, up=(0.0, 1.0, 0.0)):
    """camera_from_world, for row vectors."""
    z = unit(forward)
    x = unit(cross(up, z))
    y = cross(z, x)
    rows = [(x[i], y[i], z[i], 0) for i in range(3)] + [(-dot(eye, x), -dot(eye, y), -dot(eye, z), 1)]
    return "ConcatTransform [" + "  ".join(vec(row) for row in rows) + "]"


def emit(text):
    print(text.strip("\n"))


def lathe(profile, around=16):
    """A b-spline mesh turned about y, from the top (t = 0) down; the profile is (radius, height) pairs."""
    ends = [profile[0]] * 2 + list(profile) + [profile[-1]] * 2
    points = []
    for radius, height in ends:
        for k in range(around):
            angle = 2 * math.pi * k / around
            points.append((radius * math.cos(angle), height, radius * math.sin(angle)))
    flat = " ".join(vec(p) for p in points)
    return (
        'Basis "b-spline" 1 "b-spline" 1\n'
        f'PatchMesh "bicubic" {around} "periodic" {len(ends)} "nonperiodic" "P" [{flat}]'
    )


def block(sharpness):
    """A cube from -1 to 1 with soft edges."""
    corners = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    edges = [(a, b) for a in range(8) for b in range(a + 1, 8) if bin(a ^ b).count("1") == 1]
    tags = " ".join('"crease"' for _ in edges)
    counts = " ".join("2 1" for _ in edges)
    integers = "  ".join(f"{a} {b}" for a, b in edges)
    return (
        f'SubdivisionMesh "catmull-clark" [{" ".join("4" for _ in faces)}]\n'
        f'  [{"  ".join(" ".join(map(str, f)) for f in faces)}]\n'
        f"  [{tags}] [{counts}]\n  [{integers}] [{' '.join(fmt(sharpness) for _ in edges)}]\n"
        f'  "P" [{"  ".join(vec(c) for c in corners)}]'
    )


def polygon(points, color):
    emit(f'Color [{vec(color)}]\nPolygon "P" [{"  ".join(vec(p) for p in points)}]')


def disk(x, y, z, radius, color):
    emit(f"Color [{vec(color)}]\nTransformBegin\nTranslate {vec((x, y, z))}\nDisk 0 {fmt(radius)} 360\nTransformEnd")


def rectangle(x0, y0, x1, y1, z, color):
    polygon([(x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z)], color)


def flat_frame(number, name, width, height, what):
    emit(f"""
FrameBegin {number}
Format {width} {height} 1
PixelSamples 4 4
PixelFilter "gaussian" 2 2
Projection "orthographic"
ScreenWindow 0 1 0 1
Display "{name}" "openexr" "rgb"
WorldBegin
Surface "constant"
ShadingRate 4
""")
    what()
    emit("WorldEnd\nFrameEnd")


def glaze():
    """Bands of majolica: s runs around the vase four times, y = 1 is its rim."""
    cream, blue, ochre, rust = (0.80, 0.72, 0.55), (0.02, 0.07, 0.30), (0.65, 0.30, 0.04), (0.36, 0.06, 0.03)
    rectangle(0, 0, 1, 1, 9, cream)
    for y0, y1, color in [(0.93, 1.0, blue), (0.885, 0.905, rust), (0.60, 0.63, blue), (0.555, 0.575, ochre),
                          (0.27, 0.29, ochre), (0.22, 0.25, blue), (0.0, 0.07, blue)]:
        rectangle(0, y0, 1, y1, 8, color)
    for k in range(4):  # leaves below the rim
        x = k / 4
        polygon([(x, 0.65, 7), (x + 0.125, 0.87, 7), (x + 0.25, 0.65, 7)], blue)
        polygon([(x + 0.06, 0.66, 6), (x + 0.125, 0.78, 6), (x + 0.19, 0.66, 6)], ochre)
        disk(x, 0.82, 6, 0.028, rust), disk(x + 0.25, 0.82, 6, 0.028, rust)
    for k in range(2):  # suns on the belly
        x = 0.25 + k / 2
        for ray in range(12):
            angle = 2 * math.pi * ray / 12
            tip = (x + 0.12 * math.cos(angle), 0.42 + 0.12 * math.sin(angle), 7)
            side = 0.16
            left = (x + 0.06 * math.cos(angle + side), 0.42 + 0.06 * math.sin(angle + side), 7)
            right = (x + 0.06 * math.cos(angle - side), 0.42 + 0.06 * math.sin(angle - side), 7)
            polygon([left, tip, right], rust)
        disk(x, 0.42, 6, 0.072, ochre), disk(x, 0.42, 5, 0.05, cream), disk(x, 0.42, 4, 0.032, blue)
        disk(x + 0.25, 0.42, 6, 0.045, blue), disk(x + 0.25, 0.42, 5, 0.028, cream)
    for k in range(16):  # scales at the foot
        disk((k + 0.5) / 16, 0.145, 7, 0.028, blue if k % 2 else rust)


def relief():
    """Studs, four by two to a picture."""
    rectangle(0, 0, 1, 1, 9, (0, 0, 0))
    for i in range(4):
        for j in range(2):
            x, y = (i + 0.5 + 0.25 * (-1) ** j) / 4, (j + 0.5) / 2
            for wrapped in (x - 1, x, x + 1):
                for ring in range(10):
                    radius = 1 - ring / 10
                    height = math.sqrt(1 - radius * radius)
                    emit(f"TransformBegin\nTranslate {vec((wrapped, y, 8 - ring * 0.1))}\nScale 0.095 0.19 1")
                    emit(f"Color [{vec((height,) * 3)}]\nDisk 0 {fmt(radius)} 360\nTransformEnd")


def thing(x, y, z, turn, surface, shape, color=(1, 1, 1), more=""):
    emit(f"""
AttributeBegin
Color [{vec(color)}]
Translate {vec((x, y, z))}
Rotate {fmt(turn)} 0 1 0
{surface}
{more}
{shape}
AttributeEnd
""".replace("\n\n", "\n"))


VASE = [(0.30, 2.70), (0.44, 2.68), (0.40, 2.55), (0.30, 2.35), (0.30, 2.15), (0.55, 1.90), (0.86, 1.50),
        (0.90, 1.10), (0.72, 0.65), (0.46, 0.30), (0.40, 0.14), (0.48, 0.02), (0.48, 0.0)]
PAWN = [(0.0, 3.0), (0.24, 3.0), (0.48, 2.82), (0.52, 2.45), (0.34, 2.16), (0.24, 2.10), (0.60, 2.02), (0.60, 1.92),
        (0.28, 1.86), (0.30, 1.40), (0.42, 0.90), (0.62, 0.62), (0.62, 0.50), (0.90, 0.42), (0.98, 0.24), (0.90, 0.0)]
GOBLET = [(0.50, 1.46), (0.58, 1.50), (0.60, 1.44), (0.62, 1.15), (0.52, 0.85), (0.22, 0.68), (0.10, 0.60), (0.20, 0.52),
          (0.09, 0.44), (0.09, 0.24), (0.24, 0.10), (0.46, 0.05), (0.48, 0.0)]
PLINTH = 0.6  # height of what the back row stands on


def ball(radius):
    return f"Rotate -90 1 0 0\nSphere {fmt(radius)} {fmt(-radius)} {fmt(radius)} 360"


def bound(radius):
    return f'Attribute "displacementbound" "sphere" [{fmt(radius)}] "coordinatesystem" ["shader"]'


def solid(surface, origin):
    """A surface whose shader space has another origin than the thing's."""
    return f"TransformBegin\nTranslate {vec(origin)}\n{surface}\nTransformEnd"


def backdrop():
    """The floor, curving up into a wall."""
    sweep = [(-30.0, 0.0), (-12.0, 0.0), (5.5, 0.0)]
    for k in range(1, 6):
        angle = math.pi / 2 * k / 6
        sweep.append((5.5 + 4.0 * math.sin(angle), 4.0 - 4.0 * math.cos(angle)))
    sweep += [(9.5, 4.0), (9.5, 14.0), (9.5, 24.0)]
    points = " ".join(f"{x} {fmt(y)} {fmt(z)}" for z, y in sweep for x in (-66, -22, 22, 66))
    emit(f"""
AttributeBegin
Surface "matte" "Ka" [1] "Kd" [.9]
Color [.25 .32 .37]
ShadingRate 4
Basis "b-spline" 1 "b-spline" 1
PatchMesh "bicubic" 4 "nonperiodic" {len(sweep)} "nonperiodic" "P" [{points}]
AttributeEnd
""")


def props():
    backdrop()
    thing(0, 0.3, 2.9, 90, solid('Surface "wood" "float ringscale" [5] "float txtscale" [.8] "Ks" [.3]', (0.5, -1.1, 2)),
          "Scale 1.35 .3 6.1\n" + block(3.4))
    brick = ('Surface "brick" "float sscale" [3.2] "float tscale" [1.6] "float brickwidth" [.25] "float brickheight" [.09] '
             '"float mortarthickness" [.014]')
    thing(-4.35, PLINTH, 2.9, 20, brick, "Rotate -90 1 0 0\nCylinder .78 0 1.75 360")
    thing(-4.35, PLINTH + 1.83, 2.9, 0, 'Surface "granite" "float txtscale" [1.2] "Ks" [.2]', "Scale .98 .09 .98\n" + block(2.2))
    thing(-4.35, PLINTH + 2.45, 2.9, 0, 'Surface "matte"', "Rotate -90 1 0 0\nScale 1 1 .85\nSphere .62 -.62 .62 360",
          (0.50, 0.44, 0.36),
          'Displacement "fractal" "float amplitude" [.34] "float frequency" [1.9] "float octaves" [7]\n' + bound(0.5))
    thing(-1.55, PLINTH, 2.9, 35,
          'Surface "paintedplastic" "texturename" ["studio_glaze.tex"] "Kd" [.8] "Ks" [.45] "roughness" [.48]', lathe(VASE))
    thing(1.35, PLINTH, 2.9, 60, 'Surface "marble" "float txtscale" [.85] "float veinfreq" [.9]', lathe(PAWN))
    thing(4.3, PLINTH + 0.72, 2.9, 25, 'Surface "granite" "float txtscale" [.9]', "Scale .85 .72 .85\n" + block(2.4))
    thing(-3.0, 0.62, -1.0, -32, solid('Surface "wood" "float ringscale" [7]', (0.35, -0.3, 0)), "Scale .7 .62 .7\n" + block(2.6))
    thing(-0.3, 0.72, -0.7, 15, 'Surface "metal" "Ka" [.6] "Ks" [1.1] "roughness" [1.28]', ball(0.8), (0.80, 0.36, 0.20),
          'Displacement "dented" "float amplitude" [.16] "float frequency" [1.5] "float octaves" [4]\n' + bound(0.5))
    thing(3.5, 0.40, -2.5, 0, 'Surface "plastic" "Kd" [.75] "Ks" [.5] "roughness" [.64]',
          'TextureCoordinates 0 0 7 0 0 4 7 4\nRotate -90 1 0 0\nTorus .60 .29 0 360 360', (0.85, 0.20, 0.03),
          'Displacement "bumpy" "float Km" [.075] "texturename" ["studio_relief.tex"]\n' + bound(0.1))
    thing(-1.35, 0.44, -3.3, 0, 'Surface "plastic" "Kd" [.7] "Ks" [.6] "roughness" [.56]', ball(0.42), (0.02, 0.24, 0.20),
          'Displacement "sinewaves" "float amplitude" [.02] "float frequency" [5]\n' + bound(0.1))
    for x, z, radius, color in [(0.85, -3.5, 0.2, (0.72, 0.50, 0.05)), (-2.6, -3.6, 0.16, (0.50, 0.03, 0.05)),
                                (1.35, -3.9, 0.11, (0.05, 0.14, 0.45))]:
        thing(x, radius, z, 0, 'Surface "plastic" "roughness" [.4]', ball(radius), color)


def mirrors():
    """What reflects the environment map, and so is not in it."""
    glass = ('Surface "glass" "texturename" ["studio.env"] "float eta" [1.5] "Ka" [0] "Ks" [.8] "roughness" [.16] '
             '"color transmitcolor" [.86 .95 .92]')
    thing(-3.0, 1.82, -1.0, 0, glass, ball(0.58))
    thing(2.05, 0.8, -0.6, 0, 'Surface "mirror" "texturename" ["studio.env"] "Ks" [.5] "roughness" [.16]', ball(0.8),
          (0.88, 0.89, 0.92))
    thing(4.3, PLINTH + 1.44, 2.9, 0,
          'Surface "shinymetal" "texturename" ["studio.env"] "Ka" [.3] "Ks" [.7] "Kr" [1] "roughness" [.48]', lathe(GOBLET),
          (1.0, 0.66, 0.24))


def lights(with_shadows):
    emit('LightSource "ambientlight" 0 "intensity" [.10] "lightcolor" [.9 .95 1]')
    for handle, place, to, cone, intensity, color, blur in LIGHTS:
        shader = "shadowspot" if with_shadows else "spotlight"
        shadow = (f'\n  "string shadowname" ["studio_light{handle}.shd"] "float samples" [48] "float blur" [{blur}]'
                  if with_shadows else "")
        emit(f'LightSource "{shader}" {handle} "intensity" [{intensity}] "lightcolor" [{vec(color)}]\n'
             f'  "from" [{vec(place)}] "to" [{vec(to)}] "coneangle" [{fmt(math.radians(cone))}] '
             f'"conedeltaangle" [{fmt(math.radians(cone * 0.45))}] "beamdistribution" [1.5]{shadow}')


def softboxes():
    emit(f"AttributeBegin\nSurface \"constant\"\nColor [.10 .105 .12]\nShadingRate 64\nTranslate {vec(CENTRE)}\n"
         "Sphere 40 -40 40 360\nAttributeEnd")
    for middle, wide, high, brightness in SOFTBOXES:
        z = unit(add(CENTRE, middle, -1))
        x = unit(cross((0.0, 1.0, 0.0), z))
        y = cross(z, x)
        corners = [add(add(middle, x, i * wide), y, j * high) for j in (-1, 1) for i in (-1, 1)]
        emit(f'AttributeBegin\nSurface "constant"\nColor [{vec(brightness)}]\nShadingRate 16\n'
             f'Patch "bilinear" "P" [{"  ".join(vec(c) for c in corners)}]\nAttributeEnd')


def environment(first):
    faces = [("px", (1, 0, 0), (0, 1, 0)), ("nx", (-1, 0, 0), (0, 1, 0)), ("py", (0, 1, 0), (0, 0, -1)),
             ("ny", (0, -1, 0), (0, 0, 1)), ("pz", (0, 0, 1), (0, 1, 0)), ("nz", (0, 0, -1), (0, 1, 0))]
    for k, (name, forward, up) in enumerate(faces):
        emit(f"""
FrameBegin {first + k}
Format {FACE_PIXELS} {FACE_PIXELS} 1
PixelSamples 3 3
Projection "perspective" "fov" [90]
Display "studio_{name}.exr" "openexr" "rgb"
{view(CENTRE, forward, up)}
WorldBegin
""")
        lights(False)
        softboxes()
        emit('ReadArchive "props"\nWorldEnd\nFrameEnd')
    names = " ".join(f'"studio_{name}.exr"' for name, _, _ in faces)
    emit(f'MakeCubeFaceEnvironment {names} "studio.env" 90 "gaussian" 2 2')


def depth_maps(first):
    for k, (handle, place, to, cone, *_) in enumerate(LIGHTS):
        emit(f"""
FrameBegin {first + k}
Format {DEPTH_PIXELS} {DEPTH_PIXELS} 1
PixelSamples 2 2
Projection "perspective" "fov" [{2 * cone + 1}]
Display "studio_light{handle}.z" "zfile" "z"
{view(place, add(to, place, -1))}
WorldBegin
Surface "constant"
ReadArchive "props"
ReadArchive "mirrors"
WorldEnd
MakeShadow "studio_light{handle}.z" "studio_light{handle}.shd"
FrameEnd
""")


def main():
    emit("""
##RenderMan RIB-Structure 1.1
# A still life of the standard shaders; written by make_studio.py.
# The file makes its textures, its environment map and its depth maps first, frames 1 to 11, in the working folder:
# render it without -o, which would give them other names. The picture is studio.exr.
# Back: a rock (fractal) on brick, a painted vase, a pawn of marble, a gold goblet (shinymetal) on granite. Front: glass on
# wood, dented copper, a mirror, a studded ring (bumpy), and below a wavy ball; three soft shadows of each.
version 3.03
""")
    flat_frame(1, "studio_glaze.exr", 1024, 512, glaze)
    flat_frame(2, "studio_relief.exr", 512, 256, relief)
    emit('MakeTexture "studio_glaze.exr" "studio_glaze.tex" "periodic" "clamp" "gaussian" 2 2')
    emit('MakeBump "studio_relief.exr" "studio_relief.tex" "periodic" "periodic" "gaussian" 2 2')
    emit('\nArchiveBegin "props"')
    props()
    emit('ArchiveEnd\nArchiveBegin "mirrors"')
    mirrors()
    emit("ArchiveEnd")
    environment(3)
    depth_maps(9)
    emit(f"""
FrameBegin 12
Display "studio.exr" "openexr" "rgba"
Format 1280 720 1
PixelSamples 6 6
PixelFilter "gaussian" 2 2
Projection "perspective" "fov" [{FOV}]
{view(EYE, add(AT, EYE, -1))}
WorldBegin
ShadingInterpolation "smooth"
""")
    lights(True)
    emit('ReadArchive "props"\nReadArchive "mirrors"\nWorldEnd\nFrameEnd')


if __name__ == "__main__":
    main()
