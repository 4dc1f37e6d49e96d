"""MAVLink 1 and 2 packets (https://mavlink.io/en/guide/serialization.html) and the messages that tell how a vehicle
moves and what it answers, by common.xml and ardupilotmega.xml."""
import struct
from typing import NamedTuple

from crc import crc

STARTS = START_1, START_2 = 0xFE, 0xFD  # of both versions

#: id: name, CRC_EXTRA, wire order of the fields that are used
MESSAGES = {
    24: ("GPS_RAW_INT", 24, "<Q3i4HB", ("time_usec", "lat", "lon", "alt", "eph", "epv", "vel", "cog", "fix_type")),
    30: ("ATTITUDE", 39, "<Ifff", ("time_boot_ms", "roll", "pitch", "yaw")),
    32: ("LOCAL_POSITION_NED", 185, "<I6f", ("time_boot_ms", "x", "y", "z", "vx", "vy", "vz")),
    33: ("GLOBAL_POSITION_INT", 104, "<I4i", ("time_boot_ms", "lat", "lon", "alt", "relative_alt")),
    74: ("VFR_HUD", 20, "<3f", ("airspeed", "groundspeed", "alt")),
    77: ("COMMAND_ACK", 143, "<HB", ("command", "result")),
    136: ("TERRAIN_REPORT", 1, "<iiffH", ("lat", "lon", "terrain_height", "current_height", "spacing")),
    141: ("ALTITUDE", 47, "<Q6f", ("time_usec", "altitude_monotonic", "altitude_amsl", "altitude_local",
                                   "altitude_relative", "altitude_terrain", "bottom_clearance")),
    193: ("EKF_STATUS_REPORT", 71, "<5fH", ("velocity_variance", "pos_horiz_variance", "pos_vert_variance",
                                            "compass_variance", "terrain_alt_variance", "flags")),
    230: ("ESTIMATOR_STATUS", 163, "<Q8fH", ("time_usec", "vel_ratio", "pos_horiz_ratio", "pos_vert_ratio", "mag_ratio",
                                             "hagl_ratio", "tas_ratio", "pos_horiz_accuracy", "pos_vert_accuracy",
                                             "flags")),
    242: ("HOME_POSITION", 104, "<3i3f", ("latitude", "longitude", "altitude", "x", "y", "z")),
    285: ("GIMBAL_DEVICE_ATTITUDE_STATUS", 137, "<I4f3fIHBBffB",
          ("time_boot_ms", "qw", "qx", "qy", "qz", "angular_velocity_x", "angular_velocity_y", "angular_velocity_z",
           "failure_flags", "flags", "target_system", "target_component", "delta_yaw", "delta_yaw_velocity",
           "gimbal_device_id")),
}


class Message(NamedTuple):
    system: int
    component: int
    name: str
    fields: dict


def _packet_at(data, at):
    """System, component, id, payload, the bytes that the CRC is of, the CRC, and where the packet ends; None for none."""
    if data[at] == START_2 and at + 12 <= len(data):
        length, signed, message = data[at + 1], data[at + 2] & 1, int.from_bytes(data[at + 7:at + 10], "little")
        system, component, begin = data[at + 5], data[at + 6], at + 10
    elif data[at] == START_1 and at + 8 <= len(data):
        length, signed, message = data[at + 1], 0, data[at + 5]
        system, component, begin = data[at + 3], data[at + 4], at + 6
    else:
        return None
    end = begin + length
    if end + 2 > len(data):
        return None
    told = int.from_bytes(data[end:end + 2], "little")
    return system, component, message, data[begin:end], data[at + 1:end], told, end + 2 + 13 * signed


class Stream:
    """What comes on a port. A packet may go on in the next datagram, as of a bridge that passes on a serial line."""

    def __init__(self):
        self._begun = b""

    def messages(self, datagram):
        """Those of MESSAGES that end in it. What is damaged, or something else, is left out."""
        data = self._begun + datagram
        found, at, begun = [], 0, len(data)
        while at < len(data):
            packet = _packet_at(data, at)
            if packet is None:
                begun = min(begun, at) if data[at] in STARTS else begun
                at += 1
                continue
            system, component, number, payload, checked, told, end = packet
            known = MESSAGES.get(number)
            if known is None:
                at = end
                continue
            name, extra, layout, fields = known
            if crc(checked + bytes([extra])) != told:
                at += 1
                continue
            size = struct.calcsize(layout)
            values = struct.unpack(layout, payload[:size].ljust(size, b"\0"))  # zeros at the end are not sent
            found.append(Message(system, component, name, dict(zip(fields, values))))
            at, begun = end, len(data)
        self._begun = data[begun:]
        return found
