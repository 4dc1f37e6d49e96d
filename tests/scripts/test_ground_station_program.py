#!/usr/bin/python3
"""The program of the client of ground stations: the positions that it sends, and what it says."""
import contextlib
import datetime
import json
import os
import socket
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

from fake_service import BEFORE, PROGRAM, FakeService


class Positions(unittest.TestCase):
    """What reaches an autopilot of a step that was captured some time ago."""

    PATIENT = ("--max-age", "4")  # for a busy machine

    def setUp(self):
        self.autopilot = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.addCleanup(self.autopilot.close)
        self.autopilot.bind(("127.0.0.1", 0))
        self.autopilot.setblocking(False)

    def run_program(self, fake, packet_format, lines, *options, stdout=subprocess.PIPE, stderr=subprocess.PIPE):
        return subprocess.run(
            [sys.executable, "-B", str(PROGRAM), "--server", fake.url, "--map", "m", "--format", packet_format,
             "--send", "127.0.0.1:%d" % self.autopilot.getsockname()[1], *options], input=lines, stdout=stdout,
            stderr=stderr, text=True, timeout=60)

    def sent(self, packet_format, script=(), captured_s_ago=0.0, delay_s=0.0, told_s=None, options=()):
        captured_us = round(1e6 * (time.time() - captured_s_ago))
        steps = json.dumps({"north_m": 0, "east_m": 0, "yaw_deg": 0, "time_us": captured_us})
        with FakeService(script, delay_s, told_s) as fake:
            program = self.run_program(fake, packet_format, steps + "\n", *options)
        self.assertEqual(program.returncode, 0, program.stderr)
        try:
            return bool(self.autopilot.recv(2048))
        except BlockingIOError:
            self.assertIn("is not sent: it is", program.stderr)
            return False

    def test_without_a_height_is_said_once_to_be_of_no_use_to_ardupilot(self):
        for alt_m, warnings in (({}, 1), ({"alt_m": 7}, 0)):
            with FakeService() as fake:
                step = json.dumps({"north_m": 0, "east_m": 0, "yaw_deg": 0, **alt_m})
                program = self.run_program(fake, "mavproxy", 3 * (step + "\n"))
            self.assertEqual(program.stderr.count("says no alt_m"), warnings)

    def positions(self):
        count = 0
        with contextlib.suppress(BlockingIOError):
            while self.autopilot.recv(2048):
                count += 1
        return count

    def test_come_where_answers_and_messages_find_no_room_or_nobody_reads_them(self):
        lines = 3 * '{"north_m": 0, "east_m": 0, "yaw_deg": 0}\n'
        reader, closed = os.pipe()
        os.close(reader)
        with open("/dev/full", "w") as full, open(closed, "w") as nobody:
            for stream, why in ((full, "No space left on device"), (nobody, "Broken pipe")):
                with FakeService() as fake:
                    program = self.run_program(fake, "nmea", lines, *self.PATIENT, stdout=stream)
                self.assertEqual((program.returncode, self.positions()), (1, 3), program.stderr)
                self.assertEqual(program.stderr.count("answers are not printed, the flight goes on"), 1)
                self.assertIn(why, program.stderr)
                with FakeService() as fake:
                    program = self.run_program(fake, "nmea", lines, *self.PATIENT, stderr=stream)
                self.assertEqual((program.returncode, self.positions()), (0, 3))
                self.assertEqual(program.stdout.count("\n"), 3)

    def test_come_where_the_window_is_stopped(self):
        """As by Ctrl-S: nobody reads what is written to it."""
        lines = 20 * '{"north_m": 0, "east_m": 0, "yaw_deg": 0}\n' + 600 * "no step\n"
        long = (200, {"status": "searching", "padding": "x" * 20_000})
        reader, window = os.pipe()
        with FakeService(20 * [long]) as fake, open(reader), open(window, "w") as stopped:
            program = self.run_program(fake, "nmea", lines, *self.PATIENT, stdout=stopped, stderr=stopped)
        self.assertEqual((program.returncode, self.positions()), (1, 20))

    def test_come_where_there_is_no_standard_error(self):
        with FakeService() as fake:
            place = '{"north_m": 0, "east_m": 0, "yaw_deg": 0}'
            command = [sys.executable, "-B", str(PROGRAM), "--server", fake.url, "--map", "m", "--format", "nmea", "--send",
                       "127.0.0.1:%d" % self.autopilot.getsockname()[1], *self.PATIENT]
            program = subprocess.run(["sh", "-c", '"$@" 2>&-', "sh", *command], input=place + "\n", text=True,
                                     stdout=subprocess.PIPE, timeout=60)
        self.assertEqual((program.returncode, self.positions(), program.stdout.count("\n")), (0, 1, 1))

    def test_is_fresh(self):
        for packet_format in ("gps_input", "global_position_sensor"):
            # On a busy machine the program itself may take longer to start than a message may be old.
            self.assertTrue(any(self.sent(packet_format, options=self.PATIENT) for _ in range(5)))

    def test_is_not_what_was_captured_or_waited_for_long_ago(self):
        for packet_format in ("gps_input", "global_position_sensor"):
            self.assertFalse(self.sent(packet_format, captured_s_ago=3.0))
            self.assertFalse(self.sent(packet_format, script=[503]), "a second until it was sent again")

    def test_is_not_what_took_long_on_the_way_to_the_service_and_back(self):
        for packet_format in ("global_position_sensor", "command_int"):
            self.assertFalse(self.sent(packet_format, delay_s=0.8, told_s=0.1))

    def test_is_that_of_a_recording_whatever_its_clock(self):
        self.assertTrue(self.sent("gps_input", captured_s_ago=1e6))


class Program(unittest.TestCase):
    def lines_and_a_picture(self, folder):
        """10 m to the north each, the third with a picture that cannot be read."""
        Path(folder, "3.jpg").write_bytes(b"\xff\xd8")
        place = {"east_m": 0, "yaw_deg": 0, "covariance": [1.0, 0, 0, 0, 1.0, 0, 0, 0, 0]}
        pictures = ({}, {}, {"image": "missing.jpg"}, {"image": f"{folder}/3.jpg"})
        return [json.dumps({"north_m": 10 * i, "time_us": i, **place, **more}) for i, more in enumerate(pictures)]

    def check_covariances(self, steps):
        for step in steps:
            variance = float(str(step["covariance"]).strip("[").split(",")[0])
            self.assertEqual(variance, float(step["forward_m"]) / 10.0)

    def test_sends_the_covariance_of_all_lines_that_a_movement_spans(self):
        with FakeService() as fake, tempfile.TemporaryDirectory() as folder:
            program = subprocess.run([sys.executable, "-B", str(PROGRAM), "--server", fake.url, "--map", "m"],
                                     input="\n".join(self.lines_and_a_picture(folder)), capture_output=True, text=True,
                                     timeout=60)
            self.assertIn("line 3 (missing.jpg): ", program.stderr)
            self.assertEqual([float(step["forward_m"]) for step in fake.steps()[1:]], [10.0, 20.0])
            self.check_covariances(fake.steps()[1:])

    def test_sends_the_covariance_of_all_lines_that_it_passes_by_in_flight(self):
        with FakeService() as fake, tempfile.TemporaryDirectory() as folder:
            lines = self.lines_and_a_picture(folder)
            program = subprocess.Popen(
                [sys.executable, "-B", str(PROGRAM), "--server", fake.url, "--map", "m", "--live"],
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            program.stdin.write(lines[0] + "\n")
            program.stdin.flush()
            program.stdout.readline()
            program.communicate("\n".join(lines[1:]) + "\n", timeout=60)
            sent = fake.steps()[1:]  # one or two, by how fast the lines were read
        self.assertEqual(sum(float(step["forward_m"]) for step in sent), 30.0)
        self.check_covariances(sent)

    def test_ends_where_no_track_can_begin_with_what_it_was_told_and_else_goes_on(self):
        wrong = (400, {"code": "missing-parameter", "detail": "'lon' is missing"})
        for refusal, tries in ((wrong, 1), ((400, {}), 3), ((422, {"code": "map-too-large"}), 3)):
            with FakeService() as fake:
                fake.never_begun = refusal
                program = subprocess.run(
                    [sys.executable, "-B", str(PROGRAM), "--server", fake.url, "--map", "m", "--track", "lat=37.76"],
                    input=3 * '{"north_m": 0, "east_m": 0, "yaw_deg": 0}\n', capture_output=True, text=True, timeout=60)
            self.assertEqual((program.returncode, len(fake.begun())), (1, tries))
            self.assertEqual(program.stderr.count("ground_station: --track: 400 missing-parameter: 'lon' is missing"),
                             1 if tries == 1 else 0)

    def test_says_where_the_file_of_steps_stands(self):
        for option in ("--frame", "--track"):
            program = subprocess.run([sys.executable, "-B", str(PROGRAM), "--map", "m", option, "a=1", "flight.jsonl"],
                                     capture_output=True, text=True, timeout=60)
            self.assertEqual(program.returncode, 2)
            self.assertIn("usage: ground_station [steps] --map MAP", program.stderr)
            self.assertIn("'flight.jsonl': write NAME=VALUE, and the file of steps before all options", program.stderr)

    def test_refuses_a_track_on_another_map(self):
        program = subprocess.run([sys.executable, "-B", str(PROGRAM), "--map", "m", "--track", "lat=1", "map=city"],
                                 capture_output=True, text=True, timeout=60)
        self.assertEqual(program.returncode, 2)
        self.assertIn("--track map: the map is that of --map", program.stderr)

    def test_refuses_addresses_and_times_that_there_are_not(self):
        for option, value, remedy in (("--send", "127.0.0.1", "write HOST:PORT"), ("--patience", "nan", "write a number"),
                                      ("--send", "127.0.0.1:65536", "write HOST:PORT"), ("--max-age", "-1", "write a number")):
            program = subprocess.run([sys.executable, "-B", str(PROGRAM), "--map", "m", option, value],
                                     capture_output=True, text=True, timeout=60)
            self.assertEqual(program.returncode, 2)
            self.assertIn(f"argument {option}: '{value}': {remedy}", program.stderr)

    def test_vouches_for_a_start_only_where_it_would_know_of_it_after_a_restart(self):
        with FakeService() as fake, tempfile.TemporaryDirectory() as folder:
            known = ("--track", "lat=37.7", "lon=38.3", "radius_m=50", "known_start=true")
            step = json.dumps({"time_us": 1, "north_m": 0, "east_m": 0, "yaw_deg": 0})
            for state in ((), ("--state", os.path.join(folder, "flight.json"))):
                program = subprocess.run([sys.executable, "-B", str(PROGRAM), "--server", fake.url, "--map", "m", *known,
                                          *state], input=step, capture_output=True, text=True, timeout=60)
                self.assertEqual(program.returncode, 0 if state else 2, program.stderr)
                self.assertEqual("goes with --state" in program.stderr, not state)
            self.assertEqual([request.get("known_start") for request in fake.begun()], [True])

    def test_says_when_and_of_which_picture_something_is_wrong(self):
        refused = (422, {"code": "image-damaged", "detail": "no picture"})
        with FakeService([200, 200, refused]) as fake, tempfile.TemporaryDirectory() as folder:
            *good, _, bad = self.lines_and_a_picture(folder)
            began_s = time.time()
            program = subprocess.run([sys.executable, "-B", str(PROGRAM), "--server", fake.url, "--map", "m"],
                                     input="\n".join([*good, bad]), capture_output=True, text=True, timeout=60)
        date, words = program.stderr.splitlines()[-1].split(" ", 1)
        self.assertEqual(words, f"line 3 ({folder}/3.jpg): 422 image-damaged: no picture")
        self.assertRegex(date, r"^[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9:]{8}\.[0-9]{3}Z$")
        told_s = datetime.datetime.fromisoformat(date.replace("Z", "+00:00")).timestamp()
        self.assertTrue(began_s - 0.01 <= told_s <= time.time() + 0.01)

    def test_names_the_picture_of_each_answer(self):
        with FakeService() as fake, tempfile.TemporaryDirectory() as folder:
            program = subprocess.run([sys.executable, "-B", str(PROGRAM), "--server", fake.url, "--map", "m"],
                                     input="\n".join(self.lines_and_a_picture(folder)), capture_output=True, text=True,
                                     timeout=60)
        answers = [json.loads(line) for line in program.stdout.splitlines()]
        self.assertEqual([answer.get("image") for answer in answers], [None, None, f"{folder}/3.jpg"])

    def test_goes_on_after_lines_that_are_no_text(self):
        good = b'{"north_m": 0, "east_m": 0, "yaw_deg": 0}\n'
        lines = good + b'{"note": "\xfc"}\n' + b"[" * 100_000 + b"\n" + good
        for live in ([], ["--live"]):
            with FakeService() as fake, tempfile.TemporaryDirectory() as folder:
                Path(folder, "lines").write_bytes(lines)
                command = [sys.executable, "-B", str(PROGRAM), "--server", fake.url, "--map", "m", *live]
                for source in ([], [os.path.join(folder, "lines")]):
                    program = subprocess.run(command + source, input=lines, capture_output=True, timeout=60)
                    self.assertNotIn(b"Traceback", program.stderr)
                    answers = program.stdout.splitlines()
                    if not live:
                        self.assertEqual(len(answers), 2, program.stderr)
                        self.assertIn(b"line 3: a step is a JSON object", program.stderr)
                    self.assertTrue(answers)

    def test_ends_quietly_when_nobody_reads_its_answers(self):
        lines = '{"north_m": 0, "east_m": 0, "yaw_deg": 0}\n' * 3
        with FakeService() as fake:
            reader, writer = os.pipe()
            os.close(reader)
            program = subprocess.run([sys.executable, "-B", str(PROGRAM), "--server", fake.url, "--map", "m"],
                                     input=lines, stdout=writer, stderr=subprocess.PIPE, text=True, timeout=60)
            os.close(writer)
        self.assertEqual(program.returncode, 1)
        self.assertRegex(program.stderr, rf"^{BEFORE}\S+Z a track begins: {fake.url}/#track=T\n$")

    def test_says_once_where_its_track_is_to_be_seen_and_keeps_the_password(self):
        lines = '{"north_m": 0, "east_m": 0, "yaw_deg": 0}\n' * 3
        with FakeService() as fake:
            server = fake.url.replace("//", "//me:secret@") + "/"
            program = subprocess.run([sys.executable, "-B", str(PROGRAM), "--server", server, "--map", "m"], input=lines,
                                     capture_output=True, text=True, timeout=60)
        self.assertEqual(program.returncode, 0)
        self.assertRegex(program.stderr, rf"^{BEFORE}\S+Z a track begins: {fake.url}/#track=T\n$")


if __name__ == "__main__":
    unittest.main()
