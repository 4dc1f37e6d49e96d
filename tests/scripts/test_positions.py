#!/usr/bin/python3
"""How old a position is, by whatever tells of it, and what is sent to an autopilot."""
import json
import socket
import struct
import unittest
from pathlib import Path
from unittest import mock

from fake_service import packet_of
from words import said

from packet_age import told_age_s, with_age
from positions import Sender
from steps import Line, captured

NOW_S = 5000.0  # since the start of the computer
DATE_S = 1.7e9
PACKETS = Path(__file__).resolve().parents[1] / "server/autopilot/node_mavlink_vectors.json"


def crc(data):
    """CRC-16/MCRF4XX, bit by bit."""
    value = 0xFFFF
    for byte in data:
        value ^= byte
        for _ in range(8):
            value = value >> 1 ^ (0x8408 if value & 1 else 0)
    return value


class Ages(unittest.TestCase):
    """In seconds, of a line that came `came_s_ago`, by its times."""

    def setUp(self):
        for name, now in (("monotonic", NOW_S), ("time", DATE_S)):
            patch = mock.patch(f"time.{name}", lambda now=now: now)
            patch.start()
            self.addCleanup(patch.stop)

    def age_s(self, by_date_s, came_s_ago=0.3, **members):
        line = Line(1, NOW_S - came_s_ago, 0, members)
        return NOW_S - captured(line, {"time_us": 1e6 * (DATE_S - by_date_s)})

    def test_go_by_the_date_or_the_line_whichever_is_longer_ago(self):
        self.assertAlmostEqual(self.age_s(2.3), 2.3, places=5)
        self.assertAlmostEqual(self.age_s(0.1), 0.3)
        self.assertAlmostEqual(self.age_s(0.1, came_s_ago=8.0), 8.0)

    def test_go_by_the_line_where_the_date_lies_ahead(self):
        for ahead_s in (1e-3, 0.5, 2.0, 30.0, 1e6):
            self.assertAlmostEqual(self.age_s(-ahead_s), 0.3)

    def test_go_by_the_line_where_the_date_is_of_a_recording(self):
        self.assertAlmostEqual(self.age_s(599.0), 599.0, places=5)
        self.assertAlmostEqual(self.age_s(601.0), 0.3)

    def test_go_by_the_clock_of_the_computer_whatever_the_date(self):
        for by_date_s in (2.3, 1.3, 0.3, -27.7, 1e6):
            self.assertAlmostEqual(self.age_s(by_date_s, monotonic_s=NOW_S - 2.3), 2.3)
        self.assertAlmostEqual(self.age_s(2.3, monotonic_s=NOW_S - 700.0), 700.0, msg="it waited in the pipe")
        self.assertAlmostEqual(self.age_s(2.3, monotonic_s=NOW_S - 0.1), 0.3, msg="not from before its line came")

    def test_go_by_the_date_where_the_clock_of_the_computer_is_of_another_one(self):
        for other_s in (NOW_S + 0.1, -0.1):
            self.assertAlmostEqual(self.age_s(2.3, monotonic_s=other_s), 2.3, places=5)


class Packets(unittest.TestCase):
    def test_of_a_public_implementation_tell_how_old_their_position_is(self):
        packets = json.loads(PACKETS.read_text())
        for name, packet_format, age_s in (
                ("global_position_sensor", "global_position_sensor", 0.25),
                ("global_position_sensor_unknown", "global_position_sensor", 0.0),
                ("command_int", "command_int", 0.25), ("command_int_unknown", "command_int", 0.0)):
            self.assertEqual(told_age_s(packet_format, bytes.fromhex(packets[name])), age_s, name)

    def test_are_those_of_a_public_implementation_whatever_age_they_had_before(self):
        packets = json.loads(PACKETS.read_text())
        for packet_format, layout in (("global_position_sensor", "<QI"), ("command_int", "<ff")):
            packet = bytes.fromhex(packets[packet_format])
            self.assertEqual(with_age(packet_format, packet, 0.25), packet)
            older = with_age(packet_format, packet, 0.75)
            self.assertEqual(told_age_s(packet_format, older), 0.75)
            self.assertEqual(with_age(packet_format, older, 0.25), packet)
            taken, taken_before = ((sent - age) for sent, age in (
                struct.unpack_from(layout, one, 10) for one in (older, packet)))
            self.assertEqual(taken, taken_before, "it was taken when it was")
            *checked, low, high = older[1:] + older[-2:]
            self.assertEqual(crc(bytes(checked[:-2]) + bytes([158])), low + 256 * high)

    def test_begin_the_time_of_command_int_anew_every_250_s(self):
        packet = bytes.fromhex(json.loads(PACKETS.read_text())["command_int"])
        late = struct.pack("<ff", 249.9, 0.2)
        sent_s, age_s = struct.unpack_from("<ff", with_age("command_int", packet[:10] + late + packet[18:], 0.5), 10)
        self.assertAlmostEqual(sent_s, 0.2, places=4)
        self.assertEqual(age_s, 0.5)


class Senders(unittest.TestCase):
    def setUp(self):
        self.autopilot = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.addCleanup(self.autopilot.close)
        self.autopilot.bind(("127.0.0.1", 0))
        self.autopilot.setblocking(False)
        patch = mock.patch("positions.time.monotonic", lambda: NOW_S)
        patch.start()
        self.addCleanup(patch.stop)

    def sender(self, packet_format):
        sender = Sender(packet_format, self.autopilot.getsockname(), 0.5)
        self.addCleanup(sender._socket.close)
        return sender

    def sent(self, packet_format, age_s, packet=b"a position"):
        with said() as words:
            self.sender(packet_format).send(NOW_S - age_s, packet)
        try:
            return bool(self.autopilot.recv(2048))
        except BlockingIOError:
            self.assertIn("a position is not sent: it is ", words.getvalue())
            return False

    def test_drop_what_is_older_than_it_may_be(self):
        for packet_format in ("gps_input", "mavproxy", "nmea"):
            self.assertTrue(self.sent(packet_format, 0.499))
            self.assertFalse(self.sent(packet_format, 0.501))

    def test_say_how_old_a_dropped_position_is_and_how_old_it_may_be(self):
        for packet_format, age_s, packet, why in (
                ("gps_input", 0.503, b"a position", "0.503 s old, more than --max-age 0.5"),
                ("command_int", 0.94, packet_of("command_int", 0.4),
                 "0.54 s older than the 0.4 s that it says, more than --max-age 0.5"),
                ("command_int", 4.51, packet_of("command_int", 4.4),
                 "4.51 s old, more than the 4.5 s that its receiver believes")):
            with said() as words:
                self.sender(packet_format).send(NOW_S - age_s, packet)
            self.assertEqual(words.getvalue(), f"a position is not sent: it is {why}\n")

    def test_drop_what_is_older_than_ardupilot_believes_whatever_it_says(self):
        for age_s, told_s, sent in ((3.0, 3.0, True), (4.49, 4.4, True), (4.51, 4.4, False), (4.51, 4.51, False),
                                    (0.2, 8.0, False), (1.0, 0.4, False), (1.0, float("nan"), False)):
            self.assertEqual(self.sent("command_int", age_s, packet_of("command_int", told_s)), sent, (age_s, told_s))

    def test_drop_what_is_older_than_px4_takes(self):
        for age_s, told_s, sent in ((0.99, 0.9, True), (1.01, 0.9, False), (0.3, 1.01, False)):
            self.assertEqual(self.sent("global_position_sensor", age_s, packet_of("global_position_sensor", told_s)),
                             sent, (age_s, told_s))

    def test_say_how_old_a_position_is_when_it_is_sent(self):
        packets = json.loads(PACKETS.read_text())
        for packet_format in ("global_position_sensor", "command_int"):
            packet = bytes.fromhex(packets[packet_format])  # of a service that took 0.25 s
            for age_s, told_s in ((0.25, 0.25), (0.5625, 0.5625), (0.1, 0.25)):
                self.sender(packet_format).send(NOW_S - age_s, packet)
                self.assertEqual(told_age_s(packet_format, self.autopilot.recv(2048)), told_s)

    def test_send_no_message_that_came_damaged_or_cut_off_as_one_with_another_age(self):
        packets = json.loads(PACKETS.read_text())
        for packet_format in ("global_position_sensor", "command_int"):
            whole = bytes.fromhex(packets[packet_format])
            with said() as words:
                for damaged in (*(whole[:size] for size in range(len(whole))), whole + b"\0", whole + whole,
                                *(whole[:at] + bytes([whole[at] ^ 4]) + whole[at + 1:] for at in range(1, len(whole)))):
                    self.sender(packet_format).send(NOW_S - 0.25, damaged)
                    self.assertRaises(BlockingIOError, self.autopilot.recv, 2048)
            self.assertEqual(set(words.getvalue().splitlines()),
                             {"a position is not sent: its message is damaged or cut off"})

    def expecting(self, packet_format, *steps):
        sender = self.sender(packet_format)
        with said() as words:
            for fields in steps:
                sender.expect(fields)
        return words.getvalue().splitlines()

    def test_say_once_of_each_field_that_ardupilot_uses_no_position_without_it(self):
        for packet_format in ("gps_input", "mavproxy"):
            height, satellites = self.expecting(packet_format, {}, {"time_us": 5}, {"satellites": 10}, {"alt_m": 512})
            self.assertIn("no alt_m (height above the sea): its position is a 2D fix", height)
            self.assertIn("no satellites (--frame satellites=10): its position counts 0", satellites)
            self.assertEqual(self.expecting(packet_format, {"alt_m": 512, "satellites": 10}), [])
            for told, missed in (("alt_m", "satellites"), ("satellites", "alt_m")):
                words, = self.expecting(packet_format, {told: 10}, {told: 10})
                self.assertIn(f"a step says no {missed} ", words)

    def test_want_neither_height_nor_satellites_in_other_formats(self):
        for packet_format in ("global_position_sensor", "command_int", "nmea"):
            self.assertEqual(self.expecting(packet_format, {}), [])

    def test_say_that_a_packet_cannot_be_sent_and_go_on(self):
        sender = self.sender("nmea")
        with mock.patch.object(sender, "_socket") as broken, said() as words:
            broken.sendto.side_effect = OSError("Network is unreachable")
            for _ in range(2):
                sender.send(NOW_S, b"a position")
        self.assertEqual(words.getvalue(), 2 * "a position is not sent: Network is unreachable\n")


if __name__ == "__main__":
    unittest.main()
