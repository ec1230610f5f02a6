#!/usr/bin/env python3
"""Writes car.rib: a coupe driving through a tunnel, in the spirit of figure 1 of Hou et al. 2010.

    make_car.py > car.rib

World space is the car's and left-handed: x to its right, y up, z ahead, the road at y = 0, in metres. The car stands
and the tunnel comes by, which is the same picture as that of a camera that drives along. The body is where a blend
of rounded blocks is zero, found along rays from its middle: a regular net, for a B-spline. Wheel arches and the mouth
of the grille are cut out of it as solids.
"""

import math
import random

AXLES, TRACK, WHEEL, ARCH = (1.27, -1.25), .70, .325, .375
LENGTHWISE, AROUND = 72, 48


def fmt(value):
    text = f"{value:.4g}"
    return "0" if text in ("-0", "0") or abs(value) < 1e-6 else text


def numbers(values):
    return " ".join(fmt(value) for value in values)


# ---- The shape of the body: negative inside, about metres.

def block(p, middle, half, across, along):
    """A rounded block: `across` and `along` are 2 for an ellipsoid, and higher for what is more like a box."""
    x, y, z = (abs(p[i] - middle[i]) / half[i] for i in range(3))
    section = (x ** across + y ** across) ** (1 / across)
    return ((section ** along + z ** along) ** (1 / along) - 1) * min(half)


def blend(a, b, width):
    """The union of a and b with a fillet as wide as told (polynomial smooth minimum)."""
    h = max(0, width - abs(a - b)) / width
    return min(a, b) - h * h * h * width / 6


def body(x, y, z):
    p = (abs(x), y, z)
    shape = block(p, (0, .50, -.03), (.80, .31, 2.02), 3.6, 3.2)
    shape = blend(shape, block(p, (0, .56, 1.00), (.50, .33, 1.02), 2.6, 2.6), .16)  # the bonnet
    shape = blend(shape, block(p, (0, .60, -1.22), (.62, .38, .84), 2.6, 2.5), .30)  # the tail
    shape = blend(shape, block(p, (.615, .56, 1.26), (.215, .335, .76), 2.4, 2.3), .14)  # wings
    shape = blend(shape, block(p, (.625, .56, -1.24), (.225, .365, .78), 2.5, 2.3), .16)
    lean = 1 - .34 * max(0, y - .80)  # the cabin is narrower at the top
    shape = blend(shape, block((p[0] / lean, y, z), (0, .74, -.50), (.68, .60, 1.16), 3, 2.4), .07)
    return -blend(-shape, y - .19, .08)  # flat below


def surface_point(origin, direction, reach):
    """Where a ray that comes from outside meets the body; directions have unit length."""
    def at(t):
        return tuple(origin[i] + t * direction[i] for i in range(3))
    outer = reach
    while outer > 0 and body(*at(outer)) > 0:
        outer -= .03
    inner, outer = outer, outer + .03
    for _ in range(30):
        middle = (inner + outer) / 2
        if body(*at(middle)) > 0:
            outer = middle
        else:
            inner = middle
    return at(inner)


def body_mesh():
    """A net of points from the tail's pole to the nose's, closed around."""
    rows = []
    for i in range(LENGTHWISE + 1):
        u = 2 * i / LENGTHWISE - 1
        tilt = math.copysign(abs(u) ** 5, u) * math.pi / 2
        middle = (0, .56, 1.55 * (1.35 * u - .35 * u ** 3))
        half = []
        for j in range(AROUND // 2 + 1):
            turn = 2 * math.pi * j / AROUND - math.pi / 2  # from below, up the right side
            out = math.cos(tilt)
            direction = (out * math.cos(turn), out * math.sin(turn), math.sin(tilt))
            half.append(surface_point(middle, direction, 1.5))
        row = half + [(-x, y, z) for x, y, z in half[-2:0:-1]]
        rows.append(row)
    for row in (rows[0], rows[-1]):
        row[:] = [(0, row[0][1], row[0][2])] * AROUND
    rows = [rows[0]] * 2 + rows + [rows[-1]] * 2
    points = [c for row in rows for p in row for c in p]
    return (f'PatchMesh "bicubic" {AROUND} "periodic" {len(rows)} "nonperiodic"\n  "P" [{numbers(points)}]')


def side_point(z, y, side=1):
    return surface_point((0, y, z), (side, 0, 0), 1.2)


def front_point(x, y, ahead=1):
    return surface_point((x, y, 0), (0, 0, ahead), 2.6)


def top_point(x, z):
    return surface_point((x, 0, z), (0, 1, 0), 1.6)


def normal_at(p):
    step = .004
    return unit([body(*(p[k] + step * (k == i) for k in range(3))) - body(*(p[k] - step * (k == i) for k in range(3)))
                 for i in range(3)])


def unit(a):
    length = math.sqrt(sum(c * c for c in a))
    return tuple(c / length for c in a)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def moved(p, direction, by):
    return tuple(p[i] + by * direction[i] for i in range(3))


# ---- What lies on the body: strips along curves, panes within them.

def smooth_loop(corners, count):
    """Points of the closed cubic B-spline of these control points."""
    points = []
    for k in range(count):
        at = k * len(corners) / count
        i, t = int(at), at - int(at)
        weights = [(1 - t) ** 3 / 6, (3 * t ** 3 - 6 * t * t + 4) / 6,
                   (-3 * t ** 3 + 3 * t * t + 3 * t + 1) / 6, t ** 3 / 6]
        near = [corners[(i + d) % len(corners)] for d in (-1, 0, 1, 2)]
        points.append(tuple(sum(w * c[axis] for w, c in zip(weights, near)) for axis in range(2)))
    return points


def strip(points, half_width, height, closed, normals=None, sides=6):
    """A bead along points of the body, an ellipse across: B-splines, whose net is a little wider than they are."""
    wider = 6 / (4 + 2 * math.cos(2 * math.pi / sides))
    rows, count = [], len(points)
    for i, p in enumerate(points):
        before = points[(i - 1) % count if closed else max(0, i - 1)]
        after = points[(i + 1) % count if closed else min(count - 1, i + 1)]
        n = normals[i] if normals else normal_at(p)
        across = unit(cross(unit([a - b for a, b in zip(after, before)]), n))
        row = []
        for k in range(sides):
            angle = 2 * math.pi * k / sides
            q = moved(p, across, wider * half_width * math.cos(angle))
            row += moved(q, n, wider * height * math.sin(angle))
        rows.append(row)
    if not closed:
        rows = [rows[0]] * 2 + rows + [rows[-1]] * 2
    return (f'PatchMesh "bicubic" {sides} "periodic" {len(rows)} "{"" if closed else "non"}periodic"\n'
            f'  "P" [{numbers([c for row in rows for c in row])}]')


def pane(loop, place, rings=6):
    """A pane a little over the body within a loop; `place` finds the body's point for a point of the loop's plane."""
    centre = tuple(sum(p[axis] for p in loop) / len(loop) for axis in range(2))
    points = []
    for ring in range(-1, rings + 2):  # the B-spline ends a ring before its net does
        part = 1 - ring / rings
        for p in loop:
            q = place(*(c + part * (v - c) for v, c in zip(p, centre)))
            points += moved(q, normal_at(q), .007)
    return f'PatchMesh "bicubic" {len(loop)} "periodic" {rings + 3} "nonperiodic"\n  "P" [{numbers(points)}]'


def mirrored(text):
    return f"TransformBegin Scale -1 1 1 {text}\nTransformEnd"


# Control points of loops: (z, y) at the side, (x, y) in front, (x, z) on top. Then middle and half axes of the mouth.
SIDE_WINDOW = [(.36, .915), (.36, .915), (.20, 1.05), (.02, 1.185), (-.05, 1.20), (-.40, 1.225), (-.80, 1.165),
               (-1.08, 1.02), (-1.16, .925), (-1.12, .91), (-.80, .905), (-.30, .90), (.10, .90)]
SCREEN = [(-.55, .905), (-.55, .92), (-.50, 1.05), (-.42, 1.18), (-.36, 1.215), (0, 1.235), (.36, 1.215),
          (.42, 1.18), (.50, 1.05), (.55, .92), (.55, .905), (.30, .885), (0, .88), (-.30, .885)]
DOOR = [(.50, .86), (.52, .80), (.50, .45), (.47, .30), (.40, .265), (0, .26), (-.42, .265), (-.50, .30),
        (-.56, .45), (-.58, .80), (-.56, .86), (-.40, .872), (0, .872), (.40, .872)]
BONNET = [(.40, .70), (.43, 1.0), (.36, 1.50), (.20, 1.74), (0, 1.79), (-.20, 1.74), (-.36, 1.50), (-.43, 1.0),
          (-.40, .70), (-.2, .66), (0, .66), (.2, .66)]
HEAD_LAMP = (.605, .63)
MOUTH = ((0, .46, 1.98), (.31, .115, .20))


def ball(place, half, turn=""):
    """An ellipsoid, turned as told."""
    return (f"TransformBegin Translate {numbers(place)} {turn} Scale {numbers(half)} Sphere 1 -1 1 360 "
            "TransformEnd")


def body_solid():
    """The body without the wheels' arches and the mouth of the grille, for the camera: rays meet the whole body, from
    outside, for they are several times as fast where there are no solids."""
    hollow = 'SolidBegin "primitive" AttributeBegin Surface "matte" Color .01 .01 .01'
    lines = ['SolidBegin "difference"', 'SolidBegin "primitive"', "ObjectInstance 1", "SolidEnd"]
    for axle in AXLES:
        for side in (-1, 1):
            lines.append(f"{hollow} Translate {fmt(side * .85)} {WHEEL} {axle} Rotate 90 0 1 0 "
                         f"Cylinder {ARCH} -.36 .36 360 Disk -.36 {ARCH} 360 Disk .36 {ARCH} 360 AttributeEnd SolidEnd")
    lines.append(f"{hollow} {ball(*MOUTH)} AttributeEnd SolidEnd")
    return "\n".join(lines + ["SolidEnd"])


def glass():
    window, screen = smooth_loop(SIDE_WINDOW, 44), smooth_loop(SCREEN, 44)
    side = pane(window, side_point)
    rear = pane(screen, lambda x, y: front_point(x, y, -1))
    return "\n".join([side, mirrored(side), pane(screen, front_point), rear])


def chrome():
    window, screen = smooth_loop(SIDE_WINDOW, 52), smooth_loop(SCREEN, 52)
    parts = []
    sides = [strip([side_point(*p) for p in window], .011, .012, True)]
    sides.append(strip([side_point(-.36, .90 + .065 * k) for k in range(6)], .014, .012, False))
    for axle in AXLES:
        arch = []
        for k in range(25):
            turn = math.radians(-8 + 196 * k / 24)
            arch.append(side_point(axle + ARCH * math.cos(turn), WHEEL + ARCH * math.sin(turn)))
        sides.append(strip(arch, .011, .012, False))
    sides.append(strip([side_point(z / 10, .33) for z in range(-8, 9)], .012, .010, False))
    for part in sides:
        parts += [part, mirrored(part)]
    parts.append(strip([front_point(*p) for p in screen], .012, .012, True))
    # The grille: a ring and bars a little behind it.
    (x0, y0, _), (a, b, _) = MOUTH
    turns = [2 * math.pi * k / 32 for k in range(32)]
    ring = [front_point(x0 + a * math.cos(turn), y0 + b * math.sin(turn)) for turn in turns]
    parts.append(strip(ring, .016, .014, True))
    for i in range(-6, 7):
        x = a * i / 7
        reach = b * math.sqrt(1 - (x / a) ** 2)
        bar = [moved(front_point(x, y0 + reach * k / 2), (0, 0, 1), -.03) for k in range(-2, 3)]
        parts.append(strip(bar, .007, .012, False, [(0, 0, 1)] * 5))
    # The bumper, and its horns.
    path = []
    for k in range(-14, 15):
        turn = math.radians(78 * k / 14)
        direction = (math.sin(turn), 0, math.cos(turn))
        path.append((moved(surface_point((0, .285, 1.15), direction, 1.6), direction, .075), direction))
    parts.append(strip([p for p, _ in path], .048, .020, False, [n for _, n in path]))
    # Rings of the head lamps, mirrors on their feet, handles of the doors.
    x, y, z = front_point(*HEAD_LAMP)
    door = side_point(-.44, .775)[0] + .012
    for side in (-1, 1):
        parts += [
            ball((side * .30, .30, 2.065), (.024, .085, .035)),
            f"TransformBegin Translate {numbers((side * x, y, z - .01))} Rotate -7 1 0 0 "
            "Torus .112 .017 0 360 360 TransformEnd",
            ball((side * .85, .965, .36), (.085, .05, .045), f"Rotate {side * 8} 0 1 0"),
            ball((side * .79, .91, .36), (.012, .07, .015), f"Rotate {side * -40} 0 0 1"),
            ball((side * door, .775, -.42), (.014, .012, .075)),
        ]
    return "\n".join(parts)


def gaps():
    """Where doors and the bonnet end: dark lines."""
    door = strip([side_point(*p) for p in smooth_loop(DOOR, 52)], .0035, .0015, True)
    bonnet = strip([top_point(*p) for p in smooth_loop(BONNET, 48)], .0035, .0015, True)
    return "\n".join([door, mirrored(door), bonnet])


def head_lamps():
    x, y, z = front_point(*HEAD_LAMP)
    lines = []
    for side in (-1, 1):
        lines.append(f"AttributeBegin Translate {numbers((side * x, y, z - .012))} Rotate -7 1 0 0 "
                     'Scale .108 .108 .05 Surface "head_lamp" "color beam" [16 14.5 12] Sphere 1 0 1 360 AttributeEnd')
    return "\n".join(lines)


def indicators():
    x, y, z = front_point(.60, .445)
    return "\n".join(ball((side * x, y, z), (.05, .022, .022)) for side in (-1, 1))


def wheel():
    """About z, its outer side towards positive z."""
    lines = [
        'AttributeBegin Surface "plastic" "Kd" [.8] "Ks" [.12] "roughness" [.25] Color .018 .018 .02',
        f"TransformBegin Scale 1 1 1.2 Torus {fmt(WHEEL - .078)} .078 0 360 360 TransformEnd",
        "Disk -.05 .25 360 AttributeEnd",
        'AttributeBegin Surface "matte" Color .12 .11 .11 Disk -.005 .17 360 AttributeEnd',
        'AttributeBegin Surface "plastic" "Kd" [.8] "Ks" [.12] Color .62 .60 .55',
        "Translate 0 0 .066 Scale 1 1 .8 Torus .247 .022 0 360 360 AttributeEnd",
        'AttributeBegin Surface "polished_metal" Color .88 .89 .92',
        "TransformBegin Translate 0 0 .045 Torus .214 .016 0 360 360 TransformEnd",
        "Cylinder .212 -.06 .045 360",
        ball((0, 0, .05), (.05, .05, .035)),
    ]
    for k in range(8):
        lines.append(f"TransformBegin Rotate {45 * k} 0 0 1 {ball((.125, 0, .045), (.095, .017, .014))} TransformEnd")
    return "\n".join(lines + ["AttributeEnd"])


def wheels():
    """Turned by the way that is driven while the shutter is open; the front ones follow the bend."""
    turn = math.degrees(DRIVEN / WHEEL)
    lines = []
    for axle in AXLES:
        for side in (-1, 1):
            lines.append(
                f"AttributeBegin Translate {fmt(side * TRACK)} {WHEEL} {axle} Rotate {-3 if axle > 0 else 0} 0 1 0 "
                f"Rotate {side * 90} 0 1 0 Rotate 20 0 0 1 MotionBegin [0 1] Rotate 0 0 0 1 "
                f"Rotate {fmt(-side * turn)} 0 0 1 MotionEnd ObjectInstance 2 AttributeEnd")
    return "\n".join(lines)


def car():
    return f"""AttributeBegin
  Attribute "identifier" "name" ["car"]
  Attribute "trace" "int samplemotion" [1]
AttributeBegin
  Surface "car_paint"
  Color .42 .012 .018
  AttributeBegin
    Attribute "visibility" "int camera" [0]
    Sides 1
    ObjectInstance 1
  AttributeEnd
  Attribute "visibility" "int diffuse" [0] "int specular" [0] "int transmission" [0]
{body_solid()}
AttributeEnd
AttributeBegin
  Surface "car_paint" "float mirror" [.07]
  Color .006 .008 .010
{glass()}
AttributeEnd
AttributeBegin
  Surface "polished_metal"
  Color .86 .88 .92
{chrome()}
AttributeEnd
AttributeBegin
  Surface "constant"
  Color .004 .001 .001
{gaps()}
AttributeEnd
{head_lamps()}
AttributeBegin
  Surface "car_paint"
  Color .9 .30 .02
{indicators()}
AttributeEnd
{wheels()}
AttributeEnd"""


# ---- The tunnel: lateral places are measured from the car's lane, places along it from the car, ahead.

BEND = -280  # the x of the centre about which the tunnel bends
BEGIN, END = -150, 50
LEFT_KERB, RIGHT_KERB, LEFT_WALL, RIGHT_WALL = -2.1, 5.9, -2.8, 6.6
LAMP_ROWS, LAMP_HEIGHT, LAMP_SPACING = (.2, 3.6), 4.72, 5
MARKER_SPACING = 2.5
DRIVEN = .7  # metres while the shutter is open


def in_tunnel(lateral, y, along):
    angle = along / -BEND
    radius = lateral - BEND
    return (BEND + radius * math.cos(angle), y, radius * math.sin(angle))


def sheet(profile, segments=100):
    """A B-spline along the tunnel whose cross-section is a list of (lateral, height)."""
    step = (END - BEGIN) / segments
    points = []
    for i in range(-1, segments + 2):
        for lateral, y in profile:
            points += in_tunnel(lateral, y, BEGIN + i * step)
    return f'PatchMesh "bicubic" {len(profile)} "nonperiodic" {segments + 3} "nonperiodic"\n  "P" [{numbers(points)}]'


def evenly(a, b, pieces):
    """A straight profile, with a point beyond each end, where the B-spline of its net ends."""
    return [tuple(p + (q - p) * k / pieces for p, q in zip(a, b)) for k in range(-1, pieces + 2)]


def lamp(corners, color):
    points = [c for corner in corners for c in in_tunnel(*corner)]
    return f'Color {numbers(color)} Patch "bilinear" "P" [{numbers(points)}]'


UNLIT = """AttributeBegin
  Attribute "visibility" "int diffuse" [0] "int transmission" [0]
  Surface "constant"
  ShadingRate 8"""


def walls():
    metres = f'"float metres" [{END - BEGIN}] "float begin" [{BEGIN}]'
    middle, half = (LEFT_WALL + RIGHT_WALL) / 2, (RIGHT_WALL - LEFT_WALL) / 2
    vault = []
    for k in range(-1, 18):
        turn = math.pi * k / 16
        vault.append((middle - half * math.cos(turn), 2.5 + 2.5 * math.sin(turn)))
    lines = ["AttributeBegin ShadingRate 2", f'Surface "asphalt" {metres} "float wide" [{RIGHT_KERB - LEFT_KERB}]',
             sheet(evenly((LEFT_KERB, 0), (RIGHT_KERB, 0), 8)), "AttributeEnd", "AttributeBegin ShadingRate 4"]
    for kerb, wall in ((LEFT_KERB, LEFT_WALL), (RIGHT_KERB, RIGHT_WALL)):
        for low, high, tiled, profile in ((0, .17, 0, evenly((kerb, 0), (kerb, .17), 2)),
                                          (.17, .17, 0, evenly((kerb, .17), (wall, .17), 2)),
                                          (.17, 2.5, 1, evenly((wall, .17), (wall, 2.5), 4))):
            lines += [f'Surface "tunnel_wall" {metres} "float low" [{low}] "float high" [{high}] '
                      f'"float tiled" [{tiled}]', sheet(profile)]
    lines += [f'Surface "tunnel_wall" {metres} "float tiled" [0] "float vault" [1]', sheet(vault), "AttributeEnd"]
    return lines


def tunnel():
    """It comes by: it turns about its centre while the shutter is open."""
    lines = ["AttributeBegin", '  Attribute "trace" "int samplemotion" [1]', f"  Translate {BEND} 0 0",
             f"  MotionBegin [0 1] Rotate 0 0 1 0 Rotate {fmt(math.degrees(DRIVEN / BEND))} 0 1 0 MotionEnd",
             f"  Translate {-BEND} 0 0"] + walls() + [UNLIT]
    for k in range(BEGIN // LAMP_SPACING + 1, END // LAMP_SPACING):
        for row in LAMP_ROWS:
            along = k * LAMP_SPACING + 1.2
            lines.append(lamp([(row + x, LAMP_HEIGHT, along + z) for z in (-.75, .75) for x in (-.13, .13)],
                              (20, 14.5, 8.2)))
    for k in range(int(BEGIN / MARKER_SPACING) + 1, int(END / MARKER_SPACING)):
        for wall in (LEFT_WALL + .02, RIGHT_WALL - .02):
            lines.append(lamp([(wall, .62 + y, k * MARKER_SPACING + z) for z in (-.08, .08) for y in (-.03, .03)],
                              (20, 8, 1.2)))
    return "\n".join(lines + ["AttributeEnd", "AttributeEnd"])


def traffic():
    """Lights far behind: cars that follow, cars on the other side that drive away, signals above the lanes."""
    rng = random.Random(3)

    def light(lateral, y, along, radius, color):
        return f"Color {numbers(color)} {ball(in_tunnel(lateral, y, along), (radius,) * 3)}"

    lines = [UNLIT]
    for along in (-19, -33, -41, -58, -74):
        place, height = rng.uniform(-.3, .3), rng.uniform(.58, .72)
        for side in (-.62, .62):
            bright = rng.uniform(45, 80)
            lines.append(light(place + side, height, along, .085, [bright * c for c in (1, .93, .80)]))
    for along in (-13, -27, -38, -47, -62, -80):
        place, height = 3.9 + rng.uniform(-.3, .3), rng.uniform(.65, .85)
        for side in (-.62, .62):
            bright = rng.uniform(14, 26)
            lines.append(light(place + side, height, along, .075, [bright * c for c in (1, .05, .02)]))
    for along in (-30, -60, -90):
        for lane, color in ((0, (.06, 1, .35)), (3.9, (1, .45, .04))):
            lines.append(light(lane, 4.0, along, .14, [30 * c for c in color]))
    return "\n".join(lines + ["AttributeEnd"])


HEAD = """##RenderMan RIB
# A coupe driving through a tunnel; made by make_car.py.
# Right: the car's front is sharp and its rear softer; wheels spin. Lamps, the road's marks and the walls are streaks,
# also mirrored in paint, chrome and road. Lights far behind are out of focus: polygons of nine blades, with a glow.
Option "searchpath" "string shader" ["shaders:&"]
Option "trace" "int maxdepth" [4]
Display "car.exr" "openexr" "rgba"
Format 1280 720 1
PixelSamples 16 16
PixelFilter "gaussian" 2 2
ShadingInterpolation "smooth"
Shutter 0 1
Clipping .05 1000
Projection "perspective" "fov" [%s]
DepthOfField %s
Hider "hidden" "float[4] aperture" [9 10 .3 0]
Imager "glow" "float amount" [.14] "float size" [.02] "float threshold" [1.5]
%s
WorldBegin
Attribute "visibility" "int diffuse" [1] "int specular" [1] "int transmission" [1]
Attribute "trace" "int maxspeculardepth" [3]
Basis "b-spline" 1 "b-spline" 1
"""

EYE, AT, FOV, DEPTH_OF_FIELD = (2.30, .80, 4.85), (.60, .92, -.2), 36, "2.4 .26 3.55"


def view(eye, at):
    """camera_from_world, for row vectors."""
    z = unit([a - e for a, e in zip(at, eye)])
    x = unit(cross((0, 1, 0), z))
    y = cross(z, x)
    rows = [(x[i], y[i], z[i], 0) for i in range(3)]
    rows.append([-sum(e * c for e, c in zip(eye, axis)) for axis in (x, y, z)] + [1])
    return "ConcatTransform [" + "  ".join(numbers(row) for row in rows) + "]"


def lights():
    """What the rows of lamps do to paint: light from across the car, from as high as they are."""
    return "\n".join(f'LightSource "distantlight" {i + 1} "intensity" [.42] "lightcolor" [1 .74 .42] '
                     f'"from" [{fmt(row)} {LAMP_HEIGHT - .6} {ahead}] "to" [0 0 0]'
                     for i, (row, ahead) in enumerate((row, ahead) for row in LAMP_ROWS for ahead in (-2, 2)))


def main():
    print(HEAD % (FOV, DEPTH_OF_FIELD, view(EYE, AT)))
    print(lights())
    print("ObjectBegin 1\n" + body_mesh() + "\nObjectEnd")
    print("ObjectBegin 2\n" + wheel() + "\nObjectEnd")
    print(tunnel())
    print(traffic())
    print(car())
    print("WorldEnd")


main()
