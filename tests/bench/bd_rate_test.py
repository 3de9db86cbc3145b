#!/usr/bin/env python3
"""Tests of bd_rate: curves whose difference is known."""

import math
import sys
import unittest

sys.dont_write_bytecode = True
import bd_rate


def curve(psnrs, size):
    return [(p, size(p)) for p in psnrs]


class BestRowsTest(unittest.TestCase):
    def test_leaves_out_what_another_row_beats(self):
        points = [(70, 300), (60, 100), (65, 310), (75, 500), (70, 290), (60, 120)]
        self.assertEqual(bd_rate.best_rows(points), [(60, 100), (70, 290), (75, 500)])

    def test_hull_leaves_out_what_lies_above_a_chord(self):
        points = [(60, 100.0), (65, 190.0), (70, 200.0), (80, 420.0), (90, 1700.0)]  # the chord from 60 to 70 has 141 at 65
        self.assertEqual([p for p, _ in bd_rate.hull_rows(points)], [60, 70, 80, 90])
        for (_, size), known in zip(bd_rate.hull_rows(points), [100, 200, 420, 1700]):
            self.assertAlmostEqual(size, known, places=9)


class MonotoneCubicTest(unittest.TestCase):
    def test_known_slopes_and_values(self):
        cubic = bd_rate.MonotoneCubic([(0, 0), (1, 1), (2, 8)])
        self.assertEqual(cubic.slopes, [0, 1.75, 10])  # an end that would fall, the harmonic mean of 1 and 7, an end that may rise
        self.assertAlmostEqual(cubic(0.5), 0.5 - 1.75 / 8)
        self.assertAlmostEqual(cubic.integral(0, 1), 0.5 - 1.75 / 12)
        self.assertAlmostEqual(cubic.integral(0, 2), 0.5 - 1.75 / 12 + 4.5 + (1.75 - 10) / 12)
        self.assertAlmostEqual(cubic.integral(0.3, 0.8) + cubic.integral(0.8, 1.7), cubic.integral(0.3, 1.7))

    def test_does_not_overshoot(self):
        cubic = bd_rate.MonotoneCubic([(0, 0), (1, 0.01), (2, 5), (3, 5.01)])
        values = [cubic(i / 100) for i in range(301)]
        self.assertTrue(all(a <= b for a, b in zip(values, values[1:])))

    def test_needs_two_points_in_order(self):
        for points in ([(1, 2)], [(1, 2), (1, 3)], [(2, 2), (1, 3)]):
            with self.assertRaises(ValueError):
                bd_rate.MonotoneCubic(points)


class RateDifferenceTest(unittest.TestCase):
    def test_a_constant_share_is_that_share(self):
        theirs = curve([55, 61, 64, 72, 80], lambda p: 2**(p / 6) + 0.01 * p**2)
        result = bd_rate.rate_difference([(p, 0.7 * size) for p, size in theirs], theirs)
        self.assertAlmostEqual(result.percent, -30, places=9)
        self.assertEqual((result.low, result.high), (55, 80))

    def test_lines_of_different_slope_at_different_points(self):
        ours = curve([50, 62, 71, 90], lambda p: math.exp(0.10 * p))
        theirs = curve([58, 66, 85], lambda p: math.exp(0.12 * p - 1))
        result = bd_rate.rate_difference(ours, theirs, 60, 80)  # ln differs by 1 - 0.02 p: by -0.4 in the mean
        self.assertAlmostEqual(result.percent, 100 * (math.exp(-0.4) - 1), places=9)
        self.assertEqual((result.low, result.high), (60, 80))
        swapped = bd_rate.rate_difference(theirs, ours, 60, 80)
        self.assertAlmostEqual((1 + result.percent / 100) * (1 + swapped.percent / 100), 1, places=12)

    def test_only_the_common_range_counts(self):
        ours = curve([60, 65, 70], lambda p: 10 * p)
        theirs = curve([64, 70, 99], lambda p: 10 * p)
        self.assertEqual(bd_rate.rate_difference(ours, theirs)[1:], (64, 70))
        self.assertIsNone(bd_rate.rate_difference(ours, curve([69.5, 75], lambda p: p)))
        self.assertIsNone(bd_rate.rate_difference(ours, [(65, 100)]))


if __name__ == "__main__":
    unittest.main()
