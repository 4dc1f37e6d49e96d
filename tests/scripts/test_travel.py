#!/usr/bin/python3
"""Movements of the ground station's client against rotations, and their covariances against derivatives."""
import math
import random
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts" / "ground_station"))

from travel import MOST_JOINED, Travel, joined, movement  # noqa: E402


class Movement(unittest.TestCase):
    def test_takes_the_vehicle_from_the_first_place_to_the_second(self):
        draw = random.Random(1)
        for _ in range(200):
            before, now = ([draw.uniform(-500, 500), draw.uniform(-500, 500), draw.uniform(-720, 720)]
                           for _ in range(2))
            moved = movement(before, now)
            ahead = complex(math.cos(math.radians(before[2])), math.sin(math.radians(before[2])))  # north + i east
            flown = ahead * complex(moved["forward_m"], moved["right_m"])
            self.assertAlmostEqual(before[0] + flown.real, now[0], places=6)
            self.assertAlmostEqual(before[1] + flown.imag, now[1], places=6)
            self.assertLessEqual(abs(moved["turn_deg"]), 180.0)
            self.assertAlmostEqual(math.cos(math.radians(before[2] + moved["turn_deg"] - now[2])), 1.0, places=9)

    def test_turns_the_short_way_round(self):
        self.assertAlmostEqual(movement((0, 0, 350.0), (0, 0, 10.0))["turn_deg"], 20.0)


def end_of(parts):
    """Where several movements (forward_m, right_m, turn) lead, by complex numbers: forward + i right."""
    place, heading = 0j, 0.0
    for forward_m, right_m, turn in parts:
        place += complex(forward_m, right_m) * complex(math.cos(heading), math.sin(heading))
        heading += turn
    return place.real, place.imag, heading


def derived_covariance(parts, covariances):
    """By differences of end_of."""
    total = [[0.0] * 3 for _ in range(3)]
    for which, covariance in enumerate(covariances):
        columns = []
        for i in range(3):
            ends = []
            for step in (1e-5, -1e-5):
                moved = [list(part) for part in parts]
                moved[which][i] += step
                ends.append(end_of(moved))
            columns.append([(a - b) / 2e-5 for a, b in zip(*ends)])
        for i in range(3):
            for j in range(3):
                total[i][j] += sum(columns[k][i] * covariance[k][m] * columns[m][j] for k in range(3) for m in range(3))
    return total


def drawn_covariance(draw):
    root = [[draw.uniform(-1, 1) for _ in range(3)] for _ in range(3)]
    return [[sum(root[i][k] * root[j][k] for k in range(3)) for j in range(3)] for i in range(3)]


class Covariance(unittest.TestCase):
    def test_of_movements_one_after_the_other_is_that_of_where_they_lead(self):
        draw = random.Random(5)
        for _ in range(50):
            parts = [(draw.uniform(-40, 40), draw.uniform(-40, 40), draw.uniform(-3, 3)) for _ in range(4)]
            covariances = [drawn_covariance(draw) for _ in parts]
            whole = (parts[0], covariances[0])
            for part in zip(parts[1:], covariances[1:]):
                whole = joined(whole, part)
            for actual, expected in zip(whole[0], end_of(parts)):
                self.assertAlmostEqual(actual, expected)
            for row, others in zip(whole[1], derived_covariance(parts, covariances)):
                for actual, expected in zip(row, others):
                    self.assertAlmostEqual(actual, expected, delta=1e-5 * (1.0 + abs(expected)))


class Travels(unittest.TestCase):
    def flown(self, *covariances):
        """To the north from (0, 0), 10 m each."""
        travel = Travel()
        travel.add((0.0, 0.0, 0.0), None)
        travel.taken(1)
        for i, covariance in enumerate(covariances, 1):
            travel.add((10.0 * i, 0.0, 0.0), covariance)
        return travel

    def test_over_one_place_have_what_was_told_whatever_it_is(self):
        self.assertEqual(self.flown("1,2").covariance(), "1,2", "the service refuses it, and says why")
        self.assertIsNone(self.flown(None).covariance())

    def test_over_several_places_have_the_sum_with_what_an_error_of_the_heading_does(self):
        told = [1.0, 0, 0, 0, 2.0, 0, 0, 0, 0.01]
        whole = self.flown(told, told).covariance()
        for actual, expected in zip(whole, (2.0, 0, 0, 0, 4.0 + 1.0, 0.1, 0, 0.1, 0.02)):
            self.assertAlmostEqual(actual, expected)

    def test_over_a_turn_have_the_covariance_of_where_the_movements_lead(self):
        draw = random.Random(6)
        covariances = [drawn_covariance(draw) for _ in range(3)]
        travel = Travel()
        places = ((0.0, 0.0, 0.0), (10.0, 0.0, 90.0), (10.0, 20.0, 180.0), (-5.0, 20.0, 180.0))
        for place, covariance in zip(places, [None, *covariances]):
            travel.add(place, covariance and sum(covariance, []))
        travel.taken(1)
        parts = ((10.0, 0.0, math.pi / 2), (20.0, 0.0, math.pi / 2), (15.0, 0.0, 0.0))
        expected = sum(derived_covariance(parts, covariances), [])
        for actual, wanted in zip(travel.covariance(), expected, strict=True):
            self.assertAlmostEqual(actual, wanted, delta=1e-5 * (1.0 + abs(wanted)))

    def test_over_a_place_of_which_anything_is_unknown_have_none(self):
        told = [1.0] * 9
        for unknown in (None, "1,1,1,1,1,1,1,1,1", [1.0] * 8, [math.nan] * 9, [[1.0] * 3] * 3):
            self.assertIsNone(self.flown(told, unknown, told).covariance())
        travel = self.flown(told, told)
        travel.add(None, told)
        travel.add((40.0, 0.0, 0.0), told)
        self.assertIsNone(travel.covariance())
        self.assertIsNone(self.flown(*[told] * (MOST_JOINED + 1)).covariance())
        first = Travel()
        first.add((0.0, 0.0, 0.0), told)
        self.assertIsNone(first.covariance(), "from where?")

    def test_begin_where_the_last_step_was_taken(self):
        travel = self.flown([1.0] * 9, [2.0] * 9, [3.0] * 9)
        travel.taken(2)
        self.assertEqual(travel.covariance(), [3.0] * 9)
        travel.taken(0)
        self.assertEqual(len(travel), 1)


if __name__ == "__main__":
    unittest.main()
