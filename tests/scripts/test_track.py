#!/usr/bin/python3
"""A flight that the ground station's client follows, with a service that is busy, hangs up, or forgets."""
import contextlib
import json
import os
import tempfile
import time
import unittest
from pathlib import Path

from fake_service import CONVERGED, FakeService
from followed import Followed
from words import said

from service import Refused, Service, Silent
from track import Track, WrongTrack


class Steps(Followed):
    def test_are_sent_again_with_the_same_number_while_the_service_is_away_or_busy(self):
        with FakeService([200, "hang up", "lose", 503, 502, 200]) as fake:
            began = time.monotonic()
            self.fly(fake, 2)
            self.assertEqual([s["sequence"] for s in fake.steps()], [1, 2, 2, 2, 2])
            self.assertEqual(len({json.dumps(s) for s in fake.steps()[1:]}), 1, "each as the first")
            self.assertGreater(time.monotonic() - began, 1.0, "Retry-After")

    def test_are_sent_again_for_all_that_a_service_or_a_proxy_says_of_being_busy(self):
        for status in (408, 429, 502, 503, 504):
            with FakeService([200, status]) as fake:
                self.fly(fake, 2)
                self.assertEqual([s["sequence"] for s in fake.steps()], [1, 2, 2], status)

    def test_that_may_have_been_taken_keep_their_number(self):
        with FakeService([200] + ["lose"] * 100) as fake:
            track, _ = self.fly(fake, 1, patience_s=0.2)
            with self.assertRaises(Silent):
                track.step((10.0, 0.0, 0.0), {"time_us": 2})
            fake.script.clear()
            track.step((25.0, 0.0, 0.0), {"time_us": 3})
            self.assertEqual(fake.steps()[-1]["sequence"], 3)
            self.assertAlmostEqual(fake.steps()[-1]["forward_m"], 15.0)

    def test_that_never_arrived_leave_no_gap_in_numbers_and_movement(self):
        with FakeService([200] + ["hang up"] * 100) as fake:
            track, _ = self.fly(fake, 1, patience_s=0.2)
            for i in (2, 3):
                with self.assertRaises(Silent):
                    track.step((5.0 * i, 0.0, 0.0), {"time_us": i})
            fake.script.clear()
            track.step((25.0, 0.0, 0.0), {"time_us": 4})
            self.assertEqual([s["sequence"] for s in fake.steps()], [1, 2])
            self.assertAlmostEqual(fake.steps()[-1]["forward_m"], 25.0)

    def test_whose_number_another_step_has_were_not_taken(self):
        with FakeService([200] + ["hang up"] * 100) as fake:
            track, _ = self.fly(fake, 1, patience_s=0.2)
            with self.assertRaises(Silent):
                track.step((10.0, 0.0, 0.0), {"time_us": 2})
            fake.script.clear()
            fake.last = {"sequence": 2, "time_us": 77}
            track.step((25.0, 0.0, 0.0), {"time_us": 3})
            self.assertEqual(fake.steps()[-1]["sequence"], 2)

    def test_whose_position_was_told_are_taken_whatever_comes_of_the_rest_of_the_answer(self):
        for answer in ((500, {}), (404, {}), (403, {"code": "logged-out"}), "pay", "hello"):
            with FakeService([CONVERGED]) as fake:
                track, _ = self.fly(fake, 1)
                fake.script_about = [answer]
                sent = []
                with self.assertRaises(Refused):
                    track.step((10.0, 0.0, 0.0), {"time_us": 2}, packet_format="gps_input", send=sent.append)
                self.assertEqual(len(sent), 1)
                track.step((25.0, 0.0, 0.0), {"time_us": 3})
                self.assertEqual((fake.steps()[-1]["sequence"], len(fake.begun())), (3, 1))
                self.assertAlmostEqual(fake.steps()[-1]["forward_m"], 15.0)

    def test_send_a_picture_once_for_the_autopilot_and_the_answer(self):
        with FakeService([CONVERGED, CONVERGED]) as fake:
            track, _ = self.fly(fake, 1)
            sent = []
            answer = track.step((10.0, 0.0, 0.0), {"time_us": 2}, b"\xff\xd8", packet_format="gps_input",
                                send=sent.append)
            self.assertEqual([step.get("format") for step in fake.steps()], ["json", "gps_input"])
            self.assertEqual(sent, [b"a position"])
            self.assertEqual(answer, {**CONVERGED[1], "sequence": 2, "time_us": 2})

    def test_begin_a_new_track_where_another_client_flies_this_one(self):
        with FakeService([CONVERGED]) as fake:
            track, _ = self.fly(fake, 1)
            of_another = (200, {"id": "T", "last": {"status": "converged", "sequence": 3, "time_us": 7}})
            fake.script_about = [of_another, of_another]
            track.step((10.0, 0.0, 0.0), {"time_us": 2}, packet_format="nmea", send=lambda _: None)
            self.assertEqual([step["sequence"] for step in fake.steps()], [1, 2, 1])
            self.assertEqual((fake.begun()[-1]["lat"], fake.begun()[-1]["lon"]), (7.0, 8.0))
        self.assertIn("another client flies this track, too", self.words.getvalue())

    def test_that_something_in_between_refused_may_have_been_taken(self):
        with FakeService([CONVERGED, (500, {})]) as fake:
            track, _ = self.fly(fake, 1)
            with self.assertRaises(Refused):
                track.step((10.0, 0.0, 0.0), {"time_us": 2})
            fake.last = {"sequence": 2, "time_us": 2}
            track.step((25.0, 0.0, 0.0), {"time_us": 3})
            self.assertEqual((fake.steps()[-1]["sequence"], len(fake.begun())), (3, 1))

    def test_are_the_next_ones_of_a_client_that_was_stopped_while_it_waited(self):
        for fate, sequence, forward_m in (("lose", 3, 15.0), ("hang up", 2, 25.0)):
            with FakeService([200] + [fate] * 100) as fake, tempfile.TemporaryDirectory() as folder:
                state = Path(folder, "state.json")
                track, _ = self.fly(fake, 1, patience_s=0.2, state_file=state)
                with self.assertRaises(Silent):
                    track.step((10.0, 0.0, 0.0), {"time_us": 2})
                fake.script.clear()
                Track(track._service, {"map": "m"}, state).step((25.0, 0.0, 0.0), {"time_us": 3})
                self.assertEqual(fake.steps()[-1]["sequence"], sequence)
                self.assertAlmostEqual(fake.steps()[-1]["forward_m"], forward_m)
                self.assertEqual(len(fake.begun()), 1)

    def test_come_after_one_that_the_service_was_still_at_when_it_was_asked(self):
        with FakeService([200] + ["hang up"] * 100) as fake:
            track, _ = self.fly(fake, 1, patience_s=0.2)
            with self.assertRaises(Silent):
                track.step((10.0, 0.0, 0.0), {"time_us": 2})
            fake.script = ["still at it"]
            track.step((25.0, 0.0, 0.0), {"time_us": 3})
            self.assertEqual([s["sequence"] for s in fake.steps()], [1, 2, 3])
            self.assertAlmostEqual(fake.steps()[-1]["forward_m"], 15.0)
            self.assertEqual(len(fake.begun()), 1)

    def test_that_were_refused_leave_no_gap_in_numbers_and_movement(self):
        with FakeService([200, (422, {"code": "image-damaged", "detail": "no picture"})]) as fake:
            track, _ = self.fly(fake, 1)
            with self.assertRaisesRegex(Refused, "422 image-damaged: no picture"):
                track.step((10.0, 0.0, 0.0), {"time_us": 2})
            track.step((25.0, 0.0, 0.0), {"time_us": 3})
            self.assertEqual(fake.steps()[-1]["sequence"], 2)
            self.assertAlmostEqual(fake.steps()[-1]["forward_m"], 25.0)

    def test_are_refused_where_something_else_answers(self):
        for answer, words in (("pay", "200 not-roadfix: something other than Roadfix answered; .*text/html"),
                              ((302, {}), "something other than Roadfix answered; redirected to http://portal/")):
            with FakeService([200, answer]) as fake:
                track, _ = self.fly(fake, 1)
                sent = []
                with self.assertRaisesRegex(Refused, words):
                    track.step((10.0, 0.0, 0.0), {"time_us": 2}, packet_format="gps_input", send=sent.append)
                self.assertEqual(sent, [])
                track.step((25.0, 0.0, 0.0), {"time_us": 3})
                self.assertEqual(fake.steps()[-1]["sequence"], 2)

    def test_are_refused_where_something_else_answers_in_json(self):
        with FakeService([200, "hello"]) as fake:
            track, _ = self.fly(fake, 1)
            with self.assertRaisesRegex(Refused, "200 not-roadfix: .* an answer without sequence and status"):
                track.step((10.0, 0.0, 0.0), {"time_us": 2})
            track.step((25.0, 0.0, 0.0), {"time_us": 3})
            self.assertEqual(fake.steps()[-1]["sequence"], 2)

    def test_begin_a_new_track_without_a_movement_where_theirs_has_ended(self):
        with FakeService([200, (410, {"code": "track-ended"})]) as fake:
            self.fly(fake, 2)
            self.assertEqual([path for path, _, _ in fake.requests],
                             ["/v1/tracks", "/v1/tracks/T/steps", "/v1/tracks/T/steps", "/v1/tracks", "/v1/tracks/T/steps"])
            self.assertEqual(fake.steps()[-1]["sequence"], 1)
            self.assertNotIn("forward_m", fake.steps()[-1])

    def test_begin_a_new_track_around_the_last_known_place_where_this_one_takes_none_any_more(self):
        for refusal in ((409, {"code": "time-backwards"}),
                        (400, {"code": "parameter-out-of-range", "field": "right_m"}),
                        (409, {"code": "step-differs"}), (409, {"code": "step-late"})):
            with FakeService([CONVERGED, refusal]) as fake:
                track, _ = self.fly(fake, 0)
                track.step((0.0, 0.0, 0.0), {"time_us": 5_000_000})
                track.step((4e6, 0.0, 0.0), {"time_us": 2_000_000})
                self.assertEqual((fake.begun()[-1]["lat"], fake.begun()[-1]["lon"]), (7.0, 8.0))
                self.assertEqual(fake.steps()[-1]["sequence"], 1)
                self.assertNotIn("forward_m", fake.steps()[-1])
                track.step((4e6 + 30.0, 0.0, 0.0), {"time_us": 3_000_000})
                self.assertAlmostEqual(fake.steps()[-1]["forward_m"], 30.0)

    def test_keep_their_track_where_only_one_of_them_is_wrong(self):
        for refusal in ((409, {"code": "time-backwards"}), (400, {"code": "parameter-out-of-range", "field": "agl_m"}),
                        (400, {"code": "missing-parameter", "field": "forward_m"})):
            with FakeService([CONVERGED, refusal]) as fake:
                track, _ = self.fly(fake, 0)
                track.step((0.0, 0.0, 0.0), {"time_us": 5_000_000})
                with self.assertRaises(Refused):
                    track.step((10.0, 0.0, 0.0), {"time_us": 4_500_000})
                self.assertEqual(len(fake.begun()), 1)

    def test_begin_a_new_track_where_the_clock_was_set_back_by_more_than_two_seconds(self):
        for time_us, tracks in ((3_000_000, 1), (2_999_999, 2)):
            with FakeService([CONVERGED, (409, {"code": "time-backwards"})]) as fake:
                track, _ = self.fly(fake, 0)
                track.step((0.0, 0.0, 0.0), {"time_us": 5_000_000})
                with contextlib.suppress(Refused):
                    track.step((10.0, 0.0, 0.0), {"time_us": time_us})
                self.assertEqual(len(fake.begun()), tracks)

    def test_say_why_they_begin_a_new_track(self):
        with FakeService([CONVERGED, (410, {"code": "track-ended", "detail": "it was silent"})]) as fake:
            track, _ = self.fly(fake, 2)
            track.step((0.0, 0.0, 0.0), {"time_us": 3}, origin="restarted")
        self.assertEqual(self.words.getvalue(), "a new track begins: 410 track-ended: it was silent\n"
                                                "a new track begins: the vehicle's frame has another origin\n")

    def test_say_what_their_picture_is(self):
        with FakeService() as fake:
            track, _ = self.fly(fake, 0)
            for i, (picture, kind) in enumerate(((b"\x89PNG\r\n", "image/png"), (b"\xff\xd8", "image/jpeg"))):
                track.step((0.0, 0.0, 0.0), {"time_us": i}, picture)
                self.assertEqual(fake.requests[-1][2]["Content-Type"], kind)

    def test_leave_only_so_many_tracks_behind(self):
        with FakeService() as fake:
            track, _ = self.fly(fake, 0)
            for i in range(12):
                track.step((0.0, 0.0, 0.0), {"time_us": i}, origin=i)
            self.assertEqual((len(fake.begun()), fake.ended), (12, ["/v1/tracks/T"] * 3))

    def test_begin_a_new_track_around_the_last_known_place_where_the_origin_is_another(self):
        with FakeService([CONVERGED]) as fake:
            track, _ = self.fly(fake, 2)  # 10 m from the known place
            track.step((900.0, 0.0, 0.0), {"time_us": 3}, origin="restarted")
            begun = fake.begun()[-1]
            self.assertEqual((begun["lat"], begun["lon"]), (7.0, 8.0))
            self.assertAlmostEqual(begun["radius_m"], 100.0 + 20.0 + 10.0, delta=50.0 * 2.0)
            self.assertNotIn("forward_m", fake.steps()[-1])
            track.step((930.0, 0.0, 0.0), {"time_us": 4}, origin="restarted")
            self.assertAlmostEqual(fake.steps()[-1]["forward_m"], 30.0)

    def test_know_less_of_the_last_known_place_with_every_restart(self):
        with FakeService([CONVERGED]) as fake:
            track, _ = self.fly(fake, 1)
            radii_m = []
            for origin in ("a", "b"):
                time.sleep(0.5)
                track.step((0.0, 0.0, 0.0), {"time_us": 3}, origin=origin)
                radii_m.append(fake.begun()[-1]["radius_m"])
            self.assertGreater(radii_m[1], radii_m[0] + 20.0)

    def test_begin_a_new_track_around_the_last_known_place_however_far_they_have_gone(self):
        with FakeService([CONVERGED]) as fake:
            track, _ = self.fly(fake, 1)
            track.step((20_000.0, 0.0, 0.0), {"time_us": 3})
            track.step((0.0, 0.0, 0.0), {"time_us": 4}, origin="restarted")
            self.assertEqual(fake.begun()[-1]["lat"], 7.0, "where the flight began it may have left")
            self.assertGreater(fake.begun()[-1]["radius_m"], 20_000.0)

    def test_begin_a_new_track_around_the_place_of_the_start_where_none_was_known_since(self):
        for prior, lat, lon, radius_m in (({"lat": 1, "lon": 2, "radius_m": 3}, 1, 2, 3.0),
                                          ({"bbox": [179.0, 1.0, 181.0, 3.0]}, 2.0, -180.0, 2.0**0.5 * 111_700.0),
                                          ({"bbox": [179.0, 1.0, -179.0, 3.0]}, 2.0, -180.0, 2.0**0.5 * 111_700.0)):
            with FakeService() as fake:
                request = {"map": "m", "heading_deg": 90, "heading_range_deg": 5, **prior}
                track, _ = self.fly(fake, 1, request=request)
                self.assertEqual(fake.begun()[-1]["heading_deg"], 90)
                track.step((500.0, 0.0, 0.0), {"time_us": 2})
                track.step((0.0, 0.0, 0.0), {"time_us": 3}, origin="restarted")
                begun = fake.begun()[-1]
                self.assertAlmostEqual(begun.pop("radius_m"), radius_m + 500.0, delta=50.0 * 2.0)
                self.assertEqual(begun, {"map": "m", "lat": lat, "lon": lon}, "nor is the heading that of the start")

    def test_ask_the_service_what_is_wrong_with_a_start_however_far_they_have_flown_from_it(self):
        for told in ({"radius_m": 5}, {"bbox": "1,2,3,4"}, {"lat": "37,7", "lon": 38, "radius_m": 5}):
            with FakeService() as fake, self.assertRaisesRegex(WrongTrack, "what is wrong"):
                fake.never_begun = (400, {"code": "bad-parameter", "detail": "what is wrong"})
                track, _ = self.fly(fake, 0, request={"map": "m", **told})
                track.pass_by((0.0, 0.0, 0.0), None)
                track.step((60.0, 0.0, 0.0), {"time_us": 2})

    def test_begin_their_first_track_as_far_from_the_start_as_they_have_flown_while_the_service_was_away(self):
        told = {"map": "m", "lat": 1, "lon": 2, "radius_m": 40, "heading_deg": 90, "heading_range_deg": 5,
                "known_start": True}
        for flown_m, is_known in ((3.0, True), (60.0, True), (200.0, False)):
            with FakeService() as fake:
                track, _ = self.fly(fake, 0, request=told)
                track.pass_by((0.0, 0.0, 0.0), None)
                track.step((flown_m, 0.0, 0.0), {"time_us": 2})
                begun = fake.begun()[-1]
                if flown_m < 5.0:
                    self.assertEqual(begun, told)
                    continue
                self.assertAlmostEqual(begun["radius_m"], 40.0 + flown_m)
                self.assertEqual(begun.get("known_start", False), is_known)
                self.assertNotIn("heading_deg", begun)

    def test_begin_a_new_track_at_a_known_place_as_long_as_it_is_known_well_enough(self):
        told = {"map": "m", "lat": 1, "lon": 2, "radius_m": 3, "known_start": True}
        for flown_m, is_known in ((50.0, True), (500.0, False)):
            with FakeService() as fake:
                track, _ = self.fly(fake, 1, request=told)
                track.step((flown_m, 0.0, 0.0), {"time_us": 2})
                track.step((0.0, 0.0, 0.0), {"time_us": 3}, origin="restarted")
                self.assertEqual(fake.begun()[-1].get("known_start", False), is_known)

    def test_begin_a_new_track_anywhere_where_no_place_was_ever_known(self):
        with FakeService() as fake:
            track, _ = self.fly(fake, 0, request={"map": "m", "wind_sigma_m_s": 5})
            for origin in ("first", "second"):
                track.step((0.0, 0.0, 0.0), {"time_us": 1}, origin=origin)
            self.assertEqual(fake.begun()[-1], {"map": "m", "wind_sigma_m_s": 5})

    def test_refuse_the_state_of_another_map(self):
        with FakeService() as fake, tempfile.TemporaryDirectory() as folder:
            state = os.path.join(folder, "state.json")
            self.fly(fake, 1, state_file=state)
            with self.assertRaisesRegex(ValueError, "not of a track over the map 'other'"):
                Track(Service(fake.url), {"map": "other"}, state)
            kept = Path(state).read_text()
            for damaged in ("no state", "[" * 100_000, kept.replace("[0.0", "[NaN"),
                            kept.replace("[0.0", "[Infinity")):
                Path(state).write_text(damaged)
                with self.assertRaisesRegex(ValueError, "not of a track over the map 'm'"):
                    Track(Service(fake.url), {"map": "m"}, state)

    def test_refuse_a_state_that_lacks_what_a_flight_has(self):
        with FakeService([200] + ["hang up"] * 100) as fake, tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "state.json")
            track, _ = self.fly(fake, 1, patience_s=0.2, state_file=path)
            with self.assertRaises(Silent):
                track.step((10.0, 0.0, 0.0), {"time_us": 2})
            whole = json.loads(path.read_text())
            self.assertEqual(Track(track._service, {"map": "m"}, path).id, "T")
            optional = ("map", "id", "asked", "time_of_silence_s", "former", "time_us", "place")
            damaged = [{n: value for n, value in whole.items() if n != name} for name in whole if name not in optional]
            damaged += [{**whole, "asked": {n: value for n, value in whole["asked"].items() if n != name}}
                        for name in whole["asked"]]
            for state in [*damaged, {"map": "m", "id": "T"}, {**whole, "asked": 5}]:
                path.write_text(json.dumps(state))
                with self.assertRaisesRegex(ValueError, "not of a track over the map 'm': remove it"):
                    Track(track._service, {"map": "m"}, path)

    def test_are_not_begun_with_a_state_that_cannot_be_written(self):
        with FakeService() as fake, self.assertRaises(OSError):
            Track(Service(fake.url), {"map": "m"}, "/nowhere/state.json")

    def test_go_on_while_the_disk_is_full(self):
        with FakeService() as fake, tempfile.TemporaryDirectory() as folder, said() as words:
            state = Path(folder, "state.json")
            track, _ = self.fly(fake, 1, state_file=state)
            full = Path(folder, "state.json.part")
            full.symlink_to("/dev/full")
            for i in (2, 3):
                track.step((10.0 * i, 0.0, 0.0), {"time_us": i})
            self.assertEqual([s["sequence"] for s in fake.steps()], [1, 2, 3])
            self.assertEqual(words.getvalue().count("is not kept up to date"), 1)
            full.unlink()
            track.step((40.0, 0.0, 0.0), {"time_us": 4})
            self.assertEqual(json.loads(state.read_text())["sequence"], 4)
            full.symlink_to("/dev/full")
            track.step((50.0, 0.0, 0.0), {"time_us": 5})
            self.assertEqual(words.getvalue().count("is not kept up to date"), 2)

    def test_carry_the_password_of_a_proxy(self):
        with FakeService() as fake:
            service = Service(fake.url.replace("http://", "http://me:p%40ss@"))
            self.addCleanup(service.close)
            Track(service, {"map": "m"}).step((0.0, 0.0, 0.0), {"time_us": 1})
            self.assertEqual(fake.requests[-1][2]["Authorization"], "Basic bWU6cEBzcw==")


if __name__ == "__main__":
    unittest.main()
