#!/usr/bin/env python3
"""A second decoder, written from docs/format.md alone and laid out like it: plain, slow, without a third-party module.

reference_decoder.py GOLDEN.json...   decodes the .lac file beside each and compares coefficients and positions, or the compact base
                                      in the .cbase file beside it and compares lattice and triangles.
"""
import binascii
import itertools
import json
import math
import struct
import sys


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

    def signed_varint(self):
        folded = self.varint()
        return folded >> 1 ^ -(folded & 1)


def crc16(data):
    return binascii.crc_hqx(data, 0xFFFF)


def step_value(bits):
    return struct.unpack("<f", struct.pack("<I", bits << 16))[0]


def base_checksum(base):
    words = [value & 0xFFFFFFFF for row in base["lattice"] + base["triangles"] for value in row]
    words += base.get("group_sizes", [])
    data = struct.pack("<f%dI" % len(words), base["step"], *words)
    for attribute in base.get("attributes", []):
        data += bytes(attribute["in_group"])
        used = sorted({v for f in faces_with(base, attribute) for v in base["triangles"][f]})
        data += b"".join(struct.pack("<i", x) for v in used for x in integers_at(base, attribute, v))
    return crc16(data)


def next_step(bits):
    """1.2 times as large."""
    significand, exponent = 128 + (bits & 127), bits >> 7
    grown = rounded(6 * significand, 5)
    if grown >= 256:
        grown, exponent = rounded(3 * significand, 5), exponent + 1
    return min(128 * exponent + grown - 128, 0x7F7F)


def read_steps(reader, num_levels):
    flags = []
    for _ in range((num_levels + 1) // 2):
        byte = reader.unsigned(1)
        flags += [byte & 15, byte >> 4]
    assert not any(flags[num_levels:])
    levels, normal = [], reader.unsigned(2)

    def checked(step):
        assert 0x0080 <= step <= 0x7F7F
        return step

    checked(normal)
    for has in flags[:num_levels]:
        assert has & 3 or not has
        difference = reader.signed_varint if has & 4 else lambda: 0
        if has & 1:
            normal = checked(normal + difference())
        tangential = checked(normal + 128 + difference()) if has & 2 else 0
        biases = reader.unsigned(1) if has & 8 else 0
        levels.append({"normal": (normal if has & 1 else 0, biases & 15), "tangential": (tangential, biases >> 4)})
        normal = next_step(normal)
    return levels


def read_attributes(reader, num_levels):
    attributes = []
    for _ in range(reader.varint()):
        kind, flags, components = reader.unsigned(1), reader.unsigned(1), reader.varint()
        prediction, chained = flags & ~4, flags & 4 != 0
        name = reader.take(reader.unsigned(1)).decode()
        assert kind <= 5 and prediction <= 2 and (prediction < 2 or kind == 1) and components > 0
        assert chained <= (kind == 3 and components >= 3)
        assert kind != 1 or components == 3
        assert kind != 2 or components in (3, 4)
        precision = reader.unsigned(1 if kind == 1 else 2)
        assert 2 <= precision <= 16 if kind == 1 else 0x0080 <= precision <= 0x7F7F
        coded, step, steps = reader.varint(), 0x3A80, []
        assert coded >> num_levels == 0
        for i in range(num_levels):
            if coded >> i & 1:
                step += reader.signed_varint()
                assert 0x0080 <= step <= 0x7F7F
            steps.append(step if coded >> i & 1 else 0)
        attributes.append({"kind": kind, "prediction": prediction, "chained": chained, "components": components, "name": name, "precision": precision, "steps": steps})
    assert sum(a["components"] for a in attributes) <= 1024
    return attributes


def read_header(reader, base):
    assert reader.take(3) == b"LAC"
    version = reader.unsigned(1)
    assert version & 15 == 1
    counts = reader.unsigned(1)
    assert 1 <= counts & 15 <= 12 and version >> 4 <= counts & 15
    if counts & 32:
        assert step_value(reader.unsigned(2)) == base["step"]
    assert reader.unsigned(2) == base_checksum(base)
    levels = read_steps(reader, counts & 15)
    for number, level in enumerate(levels, 1):
        level["curved"] = number <= version >> 4
    length = 0
    if counts & 16:
        length = reader.varint()
        assert 0 < length <= 8 + 3 * (len(base["lattice"]) + 4 * len(base["triangles"])) // 2
    tags = reader.take(length)
    assert counts & 192 != 192
    attributes = read_attributes(reader, counts & 15) if counts & 128 else None
    end = reader.at
    assert reader.unsigned(2) == crc16(reader.data[:end])
    return levels, tags, counts & 64 != 0, attributes


def read_segment(reader, what):
    length, checksum = reader.varint(), reader.unsigned(2)
    payload = reader.take(length)
    assert crc16(bytes([what]) + payload) == checksum
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
    def __init__(self, initial=32768, count=0):
        self.fast = self.slow = initial * 256
        self.count = count

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

# Initial probabilities in 1/256: nonzero[a][c mod 3], unexpected_sign[g], larger[a][min(m - 1, 3)].
NORMAL_PRIORS = (
    ((2, 1, 3), (9, 1, 17), (28, 7, 46), (65, 24, 86), (106, 56, 126), (146, 98, 160), (172, 135, 185), (198, 169, 207), (217, 194, 223),
     (231, 214, 235), (240, 229, 242), (245, 241, 249), (249, 245, 250), (251, 246, 253)),
    (132, 91, 100, 83, 47, 76, 84, 41),
    ((88, 123, 183, 188), (27, 33, 70, 139), (24, 57, 88, 113), (37, 56, 72, 138), (58, 67, 80, 127), (81, 84, 91, 127), (111, 110, 110, 135),
     (146, 141, 144, 155), (179, 174, 178, 181), (203, 200, 200, 205), (221, 220, 218, 219), (233, 234, 231, 230), (243, 243, 242, 239),
     (245, 246, 246, 246)))
TANGENTIAL_PRIORS = (
    ((3, 5, 9), (2, 6, 14), (6, 13, 23), (9, 16, 34), (12, 21, 39), (19, 22, 41), (19, 26, 50), (25, 28, 55), (31, 31, 56), (32, 33, 72),
     (28, 35, 70), (34, 47, 101), (55, 55, 130), (63, 61, 135)),
    (128, 128, 128, 128, 128, 128, 128, 128),
    ((178, 189, 182, 210), (120, 148, 138, 204), (116, 142, 163, 202), (126, 137, 143, 199), (157, 143, 154, 195), (170, 158, 147, 191),
     (191, 173, 168, 183), (198, 186, 157, 190), (217, 192, 207, 192), (217, 210, 197, 207), (224, 235, 225, 219), (208, 242, 231, 223),
     (196, 231, 237, 241), (180, 234, 232, 246)))
USUAL_PRIORS = (tuple((row[0],) * 3 for row in NORMAL_PRIORS[0]),) + NORMAL_PRIORS[1:]


class SetModels:
    def __init__(self, priors):
        def begin(probability):
            return Model(probability << 8, 16)
        nonzero, unexpected_sign, larger = priors
        self.nonzero = [[begin(row[c % 3]) for c in range(6)] for row in nonzero]
        self.unexpected_sign = [begin(p) for p in unexpected_sign]
        self.larger = [[begin(row[min(m, 3)]) for m in range(14)] for row in larger]
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
    return hand_down(coarse, parents)


def hand_down(coarse, parents):
    fine = [parents[e // 2] for e in range(2 * len(parents))]
    for edges in coarse.face_edges:
        fine += [parents[e] for e in edges]
    return fine


def length_classes(level, lattice):
    squares = [sum((x - y) ** 2 for x, y in zip(lattice[a], lattice[b])) for a, b, _, _ in level.edges]
    total, count = sum(squares) % 2 ** 64, len(squares)
    return [1 if 2 * s * count % 2 ** 64 < total else 2 if 2 * s * count % 2 ** 64 > 3 * total % 2 ** 64 else 0 for s in squares]


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
        self.models = [SetModels(NORMAL_PRIORS), SetModels(TANGENTIAL_PRIORS), SetModels(TANGENTIAL_PRIORS)]
        self.coarse = {}  # set -> (level tables, values, step bits)
        self.lengths = None  # classes of the edges of the level to come, or None: all usual

    def decode(self, level, sets, decoder):
        normal, tangential = [0] * len(level.edges), [0] * 2 * len(level.edges)
        lengths = self.lengths or [0] * len(level.edges)
        self.lengths = hand_down(level, lengths) if self.lengths and sets["normal"][0] else None

        def normal_edge(e, activity, sign_class, expect_negative):
            companion = lengths[e] + 3 * level.on_curve[e]
            normal[e] = decode_coefficient(decoder, self.models[0], activity, companion, sign_class, expect_negative)
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


# --- Layers ---

class LayeredLevel:
    def __init__(self, level, sets):
        self.level, self.sets = level, sets
        self.shift = None  # until its first segment
        self.normal, self.tangential = [0] * len(level.edges), [0] * 2 * len(level.edges)
        self.zero = [SetModels(USUAL_PRIORS), SetModels(TANGENTIAL_PRIORS), SetModels(TANGENTIAL_PRIORS)]
        self.told = [SetModels(NORMAL_PRIORS), SetModels(TANGENTIAL_PRIORS), SetModels(TANGENTIAL_PRIORS)]
        for models in self.told:
            even = SetModels.__new__(SetModels)
            even.nonzero = [[Model() for _ in row] for row in models.nonzero]
            even.unexpected_sign = [Model() for _ in models.unexpected_sign]
            even.larger = [[Model() for _ in row] for row in models.larger]
            models.__dict__.update(even.__dict__)

    def step_bits(self, name):
        bits = self.sets[name][0]
        return bits + 128 * self.shift if bits and self.shift is not None else 0

    def counted(self, name):
        """What counts for contexts, per edge."""
        values = self.normal
        if name == "tangential":
            values = [abs(a) + abs(b) for a, b in zip(self.tangential[::2], self.tangential[1::2])]
        return [limit(v, -4096, 4096) for v in values]


def take_layer_segment(reader, levels, first_decoder):
    what = reader.unsigned(1)
    number, shift = what & 15, what >> 4 & 7
    payload = read_segment(reader, what)
    at = levels[number - 1]
    coarse = {}
    for name in ("normal", "tangential"):
        if number > 1 and levels[number - 2].step_bits(name):
            below = levels[number - 2]
            coarse[name] = (below.level, below.counted(name), below.step_bits(name))
    drop = None if at.shift is None else at.shift - shift
    assert drop is None or drop > 0
    at.shift = shift
    if drop is None:
        first_decoder.coarse = coarse
        sets = {name: (at.step_bits(name),) for name in ("normal", "tangential")}
        at.normal, at.tangential = first_decoder.decode(at.level, sets, RangeDecoder(payload))
        return
    decoder = RangeDecoder(payload)
    normal, tangential = [0] * len(at.normal), [0] * len(at.tangential)

    def refined(k, known, activity, companion, sign_class, expect_negative):
        if known == 0:
            return decode_coefficient(decoder, at.zero[k], activity, companion, sign_class, expect_negative)
        m = abs(known)
        return known * 2 ** drop + decode_coefficient(decoder, at.told[k], drop, min(m, 3) - 1, 1 if m == 1 else 2, known < 0)

    def normal_edge(e, activity, sign_class, expect_negative):
        around = sum(1 for f in at.level.faces(e) for x in at.level.face_edges[f] if x != e and at.normal[x] != 0)
        companion = min(around, 2) + 3 * at.level.on_curve[e]
        normal[e] = refined(0, at.normal[e], activity, companion, sign_class, expect_negative)
        return normal[e]

    def tangential_edge(e, activity, _sign_class, _expect_negative):
        n, curve = abs(normal[e]), 3 * at.level.on_curve[e]
        first = refined(1, at.tangential[2 * e], activity, curve + (0 if n == 0 else 1 if n < 3 else 2), 0, False)
        second = refined(2, at.tangential[2 * e + 1], activity, curve + (2 if first else 1 if n else 0), 0, False)
        tangential[2 * e:2 * e + 2] = first, second
        return abs(first) + abs(second)

    for name, decode_edge in (("normal", normal_edge), ("tangential", tangential_edge)):
        bits = at.step_bits(name)
        if bits:
            decode_set(at.level, forecasts(*coarse[name], bits) if name in coarse else None, decode_edge)
    at.normal, at.tangential = normal, tangential


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


def curve_heights(level, normals, middles, positions):
    """How far midpoints move along their normals, on a curved level."""
    at_vertices = [[0.0, 0.0, 0.0] for _ in range(level.num_vertices)]
    for t in level.triangles:
        sides = [unit(sub(positions[t[(k + 2) % 3]], positions[t[(k + 1) % 3]])) for k in range(3)]
        for k in range(3):
            at_vertices[t[k]] = add(at_vertices[t[k]], cross(sides[(k + 1) % 3], sides[(k + 2) % 3]))
    at_vertices = [unit(n) for n in at_vertices]
    heights = []
    for e, (a, b, _, _) in enumerate(level.edges):
        side = sub(positions[b], positions[a])
        hermite = scale(sub(*(scale(at_vertices[v], dot(side, at_vertices[v])) for v in (b, a))), 1 / 8)
        middle = scale(add(positions[a], positions[b]), 1 / 2)
        if level.curves(a) or level.curves(b):
            heights.append(0.0)
            continue
        opposite = [sub(positions[level.opposite(f, e)], middle) for f in level.faces(e)]
        wings = [sub(positions[level.opposite(level.across(f, x), x)], middle)
                 for f in level.faces(e) for x in level.face_edges[f] if x != e and not level.on_curve[x]]
        around = add(scale(add(*opposite), 3 / 128), scale(add([0.0] * 3, *wings), -1 / 32 / max(1, len(wings))))
        heights.append(dot(sub(add(hermite, around), sub(middles[e], middle)), normals[e]))
    return heights


def synthesize(level, sets, normal, tangential, positions):
    middles = [add(*(scale(positions[v], w) for v, w in stencil(level, e))) for e in range(len(level.edges))]
    normals = [[0.0, 0.0, 0.0] for _ in middles]
    for t, edges in zip(level.triangles, level.face_edges):
        m = [middles[e] for e in edges]
        corner = [cross(sub(m[(k + 2) % 3], positions[t[k]]), sub(m[(k + 1) % 3], positions[t[k]])) for k in range(3)]
        middle = cross(sub(m[1], m[0]), sub(m[2], m[0]))
        for k in range(3):
            normals[edges[k]] = add(normals[edges[k]], middle, corner[(k + 1) % 3], corner[(k + 2) % 3])
    normals = [n if n != [0.0, 0.0, 0.0] else [0.0, 0.0, 1.0] for n in map(unit, normals)]
    heights = curve_heights(level, normals, middles, positions) if sets["curved"] else [0.0] * len(middles)
    for e, (a, b, _, _) in enumerate(level.edges):
        if level.master[e] is not None:
            positions.append(positions[level.num_vertices + level.master[e]])
            continue
        n = normals[e]
        along = unit(sub(positions[b], positions[a]))
        t1 = sub(along, scale(n, dot(along, n)))
        if dot(t1, t1) <= 1e-6:
            axis = min(range(3), key=lambda i: (abs(n[i]), i))
            t1 = [float(i == axis) for i in range(3)]
            t1 = sub(t1, scale(n, dot(t1, n)))
        t1 = unit(t1)
        t2 = cross(n, t1)
        d1, d2 = (dequantize(q, *sets["tangential"]) for q in tangential[2 * e:2 * e + 2])
        positions.append(add(middles[e], scale(t1, d1), scale(t2, d2), scale(n, heights[e] + dequantize(normal[e], *sets["normal"]))))


# --- Integers of the compact base ---

class LengthModels:
    def __init__(self):
        self.longer = [Model() for _ in range(31)]
        self.second_bit = [Model() for _ in range(31)]


def decode_by_length(decoder, models):
    bits = 0
    while bits < 30 and decoder.bit(models.longer[bits]):
        bits += 1
    number = 1
    for i in reversed(range(bits)):
        number = number << 1 | int(decoder.bit(models.second_bit[bits]) if i + 1 == bits else decoder.even())
    return number - 1


def decode_uniform(decoder, count):
    first = 0
    while count > 1:
        upper = count // 2
        lower = count - upper
        if decoder.bit(Model((upper << 16) // count)):
            first, count = first + lower, upper
        else:
            count = lower
    return first


# --- Connectivity of the compact base ---

class Entry:
    def __init__(self, vertex, free):
        self.vertex, self.free = vertex, free


class Connectivity:
    LARGE = [57000, 51000, 39000, 31000, 20000, 43000]
    LARGER = [(37000, 18000, 10000), (24500, 13000, 8000), (22000, 12000, 8000), (22600, 17000, 17000), (16000, 8000, 8000),
              (27000, 17000, 15000)]
    SMALLER = [(12000, 9000), (3200, 6300), (2300, 11700), (4700, 19600), (2700, 20800), (12000, 13000)]

    def __init__(self, decoder, num_vertices, num_borders):
        self.decoder, self.num_vertices, self.num_borders = decoder, num_vertices, num_borders
        self.large = [Model(p, 16) for p in self.LARGE]
        self.larger = [[Model(p[min(i, 2)], 16) for i in range(10)] for p in self.LARGER]
        self.smaller = [[Model(x, 16) for x in p] for p in self.SMALLER]
        self.dummy, self.joins = Model(600, 16), [Model(130, 16), Model(470, 16)]
        self.joins_far, self.join_distance = Model(), LengthModels()
        self.huge, self.dummy_valence = LengthModels(), LengthModels()
        self.valence, self.dummies, self.triangles, self.live, self.changes = [], 0, [], [], 0

    def decode_valence(self, context):
        if self.decoder.bit(self.large[context]):
            valence = 6
            while valence < 16 and self.decoder.bit(self.larger[context][valence - 6]):
                valence += 1
            return valence if valence < 16 else valence + decode_by_length(self.decoder, self.huge)
        valence = 5
        while valence > 3 and self.decoder.bit(self.smaller[context][valence - 4]):
            valence -= 1
        return valence

    def new_vertex(self, valence):
        assert len(self.valence) < self.num_vertices
        self.valence.append(valence)
        return len(self.valence) - 1

    def is_dummy(self, vertex):
        return vertex >= self.num_vertices

    def add_triangle(self, *t):
        assert len(set(t)) == 3 and sum(map(self.is_dummy, t)) <= 1
        if not any(map(self.is_dummy, t)):
            self.triangles.append(list(t))

    def set_free(self, entry, free):
        self.changes += 1
        entry.free, entry.changed = free, self.changes

    def make(self, vertex, free):
        entry = Entry(vertex, free)
        self.live.append(entry)
        self.set_free(entry, free)
        return entry

    @staticmethod
    def link(a, b):
        a.next, b.prev = b, a

    def remove(self, entry):
        self.link(entry.prev, entry.next)
        place = self.live.index(entry)
        self.live[place] = self.live[-1]
        self.live.pop()

    def decode(self):
        while len(self.valence) < self.num_vertices:
            valences = [self.decode_valence(5) for _ in range(3)]
            t = [self.new_vertex(x) for x in valences]
            self.add_triangle(*t)
            entries = [self.make(v, x - 2) for v, x in zip(t, valences)]
            for k in range(3):
                self.link(entries[k], entries[(k + 1) % 3])
            while self.live:
                focus = min(self.live, key=lambda e: (e.free, -e.changed))
                (self.extend if focus.free else self.close)(focus)
        assert self.dummies == self.num_borders
        return self.triangles

    def close(self, focus):
        before, after = focus.prev, focus.next
        self.add_triangle(after.vertex, focus.vertex, before.vertex)
        if after.next is before:
            assert before.free == after.free == 0
            for entry in (focus, before, after):
                self.remove(entry)
            return
        assert before.free and after.free
        self.set_free(before, before.free - 1)
        self.set_free(after, after.free - 1)
        self.remove(focus)

    def extend(self, focus):
        after = focus.next
        joins = len(self.live) >= 5 and self.decoder.bit(self.joins[focus.free > 1])
        assert after.free
        if joins:
            return self.join(focus)
        if self.is_dummy(focus.vertex) or self.is_dummy(after.vertex):
            context = 4
        else:
            total = self.valence[focus.vertex] + self.valence[after.vertex]
            context = (total >= 11) + (total >= 13) + (total >= 15)
        self.set_free(after, after.free - 1)
        self.set_free(focus, focus.free - 1)
        if self.dummies < self.num_borders and self.decoder.bit(self.dummy):
            valence = 3 + decode_by_length(self.decoder, self.dummy_valence)
            vertex = self.num_vertices + self.dummies
            self.dummies += 1
        else:
            valence = self.decode_valence(context)
            vertex = self.new_vertex(valence)
        self.add_triangle(after.vertex, focus.vertex, vertex)
        entry = self.make(vertex, valence - 2)
        self.link(focus, entry)
        self.link(entry, after)

    def near(self, focus):
        def walk(entry, step, end):
            found = []
            while entry is not end and entry is not focus and entry is not focus.next and len(found) < 16:
                found.append(entry)
                entry = getattr(entry, step)
            return found
        forward = walk(focus.next.next.next, "next", focus.prev)
        backward = walk(focus.prev.prev, "prev", focus.next.next)
        result = []
        for i in range(16):
            for entry in forward[i:i + 1] + backward[i:i + 1]:
                if entry.free >= 2 and entry not in result:
                    result.append(entry)
        return result

    def join(self, focus):
        after, near = focus.next, self.near(focus)
        if not near or self.decoder.bit(self.joins_far):
            target = self.live[decode_uniform(self.decoder, len(self.live))]
        else:
            target = near[decode_by_length(self.decoder, self.join_distance)]
        assert target not in (focus, after, focus.prev, after.next) and target.free >= 2
        rest = target.free - 2
        first = decode_uniform(self.decoder, rest + 1)
        self.add_triangle(after.vertex, focus.vertex, target.vertex)
        self.set_free(after, after.free - 1)
        self.set_free(focus, focus.free - 1)
        before_target = target.prev
        other = self.make(target.vertex, rest - first)
        self.link(focus, target)
        self.link(before_target, other)
        self.link(other, after)
        self.set_free(target, first)


# --- Positions of the compact base ---

TURNS = [-896, -512, -128, 109, 256, 350, 415, 460, 493, 518, 536, 551, 563, 574, 581, 587, 593, 598, 602, 605, 608, 611, 614]
LATTICE_LIMIT = (1 << 24) - 1
USUAL_ROOT, LARGEST_SPREAD = 2896, 1 << 31


def rounded(a, b):
    return (a + b // 2) // b


def scaled_to(v, bits):
    shift = max(0, max(map(abs, v)).bit_length() - 24)
    v = [x >> shift for x in v]
    length = math.isqrt(sum(x * x for x in v))
    return [x * (1 << bits) // length if length else 0 for x in v]


class Positions:
    FIRST, OTHER = [25000, 35000, 45000, 51500, 55500, 45000], [8000, 14000, 25500, 35500, 44000, 39000]

    def __init__(self, level, origin, extent_bits):
        self.level, self.origin = level, origin
        n = level.num_vertices
        self.flap = [[a, b] + [level.opposite(f, e) for f in level.faces(e)] for e, (a, b, _, _) in enumerate(level.edges)]
        self.flaps_of = [[] for _ in range(n)]
        for e, flap in enumerate(self.flap):
            for v in flap if len(flap) == 4 else []:
                self.flaps_of[v].append(e)
        whole = [2 * (len(es) - 1) if any(level.on_curve[e] for e in es) else len(es) for es in level.at_vertex]
        self.turn = [TURNS[min(max(x, 2), 24) - 2] for x in whole]
        self.neighbors = [[level.other_end(e, v) for e in es] for v, es in enumerate(level.at_vertex)]
        self.point, self.last = [None] * n, None
        self.num_flaps, self.num_neighbors, self.weight = [0] * n, [0] * n, [0] * n
        self.target, self.normal = [[0] * 3 for _ in range(n)], [[0] * 3 for _ in range(n)]
        extent = 16 << extent_bits
        edge = extent // (1 + math.isqrt(n))
        self.overall = {"flaps": [edge // 2, edge // 4, 1], "neighbors": [edge, edge, 1], "nothing": [extent // 2, extent // 2, 1]}
        self.seen = [None] * n
        self.farther = [[[Model(self.FIRST[s] if b == 0 else self.OTHER[s] if b < 6 else max(self.OTHER[s], 40000), 24)
                          for b in range(14)] for s in range(6)] for _ in range(3)]
        self.far = [LengthModels() for _ in range(3)]

    def set_point(self, v, point):
        self.point[v] = point
        self.last = v
        for u in self.neighbors[v]:
            if self.point[u] is None:
                self.num_neighbors[u] += 1
                if self.num_neighbors[u] <= 512:
                    self.target[u] = [t + (x << 20) for t, x in zip(self.target[u], point)]
                    self.weight[u] += 1 << 20
        for e in self.flaps_of[v]:
            unknown = [i for i in range(4) if self.point[self.flap[e][i]] is None]
            if len(unknown) == 1:
                self.use_flap(self.flap[e], unknown[0])

    def use_flap(self, flap, unknown):
        v = flap[unknown]
        if self.num_flaps[v] == 256:
            return
        self.num_flaps[v] += 1
        for end in range(2):
            t = self.turn[flap[end]]
            factors = [-t, -t, 256, 256]
            factors[end] = t - 512
            weight = (1 << 24) // sum(x * x for x in factors)
            mine = factors[unknown]
            for c in range(3):
                rest = sum(factors[i] * self.point[flap[i]][c] for i in range(4) if i != unknown)
                self.target[v][c] -= weight * mine * rest
            self.weight[v] += weight * mine * mine
        a, b, c = [self.point[flap[i]] for i in range(4) if i != unknown]
        sign = 1 if unknown in (0, 3) else -1
        self.normal[v] = [x + sign * y for x, y in zip(self.normal[v], cross(sub(b, a), sub(c, a)))]

    def next(self):
        known = [v for v in range(len(self.point)) if self.point[v] is None and self.num_flaps[v]]
        if known:
            return min(known, key=lambda v: (-self.weight[v], v))
        return self.point.index(None)

    def expect(self, v):
        """Foresight, point, root of the weight, normal."""
        limit = lambda x: min(max(x, -LATTICE_LIMIT), LATTICE_LIMIT)
        if self.num_flaps[v]:
            point = [limit(rounded(x, self.weight[v])) for x in self.target[v]]
            return "flaps", point, math.isqrt(self.weight[v]), scaled_to(self.normal[v], 12)
        around = [self.point[u] for u in self.neighbors[v] if self.point[u] is not None]
        if around:
            return "neighbors", [limit(rounded(sum(p[c] for p in around), len(around))) for c in range(3)], USUAL_ROOT, [0] * 3
        return "nothing", self.point[self.last], USUAL_ROOT, [0] * 3

    def expect_spread(self, v, foresight, root):
        along, across, count = self.overall[foresight]
        spread = [along // count, across // count]
        if foresight == "flaps":
            seen = [self.seen[u] for u in self.neighbors[v] if self.seen[u]]
            spread = [(10 * s + sum(x[i] for x in seen)) * USUAL_ROOT // (root * (10 + len(seen))) for i, s in enumerate(spread)]
        return [min(s, LARGEST_SPREAD) for s in spread]

    def add_spread(self, v, foresight, root, normal, difference):
        across = abs(dot(normal, difference)) // 256
        whole = 16 * math.isqrt(dot(difference, difference))
        rest = math.isqrt(max(0, whole * whole - across * across))
        spread = [rest * 163 // 256, across] if any(normal) else [whole * 148 // 256] * 2
        spread = [min(s * root // USUAL_ROOT, LARGEST_SPREAD) for s in spread]
        mean = self.overall[foresight]
        self.overall[foresight] = [mean[0] + spread[0], mean[1] + spread[1], mean[2] + 1]
        if foresight == "flaps":
            self.seen[v] = spread

    def decode_number(self, decoder, models, scale):
        width = max(1, (scale + 16) >> 5)
        shape = 5 if width > 1 else (scale >= 6) + (scale >= 12) + (scale >= 20) + (scale >= 32)
        bin_ = 0
        while bin_ < 14 and decoder.bit(self.farther[models][shape][bin_]):
            bin_ += 1
        if bin_ == 14:
            bin_ += decode_by_length(decoder, self.far[models])
        if bin_ == 0:
            return decode_uniform(decoder, 2 * width - 1) - width + 1
        negative = decoder.even()
        result = bin_ * width + decode_uniform(decoder, width)
        return -result if negative else result

    def decode(self, decoder):
        one = 4096
        self.set_point(self.next(), self.origin)
        for _ in range(1, len(self.point)):
            v = self.next()
            foresight, expected, root, normal = self.expect(v)
            along, across = self.expect_spread(v, foresight, root)
            order = sorted(range(3), key=lambda c: abs(normal[c]))
            along = max(along, 1)
            ratio = min((across << 6) // along, 128)
            m = min(max(ratio * ratio, 64), 4 * one) - one
            known, difference = one, [0] * 3
            for k, c in enumerate(order):
                forecast = 0
                for j in order[:k]:
                    forecast += ((m * normal[c] // one) * normal[j] // known) * difference[j]
                forecast = min(max(rounded(forecast, one), -1 << 26), 1 << 26)
                square = normal[c] * normal[c] // one
                variance = max(16, one + m * square // known)
                scale = along * math.isqrt(variance) // 64
                known = max(16, known + m * square // one)
                models = 2 if foresight != "flaps" else int(k == 2)
                difference[c] = forecast + self.decode_number(decoder, models, scale)
                assert abs(expected[c] + difference[c]) <= LATTICE_LIMIT
            self.add_spread(v, foresight, root, normal, difference)
            self.set_point(v, add(expected, difference))
        return self.point


# --- Compact base ---

def decode_compact_base(data):
    reader = Reader(data)
    num_vertices, num_borders = reader.varint(), reader.varint()
    bits, offset = reader.unsigned(2), [0.0] * 3
    step = step_value(bits)
    if bits == 0:
        step, *offset = struct.unpack("<4f", reader.take(16))
    extent_bits = reader.unsigned(1)
    origin = [reader.signed_varint() for _ in range(3)]
    assert all(abs(value) <= LATTICE_LIMIT for value in origin)
    assert num_vertices >= 3 and num_borders <= num_vertices // 3 and extent_bits <= 25
    decoder = RangeDecoder(data[reader.at:])
    triangles = Connectivity(decoder, num_vertices, num_borders).decode()
    lattice = Positions(base_level(num_vertices, triangles), origin, extent_bits).decode(decoder)
    return {"step": step, "offset": offset, "lattice": lattice, "triangles": triangles}


# --- Attributes ---

def faces_with(base, attribute):
    face, faces = 0, []
    for size, has in zip(base["group_sizes"], attribute["in_group"]):
        faces += range(face, face + size) if has else []
        face += size
    return faces


def integers_at(base, attribute, v):
    n = len(attribute["values"]) // len(base["lattice"])
    return attribute["values"][n * v:n * v + n]


def glue(base, faces, is_glued):
    """Rows at the corners of `faces`, and the first corner (face, k) of each."""
    sides = {}
    for f, t in enumerate(base["triangles"]):
        for k in range(3):
            ends = [tuple(base["lattice"][t[(k + i) % 3]]) for i in (1, 2)]
            sides.setdefault(tuple(sorted(ends)), []).append((f, k, ends[0] < ends[1]))
    parent = {(f, k): (f, k) for f in faces for k in range(3)}

    def find(corner):
        while parent[corner] != corner:
            corner = parent[corner]
        return corner

    for ends, at in sides.items():
        if len(at) != 2 or ends[0] == ends[1] or at[0][2] == at[1][2] or any(f not in faces for f, _, _ in at):
            continue
        (f, k, _), (g, j, _) = at
        pairs = [((f, (k + i) % 3), (g, (j + 3 - i) % 3)) for i in (1, 2)]
        if all(is_glued(base["triangles"][a][x], base["triangles"][b][y]) for (a, x), (b, y) in pairs):
            for a, b in pairs:
                first, second = sorted((find(a), find(b)))
                parent[second] = first
    numbers, rows = {}, {}
    for f in sorted(faces):
        rows[f] = [numbers.setdefault(find((f, k)), len(numbers)) for k in range(3)]
    return rows, list(numbers)


def octahedral_direction(s, t, bits):
    c = ((1 << bits) - 2) / 2
    y, z = s / c - 1, t / c - 1
    x = 1 - abs(y) - abs(z)
    fold = max(-x, 0)
    return unit([x, y + (fold if y < 0 else -fold), z + (fold if z < 0 else -fold)])


class AttributeLevels:
    def __init__(self, base, attribute, header):
        self.header = header
        faces = set(faces_with(base, attribute))
        same = lambda v, w: integers_at(base, attribute, v) == integers_at(base, attribute, w)
        rows, firsts = glue(base, faces, same)
        self.faces = sorted(faces)  # of the surface, under each of the wedge mesh
        self.level = base_level(len(firsts), [rows[f] for f in self.faces])
        self.values, self.residuals = [], []
        for f, k in firsts:
            numbers = integers_at(base, attribute, base["triangles"][f][k])
            if header["kind"] == 1:
                self.values.append(octahedral_direction(*numbers, header["precision"]))
            else:
                self.values.append([x * step_value(header["precision"]) for x in numbers])
        self.num_residuals = {1: 2, 2: 3}.get(header["kind"], header["components"])
        self.models = [SetModels(USUAL_PRIORS) for _ in range(self.num_residuals)]
        self.coarse = [None] * self.num_residuals

    def decode(self, number, surface, positions, decoder):
        level, bits = self.level, self.header["steps"][number]
        residuals = [[0] * len(level.edges) for _ in range(self.num_residuals)]
        coarse, self.coarse = self.coarse, [None] * self.num_residuals
        for c in range(self.num_residuals if bits else 0):
            def edge(e, activity, sign_class, expect_negative):
                before = abs(residuals[c - 1][e]) if c else 0
                companion = (0 if before == 0 else 1 if before < 3 else 2) + 3 * level.on_curve[e]
                residuals[c][e] = decode_coefficient(decoder, self.models[c], activity, companion, sign_class, expect_negative)
                return residuals[c][e]
            parents = forecasts(*coarse[c], bits) if coarse[c] else None
            self.coarse[c] = (level, decode_set(level, parents, edge), bits)
        self.residuals.append([q for one in residuals for q in one] if bits else [])
        self.values += [self.value(e, [one[e] for one in residuals], bits, surface, positions) for e in range(len(level.edges))]
        self.level = refine(level)
        self.faces = [4 * f + k for f in self.faces for k in range(4)]

    def value(self, e, residuals, bits, surface, positions):
        level, kind = self.level, self.header["kind"]
        first = self.values[level.edges[e][0]]
        if self.header["prediction"] == 2:
            row = [0.0] * 3
            for f in level.faces(e):
                row = add(row, areas_around(surface, self.faces[f], level.face_edges[f].index(e), positions))
        elif self.header["prediction"] == 1:
            row = add(*(scale(self.values[v], 0.5) for v in level.edges[e][:2]))
        else:
            row = add(*(scale(self.values[v], w) for v, w in stencil(level, e)))
        if kind in (1, 2):
            row = (unit(row[:3]) if any(row[:3]) else first[:3]) + first[3:]
        if not any(residuals):
            return row
        if self.header["chained"]:
            residuals = list(itertools.accumulate(residuals[:3])) + residuals[3:]
        moves = [q * step_value(bits) for q in residuals]
        if kind == 1:
            f = level.edges[e][2]
            k = level.face_edges[f].index(e)
            t = surface.triangles[self.faces[f]]
            along = unit(sub(positions[t[(k + 2) % 3]], positions[t[(k + 1) % 3]]))
            across = sub(along, scale(row, dot(along, row)))
            if dot(across, across) <= 1e-6:
                axis = [float(c == min(range(3), key=lambda i: abs(row[i]))) for c in range(3)]
                across = sub(axis, scale(row, dot(axis, row)))
            across = unit(across)
            return unit(add(row, scale(across, moves[0]), scale(cross(row, across), moves[1])))
        moved = add(row[:len(moves)], moves)
        return (unit(moved) if kind == 2 else moved) + row[len(moves):]


def areas_around(surface, f, k, positions):
    """Of the finer level's triangles in face f of the surface that meet in the midpoint of its edge k."""
    t, V = surface.triangles[f], surface.num_vertices
    m = [positions[V + e] for e in surface.face_edges[f]]
    total = cross(sub(m[1], m[0]), sub(m[2], m[0]))
    for c in ((k + 1) % 3, (k + 2) % 3):
        v = positions[t[c]]
        total = add(total, cross(sub(m[(c + 2) % 3], v), sub(m[(c + 1) % 3], v)))
    return total


# --- The decoder on one page ---

def decode(base, data):
    """Tags, coefficients, positions, attributes."""
    reader = Reader(data)
    steps, payload, has_layers, headers = read_header(reader, base)
    attributes = []
    if headers is not None:
        attributes = [AttributeLevels(base, a, header) for a, header in zip(base["attributes"], headers)]
        rows, firsts = glue(base, set(range(len(base["triangles"]))), lambda v, w: True)
        lattice = [base["lattice"][base["triangles"][f][k]] for f, k in firsts]
        base = {"step": base["step"], "lattice": lattice, "triangles": [rows[f] for f in sorted(rows)]}
    positions = [[value * base["step"] for value in point] for point in base["lattice"]]
    coefficients = []
    coefficient_decoder = CoefficientDecoder()
    level, tags = tagged_level(base, payload)
    if has_layers:
        levels = []
        for sets in steps:
            levels.append(LayeredLevel(level, sets))
            level = refine(level)
        while any(at.shift != 0 and (at.sets["normal"][0] or at.sets["tangential"][0]) for at in levels):
            take_layer_segment(reader, levels, coefficient_decoder)
        for at in levels:
            synthesize(at.level, at.sets, at.normal, at.tangential, positions)
            coefficients.append({"normal": at.normal, "tangential": at.tangential})
        return tags, coefficients, positions, attributes
    coefficient_decoder.lengths = length_classes(level, base["lattice"])
    for number, sets in enumerate(steps, 1):
        silent = not sets["normal"][0] and not sets["tangential"][0] and not any(a.header["steps"][number - 1] for a in attributes)
        decoder = RangeDecoder(b"" if silent else read_segment(reader, number))
        normal, tangential = coefficient_decoder.decode(level, sets, decoder)
        synthesize(level, sets, normal, tangential, positions)
        for attribute in attributes:
            attribute.decode(number - 1, level, positions, decoder)
        coefficients.append({"normal": normal, "tangential": tangential})
        level = refine(level)
    return tags, coefficients, positions, attributes


def main(paths):
    for path in paths:
        with open(path, encoding="utf-8") as file:
            golden = json.load(file)
        if "levels" not in golden:
            with open(path[:-len("json")] + "cbase", "rb") as file:
                assert decode_compact_base(file.read()) == golden, path + ": compact base differs"
            print("%s: %d vertices, %d triangles" % (path, len(golden["lattice"]), len(golden["triangles"])))
            continue
        with open(path[:-len("json")] + "lac", "rb") as file:
            tags, coefficients, positions, attributes = decode(golden["base"], file.read())
        assert tags == golden["base"].get("tags", dict.fromkeys(tags, [])), path + ": tags differ"
        assert coefficients == golden["levels"], path + ": coefficients differ"
        assert len(positions) == len(golden["positions"]), path + ": numbers of positions differ"
        size = max(abs(x) for p in golden["positions"] for x in p)
        worst = max(abs(x - y) for p, q in zip(positions, golden["positions"]) for x, y in zip(p, q))
        assert worst <= 1e-4 * size, "%s: a position is off by %g" % (path, worst)
        for attribute, wanted in zip(attributes, golden.get("attributes", [])):
            assert attribute.residuals == wanted["residuals"], "%s: residuals of %s differ" % (path, attribute.header["name"])
            values = [x for row in attribute.values for x in row]
            assert len(values) == len(wanted["values"]) and max(abs(x - y) for x, y in zip(values, wanted["values"])) <= 1e-4, \
                "%s: values of %s differ" % (path, attribute.header["name"])
        print("%s: %d levels, %d vertices, largest difference %.2g" % (path, len(coefficients), len(positions), worst / size))
    assert paths, "no golden stream given"


if __name__ == "__main__":
    main(sys.argv[1:])
