#!/usr/bin/env python3
"""Writes spot.rib, the picture of the README: Spots at a garden party, one in focus, one leaping, the others far
out of focus in front and behind, on a tiled ground that runs under the camera to the horizon.

    make_spot.py > spot.rib

World space is left-handed: x right, y up, z away from the camera, the ground at y = 0; a Spot is 1.7 units high.
All colours are linear. There are no shadows: dark disks whose opacity fades to the rim stand in for them.
"""

import math
import random
from dataclasses import dataclass

EYE = (0.0, 1.42, 0.0)
PITCH = 5.0  # degrees, downwards
FOV = 30.0  # degrees, of the picture's height
FOCUS = 5.35  # the hero's eyes
FEET = 0.731  # how far below its origin Spot's limit surface ends

SKY = [  # elevation in degrees, colour: gold, rose, violet, blue
    (0.0, (1.0, 0.63, 0.38)),
    (3.5, (0.90, 0.46, 0.35)),
    (7.0, (0.52, 0.33, 0.42)),
    (11.0, (0.20, 0.21, 0.40)),
    (20.0, (0.06, 0.11, 0.26)),
]
HORIZON = SKY[0][1]
# What the ground's matte surface reflects of all distant lights: its colour far away is the horizon's over this.
GROUND_LIGHT = (0.90, 0.87, 0.88)
MIST_LENGTH = 26.0  # the ground's colour nears the horizon's with this decay


def fmt(value):
    text = f"{value:.5g}"
    return "0" if text == "-0" else text


def vec(values):
    return " ".join(fmt(v) for v in values)


def rgb(request, color):
    return f"{request} [{vec(color)}]"


def mix(a, b, t):
    return tuple(x + (y - x) * t for x, y in zip(a, b))


@dataclass
class Spot:
    """A Spot standing on the ground. Heading 0 looks at the camera, positive turns to the left."""

    comment: str
    x: float
    z: float
    heading: float
    surface: str
    scale: float = 1.0
    shading_rate: float = 1.0


PAINTED = (
    'Surface "paintedplastic" "texturename" ["textures/spot_texture.png"] '
    '"Kd" [.9] "Ks" [{ks}] "roughness" [{rough}]'
)


def painted(color, ks=0.25, rough=1.2):
    return rgb("Color", color) + "\n" + PAINTED.format(ks=ks, rough=rough)


def plain(shader, color, parameters=""):
    return rgb("Color", color) + f'\nSurface "{shader}" {parameters}'.rstrip()


SPOTS = [
    Spot("The hero: in focus, on the right third.", 0.80, 5.80, 32, painted((0.92, 0.90, 0.88))),
    Spot(
        "In front, cut by the frame: coral plastic.",
        -1.44,
        2.55,
        -152,
        plain("plastic", (0.80, 0.16, 0.09), '"Kd" [.9] "Ks" [.6] "roughness" [.64]'),
        shading_rate=16,
    ),
    Spot(
        "In front on the right, a small one of brass.",
        1.10,
        2.35,
        62,
        plain("metal", (0.95, 0.62, 0.22), '"Ka" [1.2] "Ks" [1.6] "roughness" [1.76]'),
        scale=0.52,
        shading_rate=16,
    ),
    Spot("Behind: rosy.", 3.15, 10.4, 118, painted((0.95, 0.55, 0.48)), shading_rate=4),
    Spot("Behind: mint.", -4.3, 14.5, -70, painted((0.50, 0.90, 0.72)), shading_rate=4),
    Spot(
        "Behind: blue plastic.",
        -0.35,
        17.5,
        20,
        plain("plastic", (0.10, 0.30, 0.62), '"Kd" [.9] "Ks" [.7] "roughness" [.8]'),
        shading_rate=4,
    ),
    Spot("Behind: cream.", 5.0, 20.5, -30, painted((0.95, 0.85, 0.60)), shading_rate=4),
    Spot(
        "Far behind: copper.",
        2.4,
        24.0,
        75,
        plain("metal", (0.90, 0.42, 0.25), '"Ka" [1.2] "Ks" [1.5] "roughness" [1.6]'),
        shading_rate=4,
    ),
    Spot("Far behind: lilac.", -7.5, 25.0, -110, painted((0.70, 0.58, 0.92)), shading_rate=4),
]

# The leaping Spot, from left to right, at evenly spaced times of the shutter: centre, and pitch of its nose.
LEAP_TIMES = [0, 0.25, 0.5, 0.75, 1]
LEAP_HEADING = -68.0
LEAP_START, LEAP_END = (-1.36, 7.15), (-1.08, 7.05)  # x and z
LEAP_TOP, LEAP_DROP = 1.34, 0.06  # height of its centre at the top, and how much lower it is at either end
LEAP_PITCH = (24.0, 2.0)


def leap_pose(time):
    """(x, y, z, pitch) of the leaping Spot."""
    x = LEAP_START[0] + (LEAP_END[0] - LEAP_START[0]) * time
    z = LEAP_START[1] + (LEAP_END[1] - LEAP_START[1]) * time
    y = LEAP_TOP - LEAP_DROP * (2 * time - 1) ** 2
    return x, y, z, LEAP_PITCH[0] + (LEAP_PITCH[1] - LEAP_PITCH[0]) * time


@dataclass
class Ball:
    x: float
    z: float
    radius: float
    surface: str


BALLS = [
    Ball(-0.40, 5.15, 0.20, plain("plastic", (0.02, 0.35, 0.36), '"Kd" [.85] "Ks" [.8] "roughness" [.48]')),
    Ball(-0.03, 4.80, 0.11, plain("plastic", (0.85, 0.50, 0.06), '"Kd" [.85] "Ks" [.8] "roughness" [.48]')),
    Ball(-1.12, 6.0, 0.22, plain("plastic", (0.78, 0.13, 0.10), '"Kd" [.85] "Ks" [.8] "roughness" [.48]')),
    Ball(-3.0, 10.5, 0.38, plain("plastic", (0.85, 0.50, 0.06), '"Kd" [.85] "Ks" [.8] "roughness" [.8]')),
    Ball(-0.14, 9.6, 0.30, plain("plastic", (0.78, 0.13, 0.10), '"Kd" [.85] "Ks" [.8] "roughness" [.8]')),
]


def misty(color, distance):
    """The ground's colour as seen from a distance: it nears what gives the horizon's when lit."""
    far = tuple(h / light for h, light in zip(HORIZON, GROUND_LIGHT))
    return mix(color, far, 1 - math.exp(-max(0.0, distance - 6) / MIST_LENGTH))


def header():
    return f"""##RenderMan RIB-Structure 1.1
# Spots at a garden party; written by make_spot.py.
# Right: the Spot on the right third is sharp; the coral and brass ones in front and all behind are soft disks of
# blur; the leaping one is smeared along its arc; the tiles run under the camera without holes or cracks.
# Spot is Keenan Crane's, in the public domain.

Option "color" "transfer" ["srgb"]  # the numbers of Spot's texture, and of pictures in 8 bits
Display "spot.exr" "openexr" "rgba"
Format 1280 720 1
PixelSamples 8 8
PixelFilter "gaussian" 2 2
Projection "perspective" "fov" [{fmt(FOV)}]
Clipping .1 100000
DepthOfField 2.2 .5 {fmt(FOCUS)}
Shutter 0 1
Rotate {fmt(-PITCH)} 1 0 0
Translate {vec(-c for c in EYE)}
"""


def lights():
    return """
# Low ambient light, a warm sun from the left in front, a cool sky from behind on the right, a lamp on the hero.
LightSource "ambientlight" 1 "intensity" [.22] "lightcolor" [.75 .8 1]
LightSource "distantlight" 2 "intensity" [.9] "lightcolor" [1 .88 .72] "from" [-.55 .75 -.45] "to" [0 0 0]
LightSource "distantlight" 3 "intensity" [.55] "lightcolor" [.45 .65 1] "from" [.5 .35 .8] "to" [0 0 0]
LightSource "spotlight" 4 "intensity" [16] "lightcolor" [1 .8 .6] "from" [-1.2 5.6 2.2] "to" [.7 .6 5.8]
  "coneangle" [.3] "conedeltaangle" [.2] "beamdistribution" [2]
"""


def sky_color(azimuth, elevation):
    """Between the stops of SKY, with a glow low down on the left; degrees."""
    color = SKY[-1][1] if elevation > 0 else HORIZON
    for (low, below), (high, above) in zip(SKY, SKY[1:]):
        if low <= elevation <= high:
            color = mix(below, above, (elevation - low) / (high - low))
    glow = math.exp(-(((azimuth + 12) / 18) ** 2) - (max(0.0, elevation) / 6) ** 2)
    return tuple(c + glow * g for c, g in zip(color, (0.50, 0.30, 0.08)))


def sky():
    """A wall of bilinear patches around the view."""
    columns, radius = 13, 3000.0
    elevations = [-1, 0, 1, 2, 3.5, 5, 7, 9, 11, 14, 20]
    rows = len(elevations)
    points, colors = [], []
    for elevation in elevations:
        for i in range(columns):
            azimuth = -44 + 88 * i / (columns - 1)
            angle = math.radians(azimuth)
            height = EYE[1] + radius * math.tan(math.radians(elevation))
            points += [radius * math.sin(angle), height, radius * math.cos(angle)]
            colors += sky_color(azimuth, elevation)
    return f"""
# The evening sky: colours at the vertices of a wall of patches.
AttributeBegin
Surface "constant"
ShadingRate 64
PatchMesh "bilinear" {columns} "nonperiodic" {rows} "nonperiodic"
 "P" [{vec(points)}]
 "vertex color Cs" [{vec(colors)}]
AttributeEnd
"""


def hills():
    lines = ["\n# Hills: flattened spheres that rise from the mist."]
    rows = [
        (-70, 150, 62, 11, 0.62),
        (34, 170, 78, 13, 0.66),
        (-16, 230, 80, 16, 0.78),
        (105, 190, 50, 17, 0.70),
        (-150, 210, 70, 19, 0.74),
    ]
    for x, z, width, height, mist in rows:
        color = mix((0.05, 0.20, 0.24), tuple(0.86 * c for c in HORIZON), mist)
        lines.append(
            f"AttributeBegin\n{rgb('Color', color)}\nSurface \"constant\"\nShadingRate 16\n"
            f"Translate {vec((x, -0.5, z))}\nScale {vec((width, height, width))}\nSphere 1 -1 1 360\nAttributeEnd"
        )
    return "\n".join(lines) + "\n"


def far_ground():
    """Rings about the camera, coloured by distance; just below the tiles."""
    radii = [0, 8, 16, 26, 40, 60, 90, 140, 220, 400, 1200, 6000]
    sides = 24
    points, colors, counts, corners = [], [], [], []
    for radius in radii:
        for i in range(sides):
            angle = 2 * math.pi * i / sides
            points += [radius * math.sin(angle), -0.01, radius * math.cos(angle)]
            colors += misty((0.105, 0.255, 0.27), radius)
    for ring in range(len(radii) - 1):
        for i in range(sides):
            a, b = ring * sides + i, ring * sides + (i + 1) % sides
            counts.append(4)
            corners += [a, a + sides, b + sides, b]
    return f"""
# The ground to the horizon and behind the camera, misty with distance.
AttributeBegin
Surface "matte"
ShadingRate 16
PointsPolygons [{vec(counts)}]
 [{vec(corners)}]
 "P" [{vec(points)}]
 "vertex color Cs" [{vec(colors)}]
AttributeEnd
"""


def tiles():
    """A checker of tiles, each its own shade, from behind the camera to the middle distance."""
    rng = random.Random(5)
    x0, z0, nx, nz, size = -12.0, -3.0, 30, 34, 0.8
    points = [(x0 + i * size, 0, z0 + j * size) for j in range(nz + 1) for i in range(nx + 1)]
    corners, colors = [], []
    for j in range(nz):
        for i in range(nx):
            a = j * (nx + 1) + i
            corners += [a, a + nx + 1, a + nx + 2, a + 1]
            base = (0.075, 0.20, 0.22) if (i + j) % 2 else (0.16, 0.33, 0.33)
            pick = rng.random()
            if pick < 0.035:
                base = (0.62, 0.20, 0.11)
            elif pick < 0.07:
                base = (0.66, 0.42, 0.10)
            shade = rng.uniform(0.86, 1.14)
            x, _, z = points[a]
            distance = math.hypot(x + size / 2, z + size / 2)
            colors += misty(tuple(c * shade for c in base), distance)
    return f"""
# Tiles: one PointsPolygons, a uniform colour for each.
AttributeBegin
Surface "plastic" "Kd" [1] "Ks" [.12] "roughness" [2]
ShadingRate 16
PointsPolygons [{vec([4] * (nx * nz))}]
 [{vec(corners)}]
 "P" [{vec(c for p in points for c in p)}]
 "uniform color Cs" [{vec(colors)}]
AttributeEnd
"""


SHADOW_RINGS = [(1.0, 0.60, 0.42), (0.62, 0.40, 0.50)]  # scales along and across, opacity at the centre


def shadow(transform, scale, strength=1.0):
    """Two dark disks, see-through at the rim, where something touches the ground."""
    lines = ["AttributeBegin", "Color [.012 .035 .05]", 'Surface "constant"', "ShadingRate 16", transform]
    for layer, (along, across, opacity) in enumerate(SHADOW_RINGS, start=1):
        a = fmt(opacity * strength)
        lines += [
            "TransformBegin",
            f"Translate 0 {fmt(0.004 * layer)} 0",
            "Rotate -90 1 0 0",
            f"Scale {vec((across * scale, along * scale, 1))}",
            f'Disk 0 1 360 "Os" [0 0 0 0 0 0 {a} {a} {a} {a} {a} {a}]',
            "TransformEnd",
        ]
    return "\n".join(lines + ["AttributeEnd"])


def standing(spot):
    place = f"Translate {vec((spot.x, 0, spot.z))}\nRotate {fmt(spot.heading)} 0 1 0"
    # The body's middle is behind the origin, and the sun pushes shadows to the right and back.
    under = f"Translate {vec((spot.x + 0.12 * spot.scale, 0, spot.z + 0.08 * spot.scale))}\n"
    under += f"Rotate {fmt(spot.heading)} 0 1 0\nTranslate 0 0 {fmt(0.15 * spot.scale)}"
    scale = f"Scale {vec([spot.scale] * 3)}\n" if spot.scale != 1 else ""
    rate = f"ShadingRate {fmt(spot.shading_rate)}\n" if spot.shading_rate != 1 else ""
    return (
        f"\n# {spot.comment}\n{shadow(under, 1.15 * spot.scale)}\nAttributeBegin\n{spot.surface}\n{rate}{place}\n"
        f'{scale}Translate 0 {fmt(FEET)} 0\nReadArchive "spot_mesh.rib"\nAttributeEnd\n'
    )


def motion(requests):
    return "\n".join([f"MotionBegin [{vec(LEAP_TIMES)}]"] + ["  " + r for r in requests] + ["MotionEnd"])


def leaping():
    poses = [leap_pose(t) for t in LEAP_TIMES]
    moved = motion(f"Translate {vec(p[:3])}" for p in poses)
    pitched = motion(f"Rotate {fmt(p[3])} 1 0 0" for p in poses)
    turn = f"Rotate {fmt(LEAP_HEADING)} 0 1 0"
    under = motion(f"Translate {vec((p[0] + 0.2, 0, p[2] + 0.15))}" for p in poses) + f"\n{turn}"
    surface = painted((0.95, 0.90, 0.84))
    return (
        f"\n# The leaping Spot: five motion keys of place and of pitch.\n{shadow(under, 1.1, 0.7)}\nAttributeBegin\n"
        f'{surface}\n{moved}\n{turn}\n{pitched}\nTranslate 0 0 -.1\nReadArchive "spot_mesh.rib"\nAttributeEnd\n'
    )


def balls():
    lines = ["\n# Balls on the ground."]
    for ball in BALLS:
        lines += [
            shadow(f"Translate {vec((ball.x + 0.05, 0, ball.z + 0.04))}", 1.7 * ball.radius),
            f"AttributeBegin\n{ball.surface}\nTranslate {vec((ball.x, ball.radius, ball.z))}",
            f"Sphere {vec((ball.radius, -ball.radius, ball.radius, 360))}\nAttributeEnd",
        ]
    return "\n".join(lines) + "\n"


def garland_points():
    """Bulbs on strings that sag between poles far behind; (place, radius, colour)."""
    warm = [(3.2, 1.75, 0.62), (3.0, 1.35, 0.40), (3.2, 2.3, 1.2), (2.9, 0.95, 0.42), (1.2, 2.1, 2.0)]
    rng = random.Random(11)
    strings = [
        ((-15, 6.4, 27), (-1.5, 5.9, 33), 1.9, 11),
        ((-1.5, 5.9, 33), (16, 7.0, 27), 2.1, 13),
        ((-17, 4.6, 36), (9, 5.4, 42), 1.7, 15),
        ((9, 5.4, 42), (23, 5.2, 38), 1.5, 8),
    ]
    bulbs = []
    for start, end, sag, count in strings:
        for k in range(count):
            t = (k + 0.5) / count
            x, y, z = mix(start, end, t)
            y -= sag * 4 * t * (1 - t)
            bulbs.append(((x, y, z), rng.uniform(0.24, 0.33) * z / 30, warm[rng.randrange(len(warm))]))
    return bulbs


def garlands():
    lines = ["\n# Lights on strings, far out of focus."]
    lines.append('ObjectBegin "bulb"\nSphere 1 -1 1 360\nObjectEnd')
    lines.append('AttributeBegin\nSurface "constant"\nShadingRate 16')
    for place, radius, color in garland_points():
        lines.append(
            f"AttributeBegin {rgb('Color', color)} Translate {vec(place)} Scale {vec([radius] * 3)} "
            'ObjectInstance "bulb" AttributeEnd'
        )
    return "\n".join(lines + ["AttributeEnd"]) + "\n"


def main():
    print(header())
    print("WorldBegin")
    print('ShadingInterpolation "smooth"')
    print(lights() + sky() + hills() + far_ground() + tiles(), end="")
    print("".join(standing(spot) for spot in SPOTS) + leaping() + balls() + garlands(), end="")
    print("WorldEnd")


if __name__ == "__main__":
    main()
