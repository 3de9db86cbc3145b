"""Meshes with every triangle split in four, for the tables that ask for larger ones than there are."""

import math
import struct

import measuring as m


def read_ply(path):
    """Positions and triangles of a binary PLY file of floats x y z and lists of three."""
    header, body = path.read_bytes().split(b"end_header\n", 1)
    counts = {line.split()[1]: int(line.split()[2]) for line in header.decode().splitlines() if line.startswith("element")}
    positions = list(struct.iter_unpack("<3f", body[:12 * counts["vertex"]]))
    faces = body[12 * counts["vertex"]:]
    return positions, [f[1:] for f in struct.iter_unpack("<B3i", faces[:13 * counts["face"]])]


def write_ply(path, positions, triangles):
    header = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(positions)}\nproperty float x\nproperty float y\nproperty float z\n"
              f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n")
    path.write_bytes(header.encode() + b"".join(struct.pack("<3f", *p) for p in positions) + b"".join(struct.pack("<B3i", 3, *t) for t in triangles))


def vertex_normals(positions, triangles):
    sums = [[0.0, 0.0, 0.0] for _ in positions]
    for t in triangles:
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = (positions[v] for v in t)
        ux, uy, uz, vx, vy, vz = bx - ax, by - ay, bz - az, cx - ax, cy - ay, cz - az
        normal = (uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx)
        for v in t:
            for k in range(3):
                sums[v][k] += normal[k]
    return [[x / (math.hypot(*n) or 1) for x in n] for n in sums]


def split_at(positions, triangles, turned, midpoint):
    """Splits all triangles at `midpoint(a, b)` of their edges; turned: one of the new edges in each triangle is turned, so that the result is
    not taken for a subdivision surface."""
    positions, middle, fine = list(positions), {}, []

    def at(a, b):
        key = (a, b) if a < b else (b, a)
        if key not in middle:
            middle[key] = len(positions)
            positions.append(midpoint(a, b, len(positions)))
        return middle[key]

    for t in triangles:
        mids = [at(t[(k + 1) % 3], t[(k + 2) % 3]) for k in range(3)]
        if turned:  # opposite to the longest side
            k = max(range(3), key=lambda k: math.dist(positions[t[(k + 1) % 3]], positions[t[(k + 2) % 3]]))
            (c0, c1, c2), (m0, m1, m2) = (t[k:] + t[:k]), (mids[k:] + mids[:k])
            fine += [(c1, m0, m2), (c2, m1, m0), (c0, m2, m0), (c0, m0, m1)]
        else:
            fine += [(t[0], mids[2], mids[1]), (t[1], mids[0], mids[2]), (t[2], mids[1], mids[0]), tuple(mids)]
    return positions, fine


def split_in_four(positions, triangles, turned=True):
    """A rounder mesh with detail of its own: midpoints are drawn towards the tangent planes of both ends [Boubekeur, Alexa 2008] and go up
    and down a little."""
    normals = vertex_normals(positions, triangles)

    def midpoint(a, b, index):
        p, q, mean = positions[a], positions[b], [(x + y) / 2 for x, y in zip(positions[a], positions[b])]
        heights = [sum((x - o) * n for x, o, n in zip(mean, end, normal)) for end, normal in ((p, normals[a]), (q, normals[b]))]
        wave = 0.03 * math.dist(p, q) * math.sin(7919.0 * index)
        return tuple(x - 0.375 * (heights[0] * i + heights[1] * j) + wave * (i + j) / 2 for x, i, j in zip(mean, normals[a], normals[b]))

    return split_at(positions, triangles, turned, midpoint)


def split_flat(positions, triangles):
    """The same surface, as a subdivision surface."""
    return split_at(positions, triangles, False, lambda a, b, _: tuple((x + y) / 2 for x, y in zip(positions[a], positions[b])))


def write_stl(path, positions, triangles):
    with open(path, "wb") as file:
        file.write(bytes(80) + struct.pack("<I", len(triangles)))
        for t in triangles:
            file.write(struct.pack("<12fH", 0, 0, 0, *positions[t[0]], *positions[t[1]], *positions[t[2]], 0))


def write_obj(path, positions, triangles):
    with open(path, "w", encoding="ascii") as file:
        file.writelines(f"v {p[0]:.9g} {p[1]:.9g} {p[2]:.9g}\n" for p in positions)
        file.writelines(f"f {t[0] + 1} {t[1] + 1} {t[2] + 1}\n" for t in triangles)


WRITERS = {"ply": write_ply, "stl": write_stl, "obj": write_obj}


def prepare(data, name, folder, extension="ply"):
    """The file of a mesh, NAME or NAME:n for one with its triangles split in four n times; made where it is not there."""
    base, _, splits = name.partition(":")
    source = data / f"{base}.ply"
    if not splits and extension == "ply":
        return source
    path = folder / f"{base}_{splits or 0}.{extension}"
    positions, triangles = read_ply(source)
    for _ in range(int(splits or 0)):
        positions, triangles = split_in_four(positions, triangles)
    WRITERS[extension](path, positions, triangles)
    return path


def prepared(*arguments):
    """The same in a process of its own."""
    return m.in_own_process(prepare, *arguments)
