#!/usr/bin/python3
"""The client of ground stations: movements against rotations, and a service that is busy, hangs up, or forgets."""
import http.server
import io
import json
import math
import os
import random
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

PROGRAM = Path(__file__).resolve().parents[2] / "scripts" / "ground_station"
sys.path.insert(0, str(PROGRAM))

from service import Refused, Service, Silent  # noqa: E402
from steps import NewestLine, all_lines, read_step  # noqa: E402
from track import Track, movement  # noqa: E402


class FakeService:
    """Answers with what `script` says, a step at a time: a status, "hang up" before or "lose" after the request was
    taken; then 200."""

    def __init__(self, script=(), delay_s=0.0):
        self.script = list(script)
        self.requests = []
        fake = self

        class Handler(http.server.BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def log_message(self, *_):
                pass

            def do_POST(self):
                body = self.rfile.read(int(self.headers["Content-Length"]))
                time.sleep(delay_s if "/steps" in self.path else 0.0)
                said = fake.script.pop(0) if fake.script and "/steps" in self.path else 200
                if said == "hang up":
                    self.close_connection = True
                    return
                fake.requests.append((self.path, body, dict(self.headers)))
                if said == "lose":
                    self.close_connection = True
                    return
                status, answer = said if isinstance(said, tuple) else (said, {"code": "busy", "detail": "later"})
                if said == 200:
                    answer = {"id": "T"} if self.path == "/v1/tracks" else {"status": "searching"}
                content = json.dumps(answer).encode()
                self.send_response(status)
                self.send_header("Content-Length", str(len(content)))
                if status == 503:
                    self.send_header("Retry-After", "1")
                self.end_headers()
                self.wfile.write(content)

        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        threading.Thread(target=self.server.serve_forever, args=(0.02,), daemon=True).start()
        self.url = f"http://127.0.0.1:{self.server.server_address[1]}"

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.server.shutdown()
        self.server.server_close()

    def steps(self):
        return [json.loads(body) for path, body, _ in self.requests if path.endswith("/steps")]


class Movement(unittest.TestCase):
    def test_takes_the_vehicle_from_the_first_place_to_the_second(self):
        draw = random.Random(1)
        for _ in range(200):
            before, now = ([draw.uniform(-500, 500), draw.uniform(-500, 500), draw.uniform(-720, 720)] for _ in range(2))
            moved = movement(before, now)
            ahead = complex(math.cos(math.radians(before[2])), math.sin(math.radians(before[2])))  # north + i east
            flown = ahead * complex(moved["forward_m"], moved["right_m"])
            self.assertAlmostEqual(before[0] + flown.real, now[0], places=6)
            self.assertAlmostEqual(before[1] + flown.imag, now[1], places=6)
            self.assertLessEqual(abs(moved["turn_deg"]), 180.0)
            self.assertAlmostEqual(math.cos(math.radians(before[2] + moved["turn_deg"] - now[2])), 1.0, places=9)

    def test_turns_the_short_way_round(self):
        self.assertAlmostEqual(movement((0, 0, 350.0), (0, 0, 10.0))["turn_deg"], 20.0)


class Steps(unittest.TestCase):
    def fly(self, fake, count, patience_s=10.0, **options):
        service = Service(fake.url, patience_s)
        self.addCleanup(service.close)
        track = Track(service, {"map": "m", "lat": 1, "lon": 2, "radius_m": 3}, **options)
        return track, [track.step((10.0 * i, 0.0, 0.0), {"time_us": i + 1}) for i in range(count)]

    def test_are_sent_again_with_the_same_number_while_the_service_is_away_or_busy(self):
        with FakeService([200, "hang up", "lose", 503, 502, 200]) as fake:
            began = time.monotonic()
            self.fly(fake, 2)
            self.assertEqual([s["sequence"] for s in fake.steps()], [1, 2, 2, 2, 2])
            self.assertEqual(len({json.dumps(s) for s in fake.steps()[1:]}), 1, "each as the first")
            self.assertGreater(time.monotonic() - began, 1.0, "Retry-After")

    def test_that_may_have_been_taken_keep_their_number(self):
        with FakeService([200] + ["lose"] * 100) as fake:
            track, _ = self.fly(fake, 1, patience_s=0.2)
            with self.assertRaises(Silent):
                track.step((10.0, 0.0, 0.0), {"time_us": 2})
            fake.script.clear()
            track.step((25.0, 0.0, 0.0), {"time_us": 3})
            self.assertEqual(fake.steps()[-1]["sequence"], 3)
            self.assertAlmostEqual(fake.steps()[-1]["forward_m"], 15.0)

    def test_that_were_refused_leave_no_gap_in_numbers_and_movement(self):
        with FakeService([200, (422, {"code": "image-damaged", "detail": "no picture"})]) as fake:
            track, _ = self.fly(fake, 1)
            with self.assertRaisesRegex(Refused, "422 image-damaged: no picture"):
                track.step((10.0, 0.0, 0.0), {"time_us": 2})
            track.step((25.0, 0.0, 0.0), {"time_us": 3})
            self.assertEqual(fake.steps()[-1]["sequence"], 2)
            self.assertAlmostEqual(fake.steps()[-1]["forward_m"], 25.0)

    def test_begin_a_new_track_without_a_movement_where_theirs_has_ended(self):
        with FakeService([200, (410, {"code": "track-ended"})]) as fake:
            self.fly(fake, 2)
            self.assertEqual([path for path, _, _ in fake.requests],
                             ["/v1/tracks", "/v1/tracks/T/steps", "/v1/tracks/T/steps", "/v1/tracks", "/v1/tracks/T/steps"])
            self.assertEqual(fake.steps()[-1]["sequence"], 1)
            self.assertNotIn("forward_m", fake.steps()[-1])

    def begun(self, fake):
        """What the last track was begun with."""
        return json.loads([body for path, body, _ in fake.requests if path == "/v1/tracks"][-1])

    def test_begin_a_new_track_around_the_last_known_place_where_the_origin_is_another(self):
        converged = (200, {"status": "converged", "pose": {"lat": 7.0, "lon": 8.0}, "sigma_m": [4.0, 2.0]})
        with FakeService([converged]) as fake:
            track, _ = self.fly(fake, 2)  # 10 m from the known place
            track.step((900.0, 0.0, 0.0), {"time_us": 3}, origin="restarted")
            begun = self.begun(fake)
            self.assertEqual((begun["lat"], begun["lon"]), (7.0, 8.0))
            self.assertAlmostEqual(begun["radius_m"], 100.0 + 20.0 + 10.0, delta=50.0 * 2.0)
            self.assertNotIn("forward_m", fake.steps()[-1])
            track.step((930.0, 0.0, 0.0), {"time_us": 4}, origin="restarted")
            self.assertAlmostEqual(fake.steps()[-1]["forward_m"], 30.0)

    def test_know_less_of_the_last_known_place_with_every_restart(self):
        converged = (200, {"status": "converged", "pose": {"lat": 7.0, "lon": 8.0}, "sigma_m": [4.0, 2.0]})
        with FakeService([converged]) as fake:
            track, _ = self.fly(fake, 1)
            radii_m = []
            for origin in ("a", "b"):
                time.sleep(0.5)
                track.step((0.0, 0.0, 0.0), {"time_us": 3}, origin=origin)
                radii_m.append(self.begun(fake)["radius_m"])
            self.assertGreater(radii_m[1], radii_m[0] + 20.0)

    def test_forget_a_flight_of_long_ago(self):
        converged = (200, {"status": "converged", "pose": {"lat": 7.0, "lon": 8.0}, "sigma_m": [4.0, 2.0]})
        for age_s, tracks in ((60.0, 1), (3600.0, 2)):
            with FakeService([converged]) as fake, tempfile.TemporaryDirectory() as folder:
                state = Path(folder, "state.json")
                self.fly(fake, 1, state_file=state)
                kept = json.loads(state.read_text())
                state.write_text(json.dumps({**kept, "taken_s": kept["taken_s"] - age_s}))
                self.fly(fake, 1, state_file=state)
                self.assertEqual([path for path, _, _ in fake.requests].count("/v1/tracks"), tracks)
                self.assertEqual(self.begun(fake)["lat"], 1, "where the operator says")

    def test_are_not_looked_for_around_a_place_that_was_known_too_far_away(self):
        converged = (200, {"status": "converged", "pose": {"lat": 7.0, "lon": 8.0}, "sigma_m": [4.0, 2.0]})
        with FakeService([converged]) as fake:
            track, _ = self.fly(fake, 1)
            track.step((20_000.0, 0.0, 0.0), {"time_us": 3})
            track.step((0.0, 0.0, 0.0), {"time_us": 4}, origin="restarted")
            self.assertEqual(self.begun(fake)["lat"], 1)

    def test_refuse_the_state_of_another_map(self):
        with FakeService() as fake, tempfile.TemporaryDirectory() as folder:
            state = os.path.join(folder, "state.json")
            self.fly(fake, 1, state_file=state)
            with self.assertRaisesRegex(ValueError, "not of a track over the map 'other'"):
                Track(Service(fake.url), {"map": "other"}, state)
            Path(state).write_text("no state")
            with self.assertRaisesRegex(ValueError, "not of a track over the map 'm'"):
                Track(Service(fake.url), {"map": "m"}, state)

    def test_are_not_begun_with_a_state_that_cannot_be_written(self):
        with FakeService() as fake, self.assertRaises(OSError):
            Track(Service(fake.url), {"map": "m"}, "/nowhere/state.json")

    def test_carry_the_password_of_a_proxy(self):
        with FakeService() as fake:
            service = Service(fake.url.replace("http://", "http://me:p%40ss@"))
            self.addCleanup(service.close)
            Track(service, {"map": "m"}).step((0.0, 0.0, 0.0), {"time_us": 1})
            self.assertEqual(fake.requests[-1][2]["Authorization"], "Basic bWU6cEBzcw==")


class Lines(unittest.TestCase):
    def test_of_pictures_with_a_camera_are_frames(self):
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "a.jpg").write_bytes(b"\xff\xd8")
            text = '{"north_m": 1, "east_m": 2, "yaw_deg": 3, "image": "a.jpg", "agl_m": 90}'
            place, origin, fields, image = read_step(next(all_lines([text])), folder, {"fov_deg": 78, "agl_m": 50})
            self.assertEqual(place, (1.0, 2.0, 3.0))
            self.assertIsNone(origin)
            self.assertEqual(image, b"\xff\xd8")
            self.assertEqual((fields["kind"], fields["fov_deg"], fields["agl_m"]), ("frame", 78, 90))
            self.assertLess(abs(fields["time_us"] / 1e6 - time.time()), 60.0)
            self.assertNotIn("kind", read_step(next(all_lines([text])), folder, {"cell_m": 2}).fields)

    def test_that_cannot_be_read_say_so(self):
        for text, message in (("[1]", "JSON object"), ('{"north_m": 1, "east_m": 2}', "needs yaw_deg"),
                              ('{"north_m": null, "east_m": 2, "yaw_deg": 0}', "are numbers"),
                              ('{"north_m": 1, "east_m": 2, "yaw_deg": 0, "time_us": "now"}', "time_us is a number")):
            with self.assertRaisesRegex(ValueError, message):
                read_step(next(all_lines([text])), ".", {})

    def test_of_a_live_flight_are_the_newest_and_pictures_outlive_those_without(self):
        reader, writer = os.pipe()
        with open(reader) as texts, open(writer, "w") as feed:
            lines = NewestLine(texts)
            for text in ('{"image": "1"}', '{"image": "2"}', "{}", "{}"):
                feed.write(text + "\n")
            feed.flush()
            until = time.monotonic() + 10.0
            while (lines._waiting is None or lines._waiting.number < 2) and time.monotonic() < until:
                time.sleep(0.01)
            time.sleep(0.2)  # for the two that must not displace it
            self.assertEqual(next(lines).number, 2)
            feed.write("{}\n")
            feed.close()
            self.assertEqual([line.number for line in lines], [5])

    def test_that_wait_when_the_input_ends_are_still_given(self):
        self.assertEqual([line.number for line in NewestLine(io.StringIO("\n{}\n"))], [2])


class Positions(unittest.TestCase):
    """What reaches an autopilot of a step that was captured some time ago."""

    def setUp(self):
        self.autopilot = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.addCleanup(self.autopilot.close)
        self.autopilot.bind(("127.0.0.1", 0))
        self.autopilot.setblocking(False)

    def sent(self, packet_format, script=(), captured_s_ago=0.0, delay_s=0.0):
        steps = json.dumps({"north_m": 0, "east_m": 0, "yaw_deg": 0, "time_us": (time.time() - captured_s_ago) * 1e6})
        with FakeService(script, delay_s) as fake:
            program = subprocess.run(
                [sys.executable, "-B", str(PROGRAM), "--server", fake.url, "--map", "m", "--format", packet_format,
                 "--send", "127.0.0.1:%d" % self.autopilot.getsockname()[1]], input=steps + "\n", capture_output=True,
                text=True, timeout=60)
        self.assertEqual(program.returncode, 0, program.stderr)
        try:
            return bool(self.autopilot.recv(2048))
        except BlockingIOError:
            self.assertIn("is not sent: it is", program.stderr)
            return False

    def test_is_fresh(self):
        for packet_format in ("gps_input", "global_position_sensor"):
            self.assertTrue(self.sent(packet_format))

    def test_is_not_what_was_captured_or_waited_for_long_ago(self):
        for packet_format in ("gps_input", "global_position_sensor"):
            self.assertFalse(self.sent(packet_format, captured_s_ago=3.0))
            self.assertFalse(self.sent(packet_format, script=[503]), "a second until it was sent again")

    def test_is_what_the_service_took_long_for_only_if_the_message_says_so(self):
        self.assertTrue(self.sent("command_int", delay_s=0.8))
        self.assertFalse(self.sent("nmea", delay_s=0.8))

    def test_is_that_of_a_recording_whatever_its_clock(self):
        self.assertTrue(self.sent("gps_input", captured_s_ago=1e6))


class Program(unittest.TestCase):
    def test_ends_quietly_when_nobody_reads_its_answers(self):
        lines = '{"north_m": 0, "east_m": 0, "yaw_deg": 0}\n' * 3
        with FakeService() as fake:
            reader, writer = os.pipe()
            os.close(reader)
            program = subprocess.run([sys.executable, "-B", str(PROGRAM), "--server", fake.url, "--map", "m"],
                                     input=lines, stdout=writer, stderr=subprocess.PIPE, text=True, timeout=60)
            os.close(writer)
        self.assertEqual((program.returncode, program.stderr), (1, ""))


if __name__ == "__main__":
    unittest.main()
