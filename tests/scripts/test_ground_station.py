#!/usr/bin/python3
"""The client of ground stations: its patience, and the lines that it reads."""
import contextlib
import io
import json
import os
import socket
import tempfile
import threading
import time
import unittest
from pathlib import Path

from fake_service import ROOT, FakeService
from words import said

from service import Refused, Service, Silent
from steps import PICTURE_FIELDS, POSITION_FIELDS, NewestLine, all_lines, read_step
from track import Track


@contextlib.contextmanager
def dripping(answer):
    """The address of a service that goes on with this answer ten bytes a second, for five seconds."""
    def drip(connection):
        with connection, contextlib.suppress(OSError):
            connection.sendall(answer)
            for _ in range(50):
                connection.sendall(b" ")
                time.sleep(0.1)

    def accept():
        with contextlib.suppress(OSError):
            while True:
                threading.Thread(target=drip, args=(listening.accept()[0],), daemon=True).start()

    with socket.create_server(("127.0.0.1", 0)) as listening:
        threading.Thread(target=accept, daemon=True).start()
        yield "http://127.0.0.1:%d" % listening.getsockname()[1]


class Answers(unittest.TestCase):
    def test_count_whatever_their_date(self):
        for date in ("Mon, 1 Jan 99999999999 00:00:00 GMT", "once", "Mon, 1 Jan 2024 00:00:00 +99999999999999"):
            with dripping(b"HTTP/1.1 204 No Content\r\nDate: %s\r\n\r\n" % date.encode()) as url:
                service = Service(url, 1.0)
                self.addCleanup(service.close)
                self.assertIsNone(service.ask("GET", "/"))
                self.assertIsNone(service.date_s, date)

    def test_that_refuse_are_told_whatever_is_in_them(self):
        for content in (b"[" * 100_000, b"\xff", b'"later"'):
            with dripping(b"HTTP/1.1 404 Not Found\r\nContent-Length: %d\r\n\r\n%s" % (len(content), content)) as url:
                service = Service(url, 1.0)
                self.addCleanup(service.close)
                with self.assertRaisesRegex(Refused, "404 "):
                    service.ask("GET", "/")


class Patience(unittest.TestCase):
    def test_is_as_long_as_it_is_told_with_a_service_that_says_nothing_and_long_enough_to_ask_again(self):
        with socket.create_server(("127.0.0.1", 0)) as silent:
            service = Service("http://127.0.0.1:%d" % silent.getsockname()[1], 1.0)
            self.addCleanup(service.close)
            began = time.monotonic()
            with self.assertRaisesRegex(Silent, "timed out"):
                service.ask("GET", "/")
            self.assertLess(time.monotonic() - began, 3.0)
            silent.settimeout(0.1)
            for _ in range(2):
                silent.accept()[0].close()

    def test_is_no_longer_with_an_answer_that_comes_in_drops(self):
        for answer in (b"HTTP/1.1 200 OK\r\nX-Drops: ", b"HTTP/1.1 200 OK\r\nContent-Length: 1000\r\n\r\n",
                       b"HTTP/1.1 200 OK\r\nConnection: close\r\nContent-Length: 1000\r\n\r\n"):
            with self.subTest(answer), dripping(answer) as url:
                service = Service(url, 1.0)
                self.addCleanup(service.close)
                began = time.monotonic()
                with self.assertRaisesRegex(Silent, "timed out"):
                    service.ask("GET", "/")
                self.assertLess(time.monotonic() - began, 3.0)

    def test_hears_by_repetition_what_took_longer_than_half_of_it(self):
        with FakeService(delay_s=1.0) as fake:
            service = Service(fake.url, 1.8)
            self.addCleanup(service.close)
            Track(service, {"map": "m"}).step((0.0, 0.0, 0.0), {"time_us": 1})
            self.assertEqual({step["sequence"] for step in fake.steps()}, {1})

    def test_is_told_once_and_so_is_its_end(self):
        with FakeService([503, 503, 503, 200, 503]) as fake, said() as words:
            service = Service(fake.url, 20.0)
            self.addCleanup(service.close)
            track = Track(service, {"map": "m"})
            for time_us in (1, 2, 3):
                track.step((0.0, 0.0, 0.0), {"time_us": time_us})
        self.assertRegex(words.getvalue(), r"^no answer of 127.0.0.1 yet \(503 busy: later\): trying for 1[0-9] s more\n"
                                           r"127.0.0.1 answers again\n$")

    def test_that_ends_while_the_service_is_away_is_told_of_before(self):
        with socket.create_server(("127.0.0.1", 0)) as away:
            port = away.getsockname()[1]
        with said() as words:
            service = Service(f"http://127.0.0.1:{port}", 4.0)
            for _ in range(2):
                with self.assertRaisesRegex(Silent, "within 4 s .*refused"):
                    service.ask("GET", "/")
        self.assertRegex(words.getvalue(), r"^no answer of 127.0.0.1 yet \(.*refused\): trying for [12] s more\n$")


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

    def test_of_pictures_may_say_nothing_of_their_place(self):
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "a.jpg").write_bytes(b"\xff\xd8")
            self.assertIsNone(read_step(next(all_lines(['{"image": "a.jpg", "agl_m": 90}'])), folder, {}).place)
            with self.assertRaisesRegex(ValueError, "needs north_m"):
                read_step(next(all_lines(['{"image": "a.jpg", "east_m": 2, "yaw_deg": 3}'])), folder, {})
        with self.assertRaisesRegex(ValueError, "needs north_m"):
            read_step(next(all_lines(['{"time_us": 5}'])), ".", {})

    def test_without_a_picture_say_nothing_of_its_camera(self):
        text = '{"north_m": 1, "east_m": 2, "yaw_deg": 3, "time_us": 5, "alt_m": 7, "agl_m": 90, "roll_deg": 1}'
        step = read_step(next(all_lines([text])), ".", {"fov_deg": 78, "satellites": 10})
        self.assertEqual(step.fields, {"time_us": 5, "alt_m": 7, "satellites": 10})

    def test_may_describe_a_picture_by_all_that_the_service_knows_of_one(self):
        schema = json.loads((Path(ROOT, "schema/openapi.json")).read_text())
        parameters = schema["paths"]["/v1/tracks/{id}/steps"]["post"]["parameters"]
        names = [schema["components"]["parameters"][p["$ref"].split("/")[-1]]["name"] if "$ref" in p else p["name"]
                 for p in parameters]
        of_the_step = {"sequence", "time_us", "forward_m", "right_m", "turn_deg", "format"}
        self.assertEqual(set(names) - of_the_step, {*PICTURE_FIELDS, *POSITION_FIELDS})

    def test_that_cannot_be_read_say_so(self):
        for text, message in (("[1]", "JSON object"), ('{"north_m": 1, "east_m": 2}', "needs yaw_deg"),
                              ('{"north_m": null, "east_m": 2, "yaw_deg": 0}', "are numbers"),
                              ('{"north_m": NaN, "east_m": 2, "yaw_deg": 0}', "are numbers"),
                              ('{"north_m": 1, "east_m": 1e999, "yaw_deg": 0}', "are numbers"),
                              ('{"north_m": 1, "east_m": 2, "yaw_deg": 1%s}' % ("0" * 400), "are numbers"),
                              ('{"north_m": 1, "east_m": 2, "yaw_deg": 0, "time_us": "now"}', "time_us is a number"),
                              ('{"north_m": 1, "east_m": 2, "yaw_deg": 0, "time_us": NaN}', "time_us is a number"),
                              ('{"north_m": 1, "east_m": 2, "yaw_deg": 0, "monotonic_s": "now"}', "monotonic_s is a n"),
                              ('{"north_m": 1, "east_m": 2, "yaw_deg": 0, "image": 5}', "name of a file"),
                              ("[" * 100_000, "JSON object")):
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
            while len(lines._lines) < 4 and time.monotonic() < until:
                time.sleep(0.01)
            line = next(lines)
            self.assertEqual((line.number, [passed.number for passed in line.passed]), (2, [1]))
            feed.write("{}\n")
            feed.close()
            (line,) = lines
            self.assertEqual((line.number, [passed.number for passed in line.passed]), (5, [3, 4]))

    def test_without_a_time_are_of_when_they_came(self):
        line = next(all_lines(['{"north_m": 1, "east_m": 2, "yaw_deg": 3}']))
        came_us = time.time_ns() // 1000
        time.sleep(0.2)
        self.assertLess(abs(read_step(line, ".", {}).fields["time_us"] - came_us), 100_000)

    def test_keep_the_time_of_this_computer_alone_from_the_service(self):
        text = '{"north_m": 1, "east_m": 2, "yaw_deg": 3, "time_us": 5, "monotonic_s": 6.5}'
        self.assertEqual(read_step(next(all_lines([text])), ".", {}).fields, {"time_us": 5})

    def test_that_wait_when_the_input_ends_are_still_given(self):
        self.assertEqual([line.number for line in NewestLine(io.StringIO("\n{}\n"))], [2])

    def test_without_a_picture_behind_the_last_picture_are_given_when_the_input_ends(self):
        lines = NewestLine(io.StringIO('{"image": "1"}\n{}\n{}\n'))
        with lines._changed:
            lines._changed.wait_for(lambda: lines._end, timeout=10.0)
        self.assertEqual([(line.number, [passed.number for passed in line.passed]) for line in lines],
                         [(1, []), (3, [2])])

    def test_end_with_what_is_wrong_when_the_input_cannot_be_read_any_more(self):
        def broken():
            yield "{}"
            raise OSError("the disk was taken away")

        lines = NewestLine(broken())
        self.assertEqual(next(lines).number, 1)
        with self.assertRaisesRegex(OSError, "taken away"):
            next(lines)


if __name__ == "__main__":
    unittest.main()
