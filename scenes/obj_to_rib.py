#!/usr/bin/env python3
"""Turns a Wavefront OBJ file into a RIB archive with one primitive, to be drawn by ReadArchive.

    obj_to_rib.py cow.obj cow.rib                     a Catmull-Clark subdivision surface
    obj_to_rib.py --scheme polygons cow.obj cow.rib   a PointsPolygons with the file's normals
    obj_to_rib.py cow.obj cow.rib.gz                  gzip'ed

Read are v, vt, vn and f (any number of corners, indices from either end); groups, materials, lines and
smoothing are ignored. Texture coordinates become s and t: "vertex" where every vertex has only one,
else "facevarying", so that seams are kept. RenderMan's t runs down from the picture's top, hence t = 1 - v.

Coordinates are kept as they are. An OBJ file is meant for a right-handed space and RIB's default one is
left-handed: the model appears mirrored unless the scene has a Scale 1 1 -1. The outside stays outside.
"""

import argparse
import gzip
import sys
from dataclasses import dataclass, field

RIB_SCHEMES = {"catmull-clark", "loop", "bilinear"}
LINE_WIDTH = 120


@dataclass
class Mesh:
    """Points, texture coordinates and normals, and faces: lists of (v, vt or None, vn or None) from 0."""

    points: list = field(default_factory=list)
    texture: list = field(default_factory=list)
    normals: list = field(default_factory=list)
    faces: list = field(default_factory=list)


class ObjError(Exception):
    """The file is not an OBJ that this script understands; the message names the line."""


def resolve_index(text, count):
    """An OBJ index (from 1, or negative from the end) as an index from 0; None when it is absent."""
    if not text:
        return None
    value = int(text)
    index = value - 1 if value > 0 else count + value
    if value == 0 or not 0 <= index < count:
        raise ValueError(f"index {value} is outside 1..{count}")
    return index


def parse_corner(text, mesh):
    """A corner of a face: v, v/vt, v//vn or v/vt/vn."""
    v, vt, vn = (text.split("/") + ["", ""])[:3]
    corner = (
        resolve_index(v, len(mesh.points)),
        resolve_index(vt, len(mesh.texture)),
        resolve_index(vn, len(mesh.normals)),
    )
    if corner[0] is None:
        raise ValueError("a corner without a vertex")
    return corner


def read_obj(lines):
    mesh = Mesh()
    for number, line in enumerate(lines, start=1):
        words = line.split("#", 1)[0].split()
        if not words:
            continue
        try:
            if words[0] == "v":
                mesh.points.append([float(w) for w in words[1:4]])
            elif words[0] == "vt":
                mesh.texture.append([float(w) for w in (words[1:3] + ["0"])[:2]])
            elif words[0] == "vn":
                mesh.normals.append([float(w) for w in words[1:4]])
            elif words[0] == "f":
                corners = [parse_corner(w, mesh) for w in words[1:]]
                if len(corners) < 3:
                    raise ValueError("a face of fewer than three corners")
                mesh.faces.append(corners)
        except ValueError as error:
            raise ObjError(f"line {number}: {error}") from error
    if not mesh.faces:
        raise ObjError("no faces")
    return mesh


def one_per_vertex(mesh, which):
    """The texture (1) or normal (2) index of every vertex, None when some vertex has several."""
    index = [None] * len(mesh.points)
    for face in mesh.faces:
        for corner in face:
            vertex, value = corner[0], corner[which]
            if index[vertex] not in (None, value):
                return None
            index[vertex] = value
    return index


def corner_variable(mesh, which, values, empty):
    """(storage class, values) of what corners refer to; None when some corner has none."""
    if any(corner[which] is None for face in mesh.faces for corner in face):
        return None
    index = one_per_vertex(mesh, which)
    if index is not None:
        return "vertex", [empty if i is None else values[i] for i in index]
    return "facevarying", [values[corner[which]] for face in mesh.faces for corner in face]


def number(value):
    text = f"{value:.6g}"
    if text == "-0":
        return "0"
    if text.startswith("0."):
        return text[1:]
    return "-" + text[2:] if text.startswith("-0.") else text


def array(values):
    """A RIB array, broken into lines that stay readable."""
    lines, line = [], ""
    for word in map(number, values):
        if len(line) + len(word) + 1 > LINE_WIDTH:
            lines.append(line)
            line = ""
        line += (" " if line else "") + word
    lines.append(line)
    return "[" + "\n ".join(lines) + "]"


def flat(rows):
    return [value for row in rows for value in row]


def parameters(mesh, with_normals):
    """The primitive variables, as lines of RIB, and whether some of them are facevarying."""
    lines = [f'"P" {array(flat(mesh.points))}']
    has_seams = False
    texture = corner_variable(mesh, 1, [(s, 1 - v) for s, v in mesh.texture], (0, 0))
    if texture:
        storage, values = texture
        has_seams = storage == "facevarying"
        for column, name in enumerate("st"):
            lines.append(f'"{storage} float {name}" {array(row[column] for row in values)}')
    normals = corner_variable(mesh, 2, mesh.normals, (0, 0, 1)) if with_normals else None
    if normals:
        storage, values = normals
        lines.append(f'"{storage} normal N" {array(flat(values))}')
    return lines, has_seams


def rib_of(mesh, scheme, comments):
    counts = array(len(face) for face in mesh.faces)
    vertices = array(corner[0] for face in mesh.faces for corner in face)
    lines, has_seams = parameters(mesh, with_normals=scheme == "polygons")
    if scheme in RIB_SCHEMES:
        tags = [("interpolateboundary", 1)] + ([("facevaryinginterpolateboundary", 1)] if has_seams else [])
        names = " ".join(f'"{name}"' for name, _ in tags)
        head = [
            f'SubdivisionMesh "{scheme}"',
            counts,
            vertices,
            f"[{names}] {array([1, 0] * len(tags))} {array(value for _, value in tags)} []",
        ]
    else:
        head = ["PointsPolygons", counts, vertices]
    return "\n".join([f"# {comment}" for comment in comments] + head + lines) + "\n"


def write_text(path, text):
    """To a file, gzip'ed (without a time stamp: the same bytes for the same mesh) by its name, or to stdout."""
    if path == "-":
        sys.stdout.write(text)
    elif path.endswith(".gz"):
        with open(path, "wb") as out, gzip.GzipFile("", "wb", 9, out, mtime=0) as packed:
            packed.write(text.encode())
    else:
        with open(path, "w", encoding="utf-8") as out:
            out.write(text)


def arguments():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("obj", help="the OBJ file, - for standard input")
    parser.add_argument("rib", nargs="?", default="-", help="the archive to write (default: standard output)")
    parser.add_argument(
        "--scheme",
        choices=["catmull-clark", "loop", "bilinear", "polygons"],
        default="catmull-clark",
        help="subdivision scheme, or polygons for PointsPolygons (default: %(default)s)",
    )
    parser.add_argument("--name", help="what it is called in the archive's first comment")
    parser.add_argument("--comment", action="append", default=[], help="a further comment line (origin, licence)")
    return parser.parse_args()


def main():
    options = arguments()
    try:
        if options.obj == "-":
            mesh = read_obj(sys.stdin)
        else:
            with open(options.obj, encoding="utf-8", errors="replace") as lines:
                mesh = read_obj(lines)
        if options.scheme == "loop" and any(len(face) != 3 for face in mesh.faces):
            raise ObjError("the loop scheme needs triangles only")
        name = options.name or options.obj.replace("\\", "/").rsplit("/", 1)[-1]
        summary = f"{name}: {len(mesh.faces)} faces, {len(mesh.points)} points, {options.scheme}"
        write_text(options.rib, rib_of(mesh, options.scheme, [summary] + options.comment))
    except (OSError, ObjError) as error:
        sys.exit(f"{options.obj}: error: {error}")


if __name__ == "__main__":
    main()
