#!/usr/bin/env python3
"""A second decoder, written from docs/format.md alone and laid out like it: plain, slow, without a third-party module.

reference_decoder.py GOLDEN.json...   decodes the .lac file beside each and compares coefficients and positions.
"""
import json
import math
import struct
import sys
import zlib


# --- Refinement header, segments ---

class Reader:
    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, size):
        if self.at + size > len(self.data):
            raise EOFError
        self.at += size
        return self.data[self.at - size:self.at]

    def unsigned(self, size):
        return int.from_bytes(self.take(size), "little")

    def varint(self):
        value = shift = 0
        while True:
            byte = self.unsigned(1)
            value |= (byte & 0x7F) << shift
            if byte < 0x80:
                return value
            shift += 7


def step_value(bits):
    return struct.unpack("<f", struct.pack("<I", bits << 16))[0]


def base_checksum(base):
    words = [value & 0xFFFFFFFF for row in base["lattice"] + base["triangles"] for value in row]
    return zlib.crc32(struct.pack("<%dI" % len(words), *words))


def read_header(reader, base):
    assert reader.take(3) == b"LAC" and reader.unsigned(1) == 1
    counts = reader.unsigned(1)
    assert counts >> 4 == 1 and 1 <= counts & 15 <= 12
    assert reader.varint() == len(base["lattice"]) and reader.varint() == len(base["triangles"])
    assert struct.unpack("<f", reader.take(4))[0] == base["step"]
    assert reader.unsigned(4) == base_checksum(base)
    levels = []
    for _ in range(counts & 15):
        normal, tangential = reader.unsigned(2), reader.unsigned(2)
        biases = reader.unsigned(1) if normal or tangential else 0
        levels.append({"normal": (normal, biases & 15), "tangential": (tangential, biases >> 4)})
    length = reader.varint()
    assert length <= 8 + 3 * (len(base["lattice"]) + 4 * len(base["triangles"])) // 2
    tags = reader.take(length)
    end = reader.at
    assert reader.unsigned(2) == zlib.crc32(reader.data[:end]) & 0xFFFF
    return levels, tags


def read_segment(reader, level):
    length, checksum = reader.varint(), reader.unsigned(2)
    payload = reader.take(length)
    assert zlib.crc32(bytes([level]) + payload) & 0xFFFF == checksum
    return payload


# --- Subdivision ---

class Level:
    """Tables of one level: edges as [first end, second end, first face, second face or None]."""

    def __init__(self, num_vertices, triangles, edges, face_edges, on_curve, corner, master):
        self.num_vertices, self.triangles, self.edges, self.face_edges = num_vertices, triangles, edges, face_edges
        self.on_curve, self.corner, self.master = on_curve, corner, master  # per edge, per vertex, per edge (None: no copy)
        self.at_vertex = [[] for _ in range(num_vertices)]
        for e, (a, b, _, _) in enumerate(edges):
            for v in (a, b):
                self.at_vertex[v].append(e)

    def curves(self, v):
        return [e for e in self.at_vertex[v] if self.on_curve[e]]

    def passes(self, v):
        """Whether one curve passes through v."""
        return len(self.curves(v)) == 2 and not self.corner[v]

    def faces(self, e):
        return [f for f in self.edges[e][2:] if f is not None]

    def across(self, f, e):
        first, second = self.edges[e][2:]
        return second if f == first else first

    def opposite(self, f, e):
        return self.triangles[f][self.face_edges[f].index(e)]

    def other_end(self, e, v):
        a, b = self.edges[e][:2]
        return b if v == a else a


def base_level(num_vertices, triangles):
    """Without creases, corners and joined borders."""
    edges, face_edges, known = [], [], {}
    for f, t in enumerate(triangles):
        row = []
        for k in range(3):
            a, b = t[(k + 1) % 3], t[(k + 2) % 3]
            if (b, a) in known:
                e = known[b, a]
                edges[e][3] = f
            else:
                e = known[a, b] = len(edges)
                edges.append([a, b, f, None])
            row.append(e)
        face_edges.append(row)
    border = [second is None for _, _, _, second in edges]
    return Level(num_vertices, triangles, edges, face_edges, border, [False] * num_vertices, [None] * len(edges))


def refine(c):
    V, E = c.num_vertices, len(c.edges)
    edges, triangles, face_edges = [], [], []
    corner_face = lambda f, v: None if f is None else 4 * f + c.triangles[f].index(v)
    for e, (a, b, first, second) in enumerate(c.edges):
        edges.append([a, V + e, corner_face(first, a), corner_face(second, a)])
        edges.append([b, V + e, corner_face(first, b), corner_face(second, b)])
    half = lambda e, v: 2 * e + (0 if c.edges[e][0] == v else 1)
    for f, t in enumerate(c.triangles):
        e = c.face_edges[f]
        mid = [V + x for x in e]
        inner = [2 * E + 3 * f + k for k in range(3)]
        for k in range(3):
            k1, k2 = (k + 1) % 3, (k + 2) % 3
            edges.append([mid[k2], mid[k1], 4 * f + k, 4 * f + 3])
            triangles.append([t[k], mid[k2], mid[k1]])
            face_edges.append([inner[k], half(e[k1], t[k]), half(e[k2], t[k])])
        triangles.append(mid)
        face_edges.append(inner)
    inner = [None] * (3 * len(c.triangles))
    on_curve = [c.on_curve[e // 2] for e in range(2 * E)] + [False] * len(inner)
    master = [None if c.master[e] is None else 2 * c.master[e] + end for e in range(E) for end in (0, 1)] + inner
    return Level(V + E, triangles, edges, face_edges, on_curve, c.corner + [False] * E, master)


# --- Range coder, bit models ---

class RangeDecoder:
    def __init__(self, payload):
        self.payload, self.at, self.range, self.code = payload, 0, 0xFFFFFFFF, 0
        for _ in range(4):
            self.shift()

    def shift(self):
        byte = self.payload[self.at] if self.at < len(self.payload) else 0
        self.at += 1
        self.code = self.code << 8 & 0xFFFFFFFF | byte

    def split(self, bound):
        bit = self.code < bound
        if bit:
            self.range = bound
        else:
            self.code -= bound
            self.range -= bound
        while self.range < 1 << 24:
            self.range <<= 8
            self.shift()
        return bit

    def bit(self, model):
        bit = self.split(self.range * model.probability() >> 16)
        model.update(bit)
        return bit

    def even(self):
        return self.split(self.range >> 1)


class Model:
    def __init__(self, initial=32768):
        self.fast = self.slow = initial * 256
        self.count = 0

    def probability(self):
        return min(max(self.fast + self.slow >> 9, 24), 65536 - 24)

    def update(self, bit):
        def move(estimate, n):
            weight = 65536 // (n + 2)
            return estimate + (((1 << 24) - estimate) * weight >> 16) if bit else estimate - (estimate * weight >> 16)
        self.fast, self.slow = move(self.fast, min(self.count, 24)), move(self.slow, min(self.count, 160))
        self.count = min(self.count + 1, 160)


# --- Base tags ---

def tagged_level(base, payload):
    """The level of the split triangles, and the tags."""
    lattice, triangles = base["lattice"], base["triangles"]
    tags = {"still": [], "crease": [], "corner": [], "joined": []}
    if not payload:
        return base_level(len(lattice), triangles), tags
    decoder = RangeDecoder(payload)
    if decoder.even():
        models, last = [Model(), Model()], 0
        for _ in triangles:
            last = int(decoder.bit(models[last]))
            tags["still"].append(last)
    level = base_level(len(lattice), [t for f, t in enumerate(triangles) if not any(tags["still"][f:f + 1])])
    assert level.triangles
    if decoder.even():
        models = [Model() for _ in range(6)]
        for e, (a, b, _, second) in enumerate(level.edges):
            if second is not None:
                fewer, more = sorted(min(len(level.curves(v)), 2) for v in (a, b))
                level.on_curve[e] = decoder.bit(models[more * (more + 1) // 2 + fewer])
            tags["crease"].append(int(level.on_curve[e] and second is not None))
    if decoder.even():
        model = Model()
        level.corner = [len(level.curves(v)) == 2 and decoder.bit(model) for v in range(len(lattice))]
        tags["corner"] = [int(x) for x in level.corner]
    if decoder.even():
        joined = tags["joined"] = [lattice.index(point) for point in lattice]
        masters = {}
        for e, edge in enumerate(level.edges):
            ends = joined[edge[0]], joined[edge[1]]
            if edge[3] is None and ends[0] != ends[1]:
                m = masters.setdefault(frozenset(ends), e)
                if m != e:
                    level.master[e] = m
                    if joined[level.edges[m][0]] != ends[0]:
                        edge[0], edge[1] = edge[1], edge[0]
    return level, tags


# --- Binarization ---

class SetModels:
    def __init__(self, initial):
        self.nonzero = [[Model(initial) for _ in range(6)] for _ in range(14)]
        self.unexpected_sign = [Model() for _ in range(8)]
        self.larger = [[Model() for _ in range(14)] for _ in range(14)]
        self.longer = [Model() for _ in range(19)]
        self.second_bit = [Model() for _ in range(19)]


def decode_coefficient(decoder, models, activity, companion, sign_class, expect_negative):
    if not decoder.bit(models.nonzero[activity][companion]):
        return 0
    negative = decoder.bit(models.unexpected_sign[sign_class]) != expect_negative
    m = 1
    while m <= 14 and decoder.bit(models.larger[activity][m - 1]):
        m += 1
    if m > 14:
        k = 0
        while k < 19 and decoder.bit(models.longer[k]):
            k += 1
        r = 1
        for i in range(k - 1, -1, -1):
            r = r << 1 | (decoder.bit(models.second_bit[k - 1]) if i == k - 1 else decoder.even())
        m = 14 + r
    return -m if negative else m


# --- Contexts ---

BOUNDS = (1, 3, 5, 8, 12, 17, 24, 36, 56, 90, 150, 260, 500)


def limit(x, low, high):
    return min(max(x, low), high)


def sign_of(x):
    return (x > 0) - (x < 0)


def forecasts(coarse, values, coarse_bits, fine_bits):
    """Forecast and parent's sign for every edge of the next finer level."""
    parents = []
    for e, value in enumerate(values):
        total, weight = 4 * abs(value), 4
        for f in coarse.faces(e):
            total += sum(abs(values[x]) for x in coarse.face_edges[f] if x != e)
            weight += 2
        t = 8 * total // weight * (128 + (coarse_bits & 127)) * 256 // (128 + (fine_bits & 127))
        u = limit((coarse_bits >> 7) - (fine_bits >> 7), -40, 24)
        parents.append((min((t << u) >> 8 if u >= 0 else t >> (8 - u), 65536), sign_of(value)))
    fine = [parents[e // 2] for e in range(2 * len(values))]
    for edges in coarse.face_edges:
        fine += [parents[e] for e in edges]
    return fine


def decode_set(level, parents, decode_edge):
    """decode_edge(e, activity, sign class, expect negative) gives the value that counts for contexts."""
    values = []
    sums, counts = [0] * level.num_vertices, [0] * level.num_vertices
    for e, (a, b, _, _) in enumerate(level.edges):
        if level.master[e] is not None:
            values.append(0)
            continue
        total, number, signed = sums[a] + sums[b], counts[a] + counts[b], 0
        for f in level.faces(e):
            for x in level.face_edges[f]:
                if x < e and level.master[x] is None:
                    total += abs(values[x])
                    number += 1
                    signed += values[x]
        parent_sign = 0
        total *= 16
        if parents is not None:
            forecast, parent_sign = parents[e]
            total += 2 * forecast
            number += 2
        expected = (total + number // 2) // number if number else 0
        direction = 3 * limit(signed, -2, 2) + parent_sign
        value = decode_edge(e, sum(bound <= expected for bound in BOUNDS), abs(direction), direction < 0)
        values.append(limit(value, -4096, 4096))
        for v in (a, b):
            sums[v] += abs(values[-1])
            counts[v] += 1
    return values


class CoefficientDecoder:
    def __init__(self):
        self.models = [SetModels(32768), SetModels(13107), SetModels(13107)]
        self.coarse = {}  # set -> (level tables, values, step bits)

    def decode(self, level, sets, payload):
        decoder = RangeDecoder(payload)
        normal, tangential = [0] * len(level.edges), [0] * 2 * len(level.edges)

        def normal_edge(e, activity, sign_class, expect_negative):
            normal[e] = decode_coefficient(decoder, self.models[0], activity, 3 * level.on_curve[e], sign_class, expect_negative)
            return normal[e]

        def tangential_edge(e, activity, _sign_class, _expect_negative):
            n, curve = abs(normal[e]), 3 * level.on_curve[e]
            companion = curve + (0 if n == 0 else 1 if n < 3 else 2)
            first = decode_coefficient(decoder, self.models[1], activity, companion, 0, False)
            companion = curve + (2 if first else 1 if n else 0)
            second = decode_coefficient(decoder, self.models[2], activity, companion, 0, False)
            tangential[2 * e:2 * e + 2] = first, second
            return abs(first) + abs(second)

        for name, decode_edge in (("normal", normal_edge), ("tangential", tangential_edge)):
            bits = sets[name][0]
            coarse = self.coarse.pop(name, None)
            if bits:
                parents = forecasts(*coarse, bits) if coarse else None
                self.coarse[name] = (level, decode_set(level, parents, decode_edge), bits)
        return normal, tangential


# --- Dequantization, prediction, local frames ---

def add(*vectors):
    return [sum(c) for c in zip(*vectors)]


def scale(a, s):
    return [x * s for x in a]


def sub(a, b):
    return [x - y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    length = math.sqrt(dot(a, a))
    return scale(a, 1 / length) if length > 0 else [0.0, 0.0, 0.0]


def dequantize(q, bits, bias):
    return sign_of(q) * (abs(q) - bias / 32) * step_value(bits) if q else 0.0


def stencil(level, e):
    if level.master[e] is not None:
        e = level.master[e]
    a, b, _, _ = level.edges[e]
    if level.on_curve[e]:
        def beyond(v):
            return level.other_end(next(x for x in level.curves(v) if x != e), v)
        if level.passes(a) and level.passes(b):
            return [(a, 9 / 16), (beyond(a), -1 / 16), (b, 9 / 16), (beyond(b), -1 / 16)]
        if level.passes(a) or level.passes(b):
            corner, other = (b, a) if level.passes(a) else (a, b)
            return [(corner, 3 / 8), (other, 3 / 4), (beyond(other), -1 / 8)]
        return [(a, 1 / 2), (b, 1 / 2)]
    odd = [v for v in (a, b) if len(level.at_vertex[v]) != 6 and len(level.at_vertex[v]) <= 256]
    if level.curves(a) or level.curves(b) or not odd:
        result = [(a, 1 / 2), (b, 1 / 2)]
        for f in level.faces(e):
            k = level.face_edges[f].index(e)
            c = level.triangles[f][k]
            result.append((c, 1 / 8))
            for wing_corner in ((k + 1) % 3, (k + 2) % 3):
                wing = level.face_edges[f][wing_corner]
                if not level.on_curve[wing]:
                    result.append((level.opposite(level.across(f, wing), wing), -1 / 16))
                else:
                    p = level.triangles[f][wing_corner]
                    r = b if p == a else a
                    result += [(r, -1 / 16), (c, -1 / 16), (p, 1 / 16)]
        return result
    result = []
    for v in odd:
        K = len(level.at_vertex[v])
        if K == 2:
            weights = [3 / 8, -1 / 8]
        elif K == 3:
            weights = [5 / 12, -1 / 12, -1 / 12]
        elif K == 4:
            weights = [3 / 8, 0, -1 / 8, 0]
        else:
            weights = [(0.25 + math.cos(2 * math.pi * j / K) + 0.5 * math.cos(4 * math.pi * j / K)) / K for j in range(K)]
        result.append((v, 0.75 / len(odd)))
        spoke, face = e, level.edges[e][2]
        for w in weights:
            result.append((level.other_end(spoke, v), w / len(odd)))
            spoke = next(x for x in level.face_edges[face] if x != spoke and v in level.edges[x][:2])
            face = level.across(face, spoke)
    return result


def synthesize(level, sets, normal, tangential, positions):
    middles = [add(*(scale(positions[v], w) for v, w in stencil(level, e))) for e in range(len(level.edges))]
    normals = [[0.0, 0.0, 0.0] for _ in middles]
    for t, edges in zip(level.triangles, level.face_edges):
        m = [middles[e] for e in edges]
        corner = [cross(sub(m[(k + 2) % 3], positions[t[k]]), sub(m[(k + 1) % 3], positions[t[k]])) for k in range(3)]
        middle = cross(sub(m[1], m[0]), sub(m[2], m[0]))
        for k in range(3):
            normals[edges[k]] = add(normals[edges[k]], middle, corner[(k + 1) % 3], corner[(k + 2) % 3])
    for e, (a, b, _, _) in enumerate(level.edges):
        if level.master[e] is not None:
            positions.append(positions[level.num_vertices + level.master[e]])
            continue
        n = unit(normals[e])
        if n == [0.0, 0.0, 0.0]:
            n = [0.0, 0.0, 1.0]
        along = unit(sub(positions[b], positions[a]))
        t1 = sub(along, scale(n, dot(along, n)))
        if dot(t1, t1) <= 1e-6:
            axis = min(range(3), key=lambda i: (abs(n[i]), i))
            t1 = [float(i == axis) for i in range(3)]
            t1 = sub(t1, scale(n, dot(t1, n)))
        t1 = unit(t1)
        t2 = cross(n, t1)
        d1, d2 = (dequantize(q, *sets["tangential"]) for q in tangential[2 * e:2 * e + 2])
        positions.append(add(middles[e], scale(t1, d1), scale(t2, d2), scale(n, dequantize(normal[e], *sets["normal"]))))


# --- The decoder on one page ---

def decode(base, data):
    reader = Reader(data)
    positions = [[value * base["step"] for value in point] for point in base["lattice"]]
    coefficients = []
    coefficient_decoder = CoefficientDecoder()
    steps, payload = read_header(reader, base)
    level, tags = tagged_level(base, payload)
    for number, sets in enumerate(steps, 1):
        normal, tangential = coefficient_decoder.decode(level, sets, read_segment(reader, number))
        synthesize(level, sets, normal, tangential, positions)
        coefficients.append({"normal": normal, "tangential": tangential})
        level = refine(level)
    return tags, coefficients, positions


def main(paths):
    for path in paths:
        with open(path, encoding="utf-8") as file:
            golden = json.load(file)
        with open(path[:-len("json")] + "lac", "rb") as file:
            tags, coefficients, positions = decode(golden["base"], file.read())
        assert tags == golden["base"].get("tags", dict.fromkeys(tags, [])), path + ": tags differ"
        assert coefficients == golden["levels"], path + ": coefficients differ"
        assert len(positions) == len(golden["positions"]), path + ": numbers of positions differ"
        size = max(abs(x) for p in golden["positions"] for x in p)
        worst = max(abs(x - y) for p, q in zip(positions, golden["positions"]) for x, y in zip(p, q))
        assert worst <= 1e-4 * size, "%s: a position is off by %g" % (path, worst)
        print("%s: %d levels, %d vertices, largest difference %.2g" % (path, len(coefficients), len(positions), worst / size))
    assert paths, "no golden stream given"


if __name__ == "__main__":
    main(sys.argv[1:])
