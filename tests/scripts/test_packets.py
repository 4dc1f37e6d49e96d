#!/usr/bin/python3
"""Packets of MAVLink as the public implementation node-mavlink 2.3.0 writes them."""
import random
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts" / "mavlink_steps"))

from crc import crc  # noqa: E402
from packets import Stream  # noqa: E402

# system 7, component 1
ATTITUDE = bytes.fromhex(
    "fd1c00000307011e000040e201000000003e000080bd0000c03f00000000000000000000803eddd5")
ATTITUDE_OF_VERSION_1 = bytes.fromhex(
    "fe1c0307011e40e201000000003e000080bd0000c03f00000000000000000000803e3148")
LOCAL_POSITION = bytes.fromhex(
    "fd1800000407012000006ce201000000803f00000040004096c300004841000050c00fba")  # the last zeros are left out
OTHERS = {
    "VFR_HUD": (bytes.fromhex("fd1300000507014a000000008c410000a04100000044000000005a003768b6"),
                {"airspeed": 17.5, "alt": 512.0}),
    "TERRAIN_REPORT": (bytes.fromhex("fd1500000607018800007b358216d395cd160000164400209b436400000054823c"),
                       {"current_height": 310.25}),
    "ALTITUDE": (bytes.fromhex("fd2000000707018d000015cd5b07000000000000803f0000004000004040000080400000a04000c08f43"
                               "759e"), {"bottom_clearance": 287.5, "altitude_amsl": 2.0}),
    "GLOBAL_POSITION_INT": (
        bytes.fromhex("fd1c000009070121000040e201007b3582162d0821b7fad0070024faffff6400ceff07002823eb90"),
        {"time_boot_ms": 123456, "lat": 377632123, "lon": -1222571987, "relative_alt": -1500}),
    "GPS_RAW_INT": (
        bytes.fromhex("fd2c00000a070118000015cd5b07000000007b3582162d0821b7fad007007900c800e2042823030c603d0800dc050000"
                      "c40900002c01ca19"), {"lat": 377632123, "lon": -1222571987, "fix_type": 3}),
    "EKF_STATUS_REPORT": (
        bytes.fromhex("fd1a0000090701c100000000003f0000803e0000003e0000403f00000000a5000000003f232f"),
        {"velocity_variance": 0.5, "compass_variance": 0.75, "flags": 1 | 4 | 32 | 128}),
    "ESTIMATOR_STATUS": (
        bytes.fromhex("fd290000090701e6000015cd5b07000000000000003f0000803e0000003e0000403f00000000000000000000c03f0000"
                      "2040a54a70"), {"time_usec": 123456789, "pos_vert_accuracy": 2.5, "flags": 1 | 4 | 32 | 128}),
    "HOME_POSITION": (
        bytes.fromhex("fd350000090701f200007b3582162d0821b7fad007000000c03f000020c0000044c10000803f00000000000000000000"
                      "00000000000000000000000000000589ee"), {"altitude": 512250, "x": 1.5, "y": -2.5, "z": -12.25}),
    "COMMAND_ACK": (bytes.fromhex("fd0a00000907014d0000fba704000000000007bf8218"), {"command": 43003, "result": 4}),
    "GIMBAL_DEVICE_ATTITUDE_STATUS": (
        bytes.fromhex("fd31000009079a1d010040e201000000003f0000003f000000bf0000003f0000c07f0000803e0000c0bf000000002c00"
                      "00000000a0bf0000c07f021ed6"),
        {"time_boot_ms": 123456, "qw": 0.5, "qx": 0.5, "qy": -0.5, "qz": 0.5, "flags": 44, "delta_yaw": -1.25,
         "gimbal_device_id": 2}),
}


def messages(data):
    return Stream().messages(data)


class Packets(unittest.TestCase):
    def test_of_both_versions_are_read_as_another_implementation_writes_them(self):
        for data in (ATTITUDE, ATTITUDE_OF_VERSION_1):
            (message,) = messages(data)
            self.assertEqual(message[:3], (7, 1, "ATTITUDE"))
            self.assertEqual(message.fields, {"time_boot_ms": 123456, "roll": 0.125, "pitch": -0.0625, "yaw": 1.5})
        (message,) = messages(LOCAL_POSITION)
        self.assertEqual(message.fields, {"time_boot_ms": 123500, "x": 1.0, "y": 2.0, "z": -300.5, "vx": 12.5,
                                          "vy": -3.25, "vz": 0.0})
        for name, (data, fields) in OTHERS.items():
            (message,) = messages(data)
            self.assertEqual(message.name, name)
            self.assertEqual({field: message.fields[field] for field in fields}, fields)

    def test_are_found_among_others_and_rubbish(self):
        unknown = b"\xfd\x04\x00\x00\x00\x07\x01\x00\x00\x00" + bytes(6)
        signed = ATTITUDE[:2] + b"\x01" + ATTITUDE[3:-2]
        signature = b"\xfd\x40\x00\x00\x00\x01\x01\x05" + bytes(5)  # as if a packet began there
        signed += crc(signed[1:] + b"\x27").to_bytes(2, "little") + signature
        data = b"\xfd\xfe\x00" + unknown + signed + ATTITUDE_OF_VERSION_1 + LOCAL_POSITION + b"\xfe"
        self.assertEqual([m.name for m in messages(data)], ["ATTITUDE", "ATTITUDE", "LOCAL_POSITION_NED"])

    def test_that_are_damaged_are_left_out_whatever_the_damage(self):
        draw = random.Random(2)
        for _ in range(2000):
            data = bytearray(ATTITUDE + LOCAL_POSITION)
            for _ in range(draw.randrange(1, 4)):
                data[draw.randrange(len(data))] ^= 1 << draw.randrange(8)
            del data[draw.randrange(len(data)):]
            for message in messages(bytes(data)):
                self.assertIn(message, messages(ATTITUDE + LOCAL_POSITION))

    def test_go_on_in_the_next_datagram_as_bridges_of_serial_lines_pass_them_on(self):
        others = b"".join(data for data, _ in OTHERS.values())
        unknown = b"\xfd\x04\x00\x00\x00\x07\x01\x00\x00\x00" + bytes(6)
        line = 3 * (ATTITUDE + unknown + ATTITUDE_OF_VERSION_1 + others + LOCAL_POSITION)
        for size in (1, 2, 7, 16, 64, 300):
            stream = Stream()
            found = [message for at in range(0, len(line), size) for message in stream.messages(line[at:at + size])]
            self.assertEqual([str(message) for message in found], [str(message) for message in messages(line)], size)

    def test_that_were_cut_off_cost_no_more_than_the_next_one(self):
        stream = Stream()
        for cut in range(1, len(ATTITUDE)):
            self.assertEqual(stream.messages(ATTITUDE[:cut]), [])
            stream.messages(LOCAL_POSITION)
            self.assertEqual(stream.messages(LOCAL_POSITION), messages(LOCAL_POSITION), cut)


if __name__ == "__main__":
    unittest.main()
