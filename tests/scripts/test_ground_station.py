#!/usr/bin/python3
"""The client of ground stations: movements against rotations, and a service that is busy, hangs up, or forgets."""
import http.server
import io
import json
import math
import os
import random
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts" / "ground_station"))

from service import Refused, Service, Silent  # noqa: E402
from steps import NewestLine, all_lines, read_step  # noqa: E402
from track import Track, movement  # noqa: E402


class FakeService:
    """Answers with what `script` says, a step at a time: a status, "hang up" before or "lose" after the request was
    taken; then 200."""

    def __init__(self, script=()):
        self.script = list(script)
        self.requests = []
        fake = self

        class Handler(http.server.BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def log_message(self, *_):
                pass

            def do_POST(self):
                body = self.rfile.read(int(self.headers["Content-Length"]))
                said = fake.script.pop(0) if fake.script and "/steps" in self.path else 200
                if said == "hang up":
                    self.close_connection = True
                    return
                fake.requests.append((self.path, body, dict(self.headers)))
                if said == "lose":
                    self.close_connection = True
                    return
                status, answer = said if isinstance(said, tuple) else (said, {"code": "busy", "detail": "later"})
                if status == 200:
                    answer = {"id": "T"} if self.path == "/v1/tracks" else {"status": "searching"}
                content = json.dumps(answer).encode()
                self.send_response(status)
                self.send_header("Content-Length", str(len(content)))
                if status == 503:
                    self.send_header("Retry-After", "1")
                self.end_headers()
                self.wfile.write(content)

        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        threading.Thread(target=self.server.serve_forever, daemon=True).start()
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

    def test_refuse_the_state_of_another_map(self):
        with FakeService() as fake, tempfile.TemporaryDirectory() as folder:
            state = os.path.join(folder, "state.json")
            self.fly(fake, 1, state_file=state)
            with self.assertRaisesRegex(ValueError, "over the map 'm'"):
                Track(Service(fake.url), {"map": "other"}, state)

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
            place, fields, image = read_step(next(all_lines([text])), folder, {"fov_deg": 78, "agl_m": 50})
            self.assertEqual(place, (1.0, 2.0, 3.0))
            self.assertEqual(image, b"\xff\xd8")
            self.assertEqual((fields["kind"], fields["fov_deg"], fields["agl_m"]), ("frame", 78, 90))
            self.assertLess(abs(fields["time_us"] / 1e6 - time.time()), 60.0)
            self.assertNotIn("kind", read_step(next(all_lines([text])), folder, {"cell_m": 2})[1])

    def test_that_cannot_be_read_say_so(self):
        for text, message in (("[1]", "JSON object"), ('{"north_m": 1, "east_m": 2}', "needs yaw_deg"),
                              ('{"north_m": null, "east_m": 2, "yaw_deg": 0}', "are numbers")):
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


if __name__ == "__main__":
    unittest.main()
