"""How many bytes one coder takes more or less than another at the same PSNR, in the mean over their common range of PSNR: the rate
difference of [Bjontegaard 2001, VCEG-M33], with monotone cubics [Fritsch & Butland 1984] in place of his polynomial, which overshoots
between distant points. A point is (PSNR in dB, bytes)."""

import bisect
import itertools
import math
from typing import NamedTuple

SHORTEST_RANGE = 1.0  # dB: over less a mean says nothing


class RateDifference(NamedTuple):
    percent: float  # bytes of `ours` over those of `theirs`, less 100: negative where ours are fewer
    low: float  # dB: the common range
    high: float


def best_rows(points):
    """Those for which no other point has as few bytes at as much PSNR; by PSNR."""
    kept = []
    for psnr, size in sorted(points, key=lambda p: (-p[0], p[1])):
        if not kept or size < kept[-1][1]:
            kept.append((psnr, size))
    return kept[::-1]


def hull_rows(points):
    """Those of the best rows that lie on the lower convex hull of ln(bytes) over PSNR: where parameters were tried on a coarse grid, the
    rest are poor choices of them."""
    hull = []
    for psnr, size in best_rows(points):
        p = (psnr, math.log(size))
        while len(hull) > 1 and (hull[-1][1] - hull[-2][1]) * (p[0] - hull[-2][0]) >= (p[1] - hull[-2][1]) * (hull[-1][0] - hull[-2][0]):
            hull.pop()
        hull.append(p)
    return [(psnr, math.exp(log_size)) for psnr, log_size in hull]


class MonotoneCubic:
    """Through at least two points of increasing x, monotone wherever they are."""

    def __init__(self, points):
        self.x, self.y = zip(*points)
        self.widths = [b - a for a, b in itertools.pairwise(self.x)]
        if not self.widths or min(self.widths) <= 0:
            raise ValueError("points of increasing x, two or more")
        self.secants = [(b - a) / w for (a, b), w in zip(itertools.pairwise(self.y), self.widths)]
        inner = [self._inner_slope(i) for i in range(1, len(self.widths))]
        self.slopes = [self._end_slope(self.widths, self.secants), *inner, self._end_slope(self.widths[::-1], self.secants[::-1])]

    def _inner_slope(self, i):
        h0, h1, d0, d1 = *self.widths[i - 1:i + 1], *self.secants[i - 1:i + 1]
        if d0 * d1 <= 0:
            return 0.0
        w0, w1 = 2 * h1 + h0, h1 + 2 * h0
        return (w0 + w1) / (w0 / d0 + w1 / d1)

    @staticmethod
    def _end_slope(widths, secants):
        """Of the parabola through three points, as far as that keeps the first piece monotone."""
        if len(widths) == 1:
            return secants[0]
        (h0, h1), (d0, d1) = widths[:2], secants[:2]
        slope = ((2 * h0 + h1) * d0 - h0 * d1) / (h0 + h1)
        if slope * d0 <= 0:
            return 0.0
        return 3 * d0 if d0 * d1 <= 0 and abs(slope) > 3 * abs(d0) else slope

    def __call__(self, x):
        i = min(max(bisect.bisect_right(self.x, x) - 1, 0), len(self.widths) - 1)
        h = self.widths[i]
        t = (x - self.x[i]) / h
        return ((1 + 2 * t) * (1 - t)**2 * self.y[i] + t**2 * (3 - 2 * t) * self.y[i + 1]
                + h * t * (1 - t) * ((1 - t) * self.slopes[i] - t * self.slopes[i + 1]))

    def integral(self, low, high):
        """From low to high, both in the range of the points."""
        ends = [low, *(x for x in self.x if low < x < high), high]
        return sum((b - a) / 6 * (self(a) + 4 * self((a + b) / 2) + self(b)) for a, b in itertools.pairwise(ends))  # exact for cubics


def rate_difference(ours, theirs, low=-math.inf, high=math.inf):
    """The difference over what both cover of low .. high dB, or None where that is less than SHORTEST_RANGE. Rows that others beat are
    left out, of both."""
    curves = []
    for points in (ours, theirs):
        rows = best_rows(points)
        if len(rows) < 2:
            return None
        curves.append(MonotoneCubic([(psnr, math.log(size)) for psnr, size in rows]))
        low, high = max(low, rows[0][0]), min(high, rows[-1][0])
    if high - low < SHORTEST_RANGE:
        return None
    mean = (curves[0].integral(low, high) - curves[1].integral(low, high)) / (high - low)
    return RateDifference(100 * math.expm1(mean), low, high)
