#!/usr/bin/env python3
"""CAD files of `catoptric export` as programs of other people read them.

clients.py PROGRAM

The paper's paraboloid as a lamp mirror (opening 10 mm, wall 1 mm, flange 8 mm wide and 2 mm thick) is written in every
format and measured, against sums over its section in closed form, by this script's own reading of STEP, IGES, STL and
GLB and by whichever of these is installed:
  gmsh       Debian's gmsh: STEP, IGES, BREP. It shares OCCT with us: being accepted, not being right
  ezdxf      Debian's python3-ezdxf: the section in DXF
  admesh     Debian's admesh: whether the STL closes, its volume
  assimp     Debian's assimp-utils: the GLB's and the STL's triangles
With --table prints what each saw. Ends with 77 (skipped) where none of the four is installed, with 1 where a number is
farther off than its format's own error.
"""
import json
import math
import re
import shutil
import struct
import subprocess
import sys
import tempfile

OPENING, WALL, FLANGE, THICK, RIM = 10.0, 1.0, 8.0, 2.0, 100.0
SCENE = f"""unit = "mm"
source.position = [0, 0, 50]
source.power = 1
[reflector]
name = "Lamp mirror"
points = [[0, 100], [50, 100], [100, 50]]
opening = {OPENING}
wall = {WALL}
flange = {FLANGE}
flange_thickness = {THICK}
material = "Aluminium"
density = 2700
[near_field]
radius = 50
[export]
step_schema = "ap242"
iges_mode = "brep"
"""
seen = []


def check(reader, what, found, expected, within):
    seen.append((reader, what, found, expected))
    if not abs(found - expected) <= within:
        sys.exit(f"{reader}: {what} is {found}, not {expected} within {within}")


# ---- the part, by its section ----
def height(r):
    return 100 - r * r / 200


def back(r):
    q = math.hypot(1, r / 100)
    return r + WALL * r / 100 / q, height(r) + WALL / q


def flange_meets():
    low, high = OPENING, RIM
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (middle, high) if back(middle)[1] >= 50 + THICK else (low, middle)
    return low


def outline(steps):
    """Points round the section, from the opening over the optical surface, the flange and the back."""
    meets = flange_meets()
    optical = [OPENING + (RIM - OPENING) * i / steps for i in range(steps + 1)]
    outer = [meets + (OPENING - meets) * i / steps for i in range(steps + 1)]
    points = [(r, height(r)) for r in optical]
    points += [(RIM + FLANGE, 50.0), (RIM + FLANGE, 50 + THICK)]
    points += [back(r) for r in outer]
    return points + points[:1]


def sums():
    """Volume and area of revolution: frustums of a fine polygon, extrapolated (its error goes like steps^-2)."""
    def of(steps):
        volume = area = 0.0
        points = outline(steps)
        for (r0, z0), (r1, z1) in zip(points, points[1:]):
            volume += math.pi / 3 * (r0 * r0 + r0 * r1 + r1 * r1) * (z1 - z0)
            area += math.pi * (r0 + r1) * math.hypot(r1 - r0, z1 - z0)
        return abs(volume), area
    (v1, a1), (v2, a2) = of(2000), of(4000)
    return (4 * v2 - v1) / 3, (4 * a2 - a1) / 3


VOLUME, AREA = sums()
BOX = (-108, -108, 50, 108, 108, back(OPENING)[1])


# ---- our own reading ----
def step_generatrices(text):
    """Control points of all surfaces of revolution, by ISO 10303-21 alone."""
    entities = dict(re.findall(r"#(\d+)\s*=\s*(.*?);\s*(?=#|ENDSEC)", text, re.S))
    entities = {key: re.sub(r"\s+", "", value) for key, value in entities.items()}
    found = []
    for value in entities.values():
        surface = re.match(r"SURFACE_OF_REVOLUTION\('[^']*',#(\d+),#(\d+)\)", value)
        if not surface:
            continue
        curve = re.match(r"B_SPLINE_CURVE_WITH_KNOTS\('[^']*',(\d+),\(([^)]*)\)", entities[surface[1]])
        points = [re.search(r"\(([^()]*)\)\)$", entities[each[1:]])[1].split(",") for each in curve[2].split(",")]
        found.append((int(curve[1]), [tuple(map(float, point)) for point in points]))
    return found


def iges_parameters(path):
    """Parameter data of each entity by its type, by the fixed columns of IGES 5.3."""
    with open(path, encoding="ascii") as file:
        lines = [line.rstrip("\n") for line in file]
    directory = [line for line in lines if line[72] == "D"]
    parameters = {int(line[73:80]): line[:64] for line in lines if line[72] == "P"}
    entities = []
    for first in directory[0::2]:
        start = int(first[8:16])
        text = parameters[start]
        while ";" not in text:
            start += 1
            text += parameters[start]
        entities.append([field.strip() for field in text.split(";")[0].split(",")])
    return entities


def stl_triangles(path):
    data = open(path, "rb").read()
    (count,) = struct.unpack_from("<I", data, 80)
    return [struct.unpack_from("<9f", data, 84 + 50 * i + 12) for i in range(count)]


def glb_triangles(path):
    data = open(path, "rb").read()
    (length,) = struct.unpack_from("<I", data, 12)
    tree = json.loads(data[20:20 + length])
    binary = data[20 + length + 8:]
    triangles = []

    def walk(index, place):
        node = tree["nodes"][index]
        if "matrix" in node:
            sys.exit("GLB: a node has a matrix, which this reader does not know")
        x, y, z = node.get("translation", (0, 0, 0))
        qx, qy, qz, qw = node.get("rotation", (0, 0, 0, 1))
        k = node.get("scale", (1, 1, 1))

        def here(p):
            p = [p[i] * k[i] for i in range(3)]
            t = [2 * (qy * p[2] - qz * p[1]), 2 * (qz * p[0] - qx * p[2]), 2 * (qx * p[1] - qy * p[0])]
            p = [p[0] + qw * t[0] + qy * t[2] - qz * t[1], p[1] + qw * t[1] + qz * t[0] - qx * t[2],
                 p[2] + qw * t[2] + qx * t[1] - qy * t[0]]
            return place([p[0] + x, p[1] + y, p[2] + z])
        for child in node.get("children", []):
            walk(child, here)
        if "mesh" not in node:
            return
        for part in tree["meshes"][node["mesh"]]["primitives"]:
            points = accessor(part["attributes"]["POSITION"])
            corners = [here(p) for p in points]
            indices = [i[0] for i in accessor(part["indices"])]
            triangles.extend(tuple(c for i in indices[j:j + 3] for c in corners[i]) for j in range(0, len(indices), 3))

    def accessor(index):
        one = tree["accessors"][index]
        view = tree["bufferViews"][one["bufferView"]]
        kind, size = {5126: ("f", 4), 5125: ("I", 4), 5123: ("H", 2)}[one["componentType"]]
        width = {"SCALAR": 1, "VEC3": 3}[one["type"]]
        start = view.get("byteOffset", 0) + one.get("byteOffset", 0)
        stride = view.get("byteStride", size * width)
        return [struct.unpack_from(f"<{width}{kind}", binary, start + i * stride) for i in range(one["count"])]
    for root in tree["scenes"][tree.get("scene", 0)]["nodes"]:
        walk(root, lambda p: p)
    return triangles


def measure(triangles):
    """Signed volume, area, box; and how many directed edges have no partner, corners compared as numbers."""
    volume = area = 0.0
    edges = {}
    low, high = [math.inf] * 3, [-math.inf] * 3
    for t in triangles:
        a, b, c = t[0:3], t[3:6], t[6:9]
        volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                   a[2] * (b[0] * c[1] - b[1] * c[0])) / 6
        u, v = [b[i] - a[i] for i in range(3)], [c[i] - a[i] for i in range(3)]
        area += math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]) / 2
        for p, q in ((a, b), (b, c), (c, a)):
            edges[p, q] = edges.get((p, q), 0) + 1
        for p in (a, b, c):
            low = [min(x, y) for x, y in zip(low, p)]
            high = [max(x, y) for x, y in zip(high, p)]
    unpaired = sum(1 for (p, q), count in edges.items() if edges.get((q, p), 0) != count)
    return volume, area, low + high, unpaired


def check_mesh(reader, triangles, scale, turned, chord_mm):
    volume, area, box, unpaired = measure(triangles)
    check(reader, "edges without a partner", unpaired, 0, 0)
    # A facet is within the chord of the part: the volume within chord times area. Positive: facets look outward.
    check(reader, "volume, mm^3", volume / scale**3, VOLUME, chord_mm * AREA)
    check(reader, "area, mm^2", area / scale**2, AREA, 0.01 * AREA)
    expected = (-108, 50, -108, 108, BOX[5], 108) if turned else BOX
    for side, found, wanted in zip("x0 y0 z0 x1 y1 z1".split(), box, expected):
        check(reader, f"box {side}, mm", found / scale, wanted, chord_mm)


def own(folder, chord_mm):
    text = open(f"{folder}/reflector.step", encoding="ascii").read()
    optical = [points for degree, points in step_generatrices(text) if degree == 2]
    # A quadratic through (10, 99.5) and (100, 50) whose end tangents meet in (55, 95).
    if len(optical) != 1:
        sys.exit("STEP: the generatrix of degree 2 is not there once")
    for point, (r, z) in zip(optical[0], ((10, 99.5), (55, 95), (100, 50))):
        check("STEP by its text", f"control point r = {r}, mm", point[0], r, 1e-13)
        check("STEP by its text", f"control point z = {z}, mm", point[2], z, 1e-13)
    for name in ("'Lamp mirror'", "'optical surface'", "'body'", "Aluminium", "COLOUR_RGB"):
        if name not in text:
            sys.exit(f"STEP: no {name}")
    curves = [e for e in iges_parameters(f"{folder}/reflector.igs") if e[0] == "126" and e[1] == "2" and e[2] == "2"]
    numbers = [[float(x.replace("D", "E")) for x in e[7 + 6 + 3:7 + 6 + 3 + 9]] for e in curves]
    wanted = [10, 0, 99.5, 55, 0, 95, 100, 0, 50]
    best = min((max(abs(a - b) for a, b in zip(n, wanted)) for n in numbers), default=math.inf)
    check("IGES by its text", "control points, farthest off, mm", best, 0, 1e-12)
    check_mesh("STL by its bytes", stl_triangles(f"{folder}/reflector.stl"), 1, False, chord_mm)
    check_mesh("GLB by its bytes", glb_triangles(f"{folder}/reflector.glb"), 1e-3, True, chord_mm)


def by_gmsh(folder):
    sys.path.insert(0, "/usr/lib/python3/dist-packages")
    try:
        import gmsh
    except ImportError:
        return False
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    for name in ("step", "igs", "brep"):
        gmsh.model.add(name)
        occ = gmsh.model.occ
        occ.importShapes(f"{folder}/reflector.{name}")
        occ.synchronize()
        solids, faces = gmsh.model.getEntities(3), gmsh.model.getEntities(2)
        check(f"gmsh, {name}", "solids", len(solids), 1, 0)
        check(f"gmsh, {name}", "faces", len(faces), 6, 0)
        # gmsh integrates without an error bound; on this part it is good to 5e-9.
        check(f"gmsh, {name}", "volume, mm^3", sum(occ.getMass(*each) for each in solids), VOLUME, 1e-7 * VOLUME)
        check(f"gmsh, {name}", "area, mm^2", sum(occ.getMass(*each) for each in faces), AREA, 1e-7 * AREA)
        box = occ.getBoundingBox(*solids[0])
        for side, found, wanted in zip("x0 y0 z0 x1 y1 z1".split(), box, BOX):
            check(f"gmsh, {name}", f"box {side}, mm", found, wanted, 1e-6)
    gmsh.finalize()
    return True


def by_ezdxf(folder):
    sys.path.insert(0, "/usr/lib/python3/dist-packages")
    try:
        import ezdxf
    except ImportError:
        return False
    drawing = ezdxf.readfile(f"{folder}/reflector.dxf")
    audit = drawing.audit()
    check("ezdxf", "faults", len(audit.errors), 0, 0)
    check("ezdxf", "$INSUNITS", drawing.header["$INSUNITS"], 4, 0)
    on = {layer: [e for e in drawing.modelspace() if e.dxf.layer == layer]
          for layer in ("OPTICAL", "BACK", "EDGE", "FLANGE", "AXIS")}
    check("ezdxf", "curves", sum(map(len, on.values())), 7, 0)
    curve = on["OPTICAL"][0].construction_tool()
    far = max(abs(p.y - height(p.x)) for p in curve.approximate(200))
    check("ezdxf", "optical curve off the parabola, mm", far, 0, 1e-12)
    outer = on["BACK"][0].get_points("xy")

    def apart(x, y):  # distance to the parabola: its foot by Newton
        r = x
        for _ in range(50):
            f = (r - x) + (height(r) - y) * (-r / 100)
            r -= f / (1 + (r / 100) ** 2 - (height(r) - y) / 100)
        return math.hypot(x - r, y - height(r))
    off = max(abs(apart(*p) - WALL) for p in outer)
    check("ezdxf", "back off the wall's thickness, mm", off, 0, 1e-6)
    xs = [p.x for e in on["FLANGE"] for p in (e.dxf.start, e.dxf.end)]
    check("ezdxf", "flange's edge, mm", max(xs), RIM + FLANGE, 1e-12)
    check("ezdxf", "flange begins at the rim, mm", min(x for x in xs if abs(x - RIM) < 1e-9), RIM, 1e-12)
    return True


def by_admesh(folder, chord_mm):
    if not shutil.which("admesh"):
        return False
    said = subprocess.run(["admesh", "--no-check", f"{folder}/reflector.stl"], check=True, capture_output=True,
                          text=True).stdout
    volume = float(re.search(r"Volume\s*:\s*([-\d.eE+]+)", said)[1])
    check("admesh, STL", "volume, mm^3", volume, VOLUME, chord_mm * AREA)
    said = subprocess.run(["admesh", "--exact", "--normal-directions", f"{folder}/reflector.stl"], check=True,
                          capture_output=True, text=True).stdout
    for what in ("Total disconnected facets", "Facets reversed", "Edges fixed", "Degenerate facets"):
        line = re.search(re.escape(what) + r"\s*:\s*(\d+)(?:\s+(\d+))?", said)
        check("admesh, STL", what.lower(), int(line[1]), 0, 0)
    return True


def by_assimp(folder, chord_mm):
    if not shutil.which("assimp"):
        return False
    for name, count, scale in (("glb", len(glb_triangles(f"{folder}/reflector.glb")), 1e-3),
                               ("stl", len(stl_triangles(f"{folder}/reflector.stl")), 1.0)):
        said = subprocess.run(["assimp", "info", f"{folder}/reflector.{name}"], check=True, capture_output=True,
                              text=True).stdout
        check(f"assimp, {name}", "triangles", int(re.search(r"Faces:\s+(\d+)", said)[1]), count, 0)
        box = [tuple(map(float, re.search(rf"{which}imum point\s+\(([^)]*)\)", said)[1].split()))
               for which in ("Min", "Max")]
        for found, wanted in zip((box[0][0], box[1][0]), (-108 * scale, 108 * scale)):
            check(f"assimp, {name}", "box in x", found, wanted, chord_mm * scale)
    return True


def main():
    program = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        with open(f"{folder}/lamp.toml", "w", encoding="utf-8") as file:
            file.write(SCENE)
        formats = [word for name in ("step", "iges", "brep", "stl", "glb", "dxf") for word in ("--format", name)]
        said = subprocess.run([program, "export", f"{folder}/lamp.toml", "--out", folder] + formats, check=True,
                              capture_output=True, text=True).stdout
        chord_mm = float(re.search(r"stl: .*chord error ([\d.e+-]+) mm", said)[1])
        mass = float(re.search(r"mass ([\d.e+-]+) kg", said)[1])
        check("catoptric", "mass, kg", mass, 2700e-9 * VOLUME, 1e-6)
        own(folder, chord_mm)
        asked = [by_gmsh(folder), by_ezdxf(folder), by_admesh(folder, chord_mm), by_assimp(folder, chord_mm)]
    if "--table" in sys.argv:
        for reader, what, found, expected in seen:
            print(f"{reader:20} {what:40} {found:.12g} (expected {expected:.12g})")
    if not any(asked):
        print("none of gmsh, ezdxf, admesh, assimp is installed", file=sys.stderr)
        sys.exit(77)


main()
