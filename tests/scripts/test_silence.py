#!/usr/bin/python3
"""A client of ground stations that is started again, or flies on while clocks are set: whether the flight is that of
before, and how far the vehicle may have come."""
import tempfile
import unittest
from pathlib import Path
from unittest import mock

from fake_service import CONVERGED, FakeService
from words import said

from service import ANSWER_TIME_S, Service, Silent
from silence import BOOT, FORGOTTEN_S
from track import Track

REQUEST = {"map": "m", "lat": 1, "lon": 2, "radius_m": 3}
WITHIN_M = 100.0 + 5.0 * 4.0  # of CONVERGED
FASTEST_M_S = 50.0


class Clocks:
    """Of a client: time.monotonic() and the date, which may be set."""

    def __init__(self):
        self.now_s, self.ahead_s = 1000.0, 1.7e9

    def monotonic(self):
        return self.now_s

    def time(self):
        return self.now_s + self.ahead_s


class Flights(unittest.TestCase):
    def setUp(self):
        self.clocks = Clocks()
        self.enter(mock.patch("silence.time", self.clocks))
        self.enter(mock.patch("silence.BOOT", "this"))
        self.words = self.enter(said())
        self.state = Path(self.enter(tempfile.TemporaryDirectory()), "state.json")
        self.fake = self.enter(FakeService([CONVERGED]))

    def enter(self, context):
        self.addCleanup(context.__exit__, None, None, None)
        return context.__enter__()

    def client(self, patience_s=10.0):
        service = Service(self.fake.url, patience_s)
        self.addCleanup(service.close)
        return Track(service, REQUEST, self.state)

    def fly(self, track, step, origin="a"):
        track.step((10.0 * step, 0.0, 0.0), {"time_us": step}, origin=origin)

    def pass_s(self, seconds, set_s=0.0):
        self.clocks.now_s += seconds
        self.clocks.ahead_s += set_s

    def restart_computer(self, after_s, behind_s=0.0):
        """Whose clock is behind afterwards."""
        self.clocks.now_s, self.clocks.ahead_s = 20.0, self.clocks.time() + after_s - behind_s - 20.0
        self.enter(mock.patch("silence.BOOT", "next"))

    def check_goes_on(self):
        self.assertEqual(len(self.fake.begun()), 1)
        self.assertEqual(self.fake.steps()[-1]["sequence"], 2)
        self.assertEqual(self.words.getvalue(), "")

    def check_begins_where_told(self):
        self.assertEqual(self.fake.begun(), [REQUEST, REQUEST])
        self.assertIn("was long ago: a new one begins", self.words.getvalue())

    def check_begins_anywhere(self):
        self.assertEqual(self.fake.begun()[-1], {"map": "m"})
        self.assertEqual(self.words.getvalue().count("it is not known how long ago the last step"), 1)


class Restarts(Flights):
    def test_of_the_client_alone_go_on_with_the_track_whatever_the_date(self):
        for set_s in (-1e6, -1.0, 1e6):
            with self.subTest(set_s=set_s):
                self.setUp()
                self.fly(self.client(), 1)
                self.pass_s(5.0, set_s)
                self.fly(self.client(), 2)
                self.check_goes_on()

    def test_on_a_full_disk_go_on_with_a_flight_and_begin_none(self):
        self.fly(self.client(), 1)
        self.state.with_name("state.json.part").symlink_to("/dev/full")
        self.pass_s(599.0)
        self.fly(self.client(), 2)
        self.assertEqual((len(self.fake.begun()), self.fake.steps()[-1]["sequence"]), (1, 2))
        self.assertIn("state.json is not kept up to date", self.words.getvalue())
        self.pass_s(2.0)
        with self.assertRaisesRegex(OSError, "No space left"):
            self.client()

    def test_within_ten_minutes_are_of_the_same_flight(self):
        self.assertEqual(FORGOTTEN_S, 600.0)
        for after_s, check in ((599.0, self.check_goes_on), (601.0, self.check_begins_where_told)):
            self.setUp()
            self.fly(self.client(), 1)
            self.pass_s(after_s)
            self.fly(self.client(), 2)
            check()

    def test_are_looked_at_once_whatever_pauses_come_after_them(self):
        self.fly(self.client(), 1)
        track = self.client()
        for step in (2, 3):
            self.fly(track, step)
            self.pass_s(700.0)
        self.assertEqual([step["sequence"] for step in self.fake.steps()], [1, 2, 3])
        self.assertEqual(len(self.fake.begun()), 1)

    def test_while_the_service_has_long_been_away_are_of_the_same_flight(self):
        track = self.client(patience_s=0.2)
        self.fly(track, 1)
        self.pass_s(700.0)
        self.fake.script = ["hang up"] * 100
        with self.assertRaises(Silent):
            self.fly(track, 2)
        self.fake.script.clear()
        self.fly(self.client(), 3)
        self.check_goes_on()

    def test_after_the_computer_has_slept_are_of_another_flight(self):
        self.clocks.CLOCK_BOOTTIME = 7
        self.clocks.clock_gettime = lambda _: self.clocks.now_s
        self.fly(self.client(), 1)
        self.clocks.clock_gettime = lambda _: self.clocks.now_s + 3600.0
        self.fly(self.client(), 2)
        self.check_begins_where_told()

    def test_of_the_computer_are_of_the_same_flight_if_the_service_heard_the_last_step_within_ten_minutes(self):
        for silent_s, check in ((599.0, self.check_goes_on), (601.0, self.check_begins_where_told)):
            self.setUp()
            self.fly(self.client(), 1)
            self.restart_computer(silent_s, behind_s=1e5)
            self.fake.silent_s = silent_s
            self.fly(self.client(), 2)
            check()

    def test_of_the_computer_go_on_after_a_step_without_an_answer(self):
        track = self.client(patience_s=0.2)
        self.fly(track, 1)
        self.fake.script = ["lose"] * 100
        with self.assertRaises(Silent):
            self.fly(track, 2)
        self.fake.script.clear()
        self.restart_computer(30.0, behind_s=1e5)
        self.fake.silent_s = 30.0
        self.fly(self.client(), 3)
        self.assertEqual((len(self.fake.begun()), self.fake.steps()[-1]["sequence"]), (1, 3))

    def test_of_the_computer_widen_the_area_by_all_that_the_vehicle_may_have_flown(self):
        self.fly(self.client(), 1)
        self.restart_computer(30.0, behind_s=1e5)
        self.fake.silent_s = 30.0
        self.fly(self.client(), 2, origin="b")
        begun = self.fake.begun()[-1]
        self.assertEqual((begun["lat"], begun["lon"]), (7.0, 8.0))
        self.assertAlmostEqual(begun["radius_m"], WITHIN_M + FASTEST_M_S * (30.0 + ANSWER_TIME_S))

    def test_of_the_computer_and_the_service_begin_anywhere_unless_the_date_tells_another_flight(self):
        for after_s, behind_s, check in ((30.0, 0.0, self.check_begins_anywhere),
                                         (30.0, 1800.0, self.check_begins_anywhere),
                                         (3600.0, 3500.0, self.check_begins_anywhere),
                                         (599.0, 0.0, self.check_begins_anywhere),
                                         (601.0, 0.0, self.check_begins_where_told)):
            with self.subTest(after_s=after_s, behind_s=behind_s):
                self.setUp()
                self.fly(self.client(), 1)
                self.restart_computer(after_s, behind_s)
                self.fake.silent_s = max(20.0, after_s - behind_s)
                self.fake.left_s = self.fake.TIME_OF_SILENCE_S - 15.0
                self.fly(self.client(), 2)
                check()

    def test_of_the_computer_believe_no_silence_of_a_service_whose_own_clock_is_behind(self):
        self.fly(self.client(), 1)
        self.restart_computer(60.0)
        self.fake.silent_s, self.fake.set_s = 15.0, -1000.0
        self.fly(self.client(), 2)
        self.check_begins_anywhere()

    def test_of_the_computer_begin_anywhere_where_the_track_went_on_without_the_state(self):
        for last in ({"sequence": 900, "time_us": 900}, {"sequence": 1, "time_us": 900}):
            self.setUp()
            self.fly(self.client(), 1)
            self.restart_computer(5.0)
            self.fake.silent_s, self.fake.last = 5.0, last
            self.fly(self.client(), 2)
            self.check_begins_anywhere()

    def test_ask_the_service_where_the_state_is_of_a_time_that_is_yet_to_come(self):
        self.fly(self.client(), 1)
        self.pass_s(-500.0)
        self.fake.silent_s = 30.0
        self.fly(self.client(), 2, origin="b")
        self.assertAlmostEqual(self.fake.begun()[-1]["radius_m"], WITHIN_M + FASTEST_M_S * (30.0 + ANSWER_TIME_S))

    def test_of_the_computer_begin_anywhere_where_the_track_has_ended_lately(self):
        for after_s, check in ((30.0, self.check_begins_anywhere), (86400.0, self.check_begins_where_told)):
            self.setUp()
            self.fly(self.client(), 1)
            self.restart_computer(after_s)
            self.fake.gone = (410, {"code": "track-ended"})
            self.fly(self.client(), 2)
            check()

    def test_ask_about_the_track_until_the_service_answers(self):
        self.fly(self.client(), 1)
        self.restart_computer(5.0, behind_s=1e5)
        self.fake.silent_s, self.fake.gone = 5.0, (503, {"code": "busy"})
        track = self.client(patience_s=0.2)
        with self.assertRaises(Silent):
            self.fly(track, 2)
        self.fake.gone = None
        self.fly(track, 3)
        self.check_goes_on()

    def test_after_a_power_cut_that_emptied_or_cut_the_state_begin_anywhere(self):
        self.fly(self.client(), 1)
        whole = self.state.read_text()
        for left in ("", whole[:1], whole[:40], whole[:40] + "\0" * 100, "\0" * 100):
            self.setUp()
            self.state.write_text(left)
            self.client()  # and is stopped before it flew
            self.fly(self.client(), 2)
            self.assertEqual(len(self.fake.begun()), 1)
            self.check_begins_anywhere()

    def test_know_this_start_of_the_computer_from_others(self):
        if Path("/proc/sys/kernel/random/boot_id").exists():
            self.assertRegex(BOOT, "^[0-9a-f-]{36}$")


class Areas(Flights):
    def test_of_new_tracks_are_as_wide_as_the_vehicle_may_have_flown_whatever_the_clock_was_set_to(self):
        for set_s in (-100.0, 0.0, 1e8):
            self.setUp()
            track = self.client()
            self.fly(track, 1)
            self.pass_s(60.0, set_s)
            self.fly(track, 2, origin="b")
            self.assertAlmostEqual(self.fake.begun()[-1]["radius_m"], WITHIN_M + FASTEST_M_S * 60.0)

    def test_of_new_tracks_hold_a_vehicle_that_flew_faster(self):
        track = self.client()
        self.fly(track, 1)
        self.pass_s(10.0)
        self.fake.script = [(410, {"code": "track-ended"})]
        track.step((10.0, 900.0, 0.0), {"time_us": 2}, origin="a")
        self.assertAlmostEqual(self.fake.begun()[-1]["radius_m"], WITHIN_M + 900.0)

    def test_of_new_tracks_are_no_wider_by_a_jump_of_the_frame(self):
        track = self.client()
        self.fly(track, 1)
        self.pass_s(10.0)
        self.fake.script = [(400, {"code": "parameter-out-of-range", "field": "forward_m"})]
        track.step((4e6, 0.0, 0.0), {"time_us": 2}, origin="a")
        self.assertAlmostEqual(self.fake.begun()[-1]["radius_m"], WITHIN_M + FASTEST_M_S * 10.0)

    def test_of_new_tracks_count_movements_to_the_side(self):
        track = self.client()
        self.fly(track, 1)
        for i in (2, 3):
            track.step((10.0, 400.0 * (i - 1), 0.0), {"time_us": i}, origin="a")
        self.fly(track, 4, origin="b")
        self.assertAlmostEqual(self.fake.begun()[-1]["radius_m"], WITHIN_M + 800.0)


class Files(Flights):
    def test_are_on_the_disk_before_they_take_the_place_of_others_once_a_step_is_taken(self):
        events = []
        with mock.patch("state.os.fsync", lambda _: events.append("synced")), \
                mock.patch("state.os.replace", lambda *_: events.append("replaced")):
            track = self.client()
            self.assertEqual(events, ["synced", "replaced"])
            self.fly(track, 1)
            del events[:]
            self.fly(track, 2)
        self.assertEqual(events, ["replaced", "synced", "replaced"], "the vehicle waits for no disk")


if __name__ == "__main__":
    unittest.main()
