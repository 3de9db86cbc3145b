"""Meshes of many components, for the tables that ask how time and memory go with the number of those."""

import math
import random
import struct

PHI = (1 + math.sqrt(5)) / 2
# Corners within the unit sphere, and triangles.
SHAPES = {
    "triangle": ([(1, 0, 0), (-0.5, 0.8, 0), (-0.5, -0.8, 0)], [(0, 1, 2)]),
    "tetrahedron": ([(0.577, 0.577, 0.577), (0.577, -0.577, -0.577), (-0.577, 0.577, -0.577), (-0.577, -0.577, 0.577)],
                    [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]),
    "box": ([(0.577 * x, 0.577 * y, 0.577 * z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)],
            [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)]),
    "icosahedron": ([tuple(0.526 * c for c in p) for s in (-1, 1) for t in (-PHI, PHI) for p in ((0, s, t), (s, t, 0), (t, 0, s))], None),
}


def hull(points):
    """Outward triangles of a convex polyhedron that has no other faces."""
    def sub(a, b):
        return tuple(x - y for x, y in zip(a, b))

    def cross(a, b):
        return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])

    def dot(a, b):
        return sum(x * y for x, y in zip(a, b))

    faces = []
    for a in range(len(points)):
        for b in range(a + 1, len(points)):
            for c in range(a + 1, len(points)):
                normal = cross(sub(points[b], points[a]), sub(points[c], points[a]))
                if c != b and dot(normal, normal) > 1e-9 and all(dot(normal, sub(p, points[a])) < 1e-6 for p in points):
                    faces.append((a, b, c))
    return faces


def turned(points, rng):
    """Points turned at random."""
    while True:
        q = [rng.uniform(-1, 1) for _ in range(4)]
        square = sum(x * x for x in q)
        if 0.01 < square <= 1:
            break
    w, x, y, z = (v / math.sqrt(square) for v in q)
    rows = ((1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)), (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
            (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)))
    return [tuple(r[0] * p[0] + r[1] * p[1] + r[2] * p[2] for r in rows) for p in points]


def place(where, rng):
    if where == "cube":
        return [rng.uniform(-1, 1) for _ in range(3)]
    z, angle = rng.uniform(-1, 1), rng.uniform(0, 2 * math.pi)
    across = math.sqrt(1 - z * z)
    return [across * math.cos(angle), across * math.sin(angle), z]


def radius_of(count, where):
    """Of components that leave the space between them that they take, whatever their number."""
    spacing = (8 / count) ** (1 / 3) if where == "cube" else (4 * math.pi / count) ** 0.5
    return 0.3 * spacing


def write_components(path, shape, count, where="cube", scan=None, radius=None):
    """A binary PLY file of `count` copies of a shape at random places and angles in a cube, or near a unit sphere.
    scan: positions and triangles that come first."""
    rng = random.Random(count)
    corners, triangles = SHAPES[shape]
    triangles = triangles or hull(corners)
    radius = radius or radius_of(count, where)
    positions, faces = scan or ([], [])
    scaled = [tuple(radius * c for c in p) for p in corners]
    variants = [turned(scaled, rng) for _ in range(997)]
    pack_points, pack_faces = struct.Struct(f"<{3 * len(corners)}f"), struct.Struct("<" + "B3i" * len(triangles))
    with open(path, "wb") as file:
        file.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {len(positions) + count * len(corners)}\nproperty float x\nproperty float y\n"
                   f"property float z\nelement face {len(faces) + count * len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n".encode())
        for p in positions:
            file.write(struct.pack("<3f", *p))
        for i in range(count):
            x, y, z = place(where, rng)
            file.write(pack_points.pack(*(c for p in variants[i % len(variants)] for c in (p[0] + x, p[1] + y, p[2] + z))))
        for t in faces:
            file.write(struct.pack("<B3i", 3, *t))
        for i in range(count):
            first = len(positions) + i * len(corners)
            file.write(pack_faces.pack(*(word for a, b, c in triangles for word in (3, first + a, first + b, first + c))))
