#!/usr/bin/python3
"""Path similarity against cases worked out by hand and against the shortest way from pixel to pixel; seconds.

Skips (exit 77) where torch or OpenCV with its contributed modules is not installed for Python.
"""
import sys
import unittest
from pathlib import Path

try:
    import cv2
    import numpy as np
    import torch  # noqa: F401  (roadnet needs it)
    cv2.ximgproc.thinning
except (ImportError, AttributeError) as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "models"))

from roadnet import paths  # noqa: E402


def street(rows=20, cols=121):
    mask = np.zeros((rows, cols), bool)
    mask[10, 10:111] = True  # 100 m: control points at both ends and in the middle
    return mask


def town(seed):
    """Streets across each other, a ring and a blind alley."""
    rng = np.random.default_rng(seed)
    mask = np.zeros((200, 200), np.uint8)
    for _ in range(5):
        ends = rng.integers(5, 195, 4).tolist()
        cv2.line(mask, ends[:2], ends[2:], 255, 5)
    cv2.circle(mask, (140, 60), 35, 255, 5)
    return mask > 0


def by_pixels(lines, start):
    """Shortest way to each pixel of a skeleton, by relaxation."""
    there = {(int(r), int(c)) for r, c in np.argwhere(lines)}
    metres = {start: 0.0}
    waiting = [start]
    while waiting:
        pixel = waiting.pop(0)
        for other in paths.adjacent(pixel, there):
            length = metres[pixel] + float(np.hypot(pixel[0] - other[0], pixel[1] - other[1]))
            if length < metres.get(other, np.inf) - 1e-9:
                metres[other] = length
                waiting.append(other)
    return metres


class PathSimilarity(unittest.TestCase):
    def test_a_network_is_like_itself_and_unlike_nothing(self):
        for seed in range(5):
            self.assertAlmostEqual(paths.similarity(town(seed), town(seed), 1.0), 1.0)
        nothing = np.zeros((200, 200), bool)
        self.assertEqual(paths.similarity(town(0), nothing, 1.0), 0.0)
        self.assertIsNone(paths.similarity(nothing, town(0), 1.0))

    def test_a_street_cut_in_the_middle_keeps_one_of_its_three_paths(self):
        cut = street()
        cut[10, 60] = False
        # There: one of three paths, 1 m of 50 too short. Back: both halves are whole.
        there = (1 - 1 / 50) / 3
        self.assertAlmostEqual(paths.similarity(street(), cut, 1.0), 2 * there / (there + 1), places=2)

    def test_a_shift_within_the_tolerance_costs_nothing_and_one_beyond_everything(self):
        wide = np.pad(street(), ((0, 20), (0, 0)))
        self.assertAlmostEqual(paths.similarity(wide, np.roll(wide, 3, 0), 1.0), 1.0)
        self.assertEqual(paths.similarity(wide, np.roll(wide, 8, 0), 1.0), 0.0)

    def test_metres_follow_the_size_of_a_pixel(self):
        roads = paths.Roads(street(), 0.5)
        self.assertEqual([edge.length for edge in roads.edges], [50.0])
        self.assertEqual(len(roads.control_points()), 2)

    def test_short_spurs_are_cut_and_short_streets_stay(self):
        mask = street(40)
        mask[11:17, 60] = True
        mask[30, 20:26] = True
        self.assertEqual(sorted(e.length for e in paths.Roads(mask, 1.0).edges), [5.0, 100.0])

    def test_lengths_are_those_of_the_shortest_way_from_pixel_to_pixel(self):
        for seed in range(5):
            roads = paths.Roads(town(seed), 1.0)
            lines = np.zeros((200, 200), bool)
            for pixel in roads.places:
                lines[pixel] = True
            points = list(roads.places)[::37]
            found = roads.lengths(points)
            for i, start in enumerate(points):
                metres = by_pixels(lines, start)
                np.testing.assert_allclose(found[i], [metres.get(p, np.inf) for p in points], atol=1e-6)


if __name__ == "__main__":
    unittest.main()
