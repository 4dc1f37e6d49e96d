#!/usr/bin/python3
"""The movement from step to step, and its covariance, that the ground station's client tells."""
import contextlib
import tempfile
import unittest
from pathlib import Path

from fake_service import CONVERGED, FakeService
from followed import Followed

from service import Refused, Silent
from track import Track


class Steps(Followed):
    def test_say_nothing_of_the_covariance_of_a_movement_that_is_not_known(self):
        with FakeService() as fake:
            track, _ = self.fly(fake, 0)
            for i in (1, 2):
                track.step((10.0 * i, 0.0, 0.0), {"time_us": i, "covariance": [1.0] * 9})
            self.assertEqual(["covariance" in step for step in fake.steps()], [False, True])

    def movements(self, *places):
        """Forwards, as the service is told, None where it is told none: of steps a second apart."""
        with FakeService() as fake:
            track, _ = self.fly(fake, 0)
            for i, place in enumerate(places):
                track.step(place, {"time_us": i * 1_000_000})
            return [round(step["forward_m"], 6) if "forward_m" in step else None for step in fake.steps()]

    def test_tell_no_movement_to_or_from_a_place_that_is_not_known(self):
        self.assertEqual(self.movements((0.0, 0.0, 0.0), (10.0, 0.0, 0.0), None, (30.0, 0.0, 0.0), (45.0, 0.0, 0.0)),
                         [None, 10.0, None, None, 15.0])

    def test_tell_no_movement_while_the_estimator_of_a_vehicle_that_flew_tells_the_same_to_the_last_digit(self):
        for still in ((10.0, 0.0, 0.0), None):
            self.words.truncate(0)
            self.assertEqual(self.movements((0.0, 0.0, 0.0), (10.0, 0.0, 0.0), (10.0, 0.0, 0.0), still,
                                            (10.0, 0.0, 0.0), (70.0, 0.0, 0.0), (85.0, 0.0, 0.0), (85.0, 0.0, 0.0)),
                             [None, 10.0, None, None, None, None, 15.0, None])
            self.assertEqual(self.words.getvalue().count("has the vehicle's estimator stopped?"), 1)

    def test_tell_that_a_vehicle_stands_before_it_flies_or_moves_by_the_last_digit_alone(self):
        self.assertEqual(self.movements((5.0, 0.0, 0.0), (5.0, 0.0, 0.0), (5.0, 0.0, 0.0), (9.0, 0.0, 0.0),
                                        (9.0, 0.0, 0.001), (9.001, 0.0, 0.001)), [None, 0.0, 0.0, 4.0, 0.0, 0.001])
        self.assertEqual(self.words.getvalue(), "")

    def test_tell_no_movement_from_a_place_that_was_passed_by_and_comes_again(self):
        with FakeService() as fake:
            track, _ = self.fly(fake, 1)
            track.pass_by((10.0, 0.0, 0.0), None)
            for i in (2, 3):
                track.step((10.0, 0.0, 0.0), {"time_us": i})
            self.assertNotIn("forward_m", fake.steps()[1])
            self.assertNotIn("forward_m", fake.steps()[2])

    def test_tell_no_movement_since_a_place_after_which_the_estimator_stopped_though_no_step_of_that_was_taken(self):
        for is_refused in (False, True):
            with FakeService([200, 200] + [(422, {"code": "image-damaged"})] * is_refused) as fake:
                track, _ = self.fly(fake, 2)
                if is_refused:
                    with self.assertRaises(Refused):
                        track.step((10.0, 0.0, 0.0), {"time_us": 3})
                else:
                    track.pass_by((10.0, 0.0, 0.0), None)
                for i, north_m in ((4, 40.0), (5, 55.0)):
                    track.step((north_m, 0.0, 0.0), {"time_us": i})
                self.assertEqual([step.get("forward_m") for step in fake.steps()][-3 - is_refused:],
                                 [10.0] + [None] * is_refused + [None, 15.0])

    def test_may_have_gone_anywhere_while_no_place_was_known(self):
        with FakeService([CONVERGED, 200, 200, 200, (410, {"code": "track-ended"})]) as fake:
            track, _ = self.fly(fake, 1)
            for i in range(1, 5):
                track.step(None, {"time_us": i * 1_000_000})
            begun = fake.begun()[-1]
            self.assertEqual((begun["lat"], begun["lon"]), (7.0, 8.0))
            self.assertAlmostEqual(begun["radius_m"], 100.0 + 20.0 + 3 * 50.0, delta=50.0 * 2.0)

    def test_go_on_with_another_origin_where_it_was_not_known_before_either_where_they_were(self):
        for fate in (200, "lose"):
            with FakeService([CONVERGED, 200] + [fate] * 20) as fake:
                track, _ = self.fly(fake, 1, patience_s=0.2)
                track.step(None, {"time_us": 2}, origin=None)
                with contextlib.suppress(Silent):
                    track.step((20.0, 0.0, 0.0), {"time_us": 3})
                fake.script.clear()
                track.step((5.0, 0.0, 0.0), {"time_us": 4}, origin="again")
                track.step((9.0, 0.0, 0.0), {"time_us": 5}, origin="again")
                self.assertEqual(len(fake.begun()), 2 if fate == 200 else 1, "the place of the step before was known")
                self.assertNotIn("forward_m", fake.steps()[-2])
                self.assertEqual(fake.steps()[-1]["forward_m"], 4.0)

    def test_have_the_covariance_of_all_that_their_movement_spans(self):
        def errors(turn_rad2):
            return [1.0, 0, 0, 0, 2.0, 0, 0, 0, turn_rad2]

        for fates, sequence, right_m2 in (([(422, {"code": "image-damaged"})], 2, 2.0 + 2.0 + 15.0**2 * 0.01),
                                          (["hang up"] * 100, 2, 2.0 + 2.0 + 15.0**2 * 0.01),
                                          (["lose"] * 100, 3, 2.0)):
            with FakeService([200, *fates]) as fake:
                track, _ = self.fly(fake, 1, patience_s=0.2)
                with self.assertRaises((Refused, Silent)):
                    track.step((10.0, 0.0, 0.0), {"time_us": 2, "covariance": errors(0.01)})
                fake.script.clear()
                track.step((25.0, 0.0, 0.0), {"time_us": 3, "covariance": errors(0.02)})
                self.assertEqual(fake.steps()[-1]["sequence"], sequence)
                self.assertAlmostEqual(fake.steps()[-1]["covariance"][4], right_m2)
                track.step((30.0, 0.0, 0.0), {"time_us": 4, "covariance": errors(0.03)})
                self.assertEqual(fake.steps()[-1]["covariance"], errors(0.03), "of this movement alone")

    def test_say_nothing_of_a_covariance_where_that_of_a_part_is_not_known(self):
        with FakeService([200]) as fake, tempfile.TemporaryDirectory() as folder:
            state = Path(folder, "state.json")
            track, _ = self.fly(fake, 1, state_file=state)
            track.pass_by((10.0, 0.0, 0.0), None)
            track.step((25.0, 0.0, 0.0), {"time_us": 2, "covariance": [1.0] * 9})
            self.assertNotIn("covariance", fake.steps()[-1])
            again = Track(track._service, {"map": "m"}, state)
            again.step((30.0, 0.0, 0.0), {"time_us": 3, "covariance": [1.0] * 9})
            self.assertNotIn("covariance", fake.steps()[-1], "lines may have been lost before the restart")
            again.step((35.0, 0.0, 0.0), {"time_us": 4, "covariance": [1.0] * 9})
            self.assertEqual(fake.steps()[-1]["covariance"], [1.0] * 9)

    def test_come_after_one_that_was_taken_late_with_the_covariance_since_it(self):
        with FakeService([200] + ["hang up"] * 100) as fake:
            track, _ = self.fly(fake, 1, patience_s=0.2)
            with self.assertRaises(Silent):
                track.step((10.0, 0.0, 0.0), {"time_us": 2, "covariance": [1.0] * 9})
            fake.script = ["still at it"]
            track.step((25.0, 0.0, 0.0), {"time_us": 3, "covariance": [2.0] * 9})
            self.assertEqual(fake.steps()[-1]["covariance"], [2.0] * 9)


if __name__ == "__main__":
    unittest.main()
