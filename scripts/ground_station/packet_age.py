"""How old MAVLink messages say that their position is: the time of sending and that of processing."""
import struct

from crc import crc

HEAD, CHECKSUM = 10, 2  # bytes around the payload of MAVLink 2
CRC_EXTRA = 158         # of both
COMMAND_WRAP_S = 250.0  # the time of sending of command_int starts anew

#: Where the two are in the payload: times of sending and processing, in which unit.
TIMES = {"global_position_sensor": ("<QI", 1e-6), "command_int": ("<ff", 1.0)}


def is_whole(packet):
    """Else nobody knows of what position it is, and with another age it would be a packet like any other."""
    return len(packet) > HEAD + CHECKSUM and len(packet) == HEAD + packet[1] + CHECKSUM and \
        packet.endswith(_checksum(packet[1:-CHECKSUM]))


def told_age_s(packet_format, packet):
    layout, unit_s = TIMES[packet_format]
    return unit_s * struct.unpack_from(layout, _payload(packet, struct.calcsize(layout)))[1]


def with_age(packet_format, packet, age_s):
    """The same position, sent so long after it was taken. The service does not know how long a picture was under way to
    it, nor its answer to here."""
    layout, _ = TIMES[packet_format]
    size = struct.calcsize(layout)
    payload = _payload(packet, size)
    sent, processing = struct.unpack_from(layout, payload)
    if packet_format == "command_int":
        times = (sent - processing + age_s) % COMMAND_WRAP_S, age_s
    else:
        age_us = round(1e6 * age_s)
        times = sent - processing + age_us, age_us
    payload = (struct.pack(layout, *times) + payload[size:]).rstrip(b"\0") or b"\0"
    checked = bytes([len(payload)]) + packet[2:HEAD] + payload
    return packet[:1] + checked + _checksum(checked)


def _checksum(checked):
    return crc(checked + bytes([CRC_EXTRA])).to_bytes(CHECKSUM, "little")


def _payload(packet, least):
    return packet[HEAD:-CHECKSUM].ljust(least, b"\0")  # zeros at the end are not sent
