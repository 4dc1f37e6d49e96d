"""When a JPEG says that it was taken: DateTimeOriginal and SubSecTimeOriginal of EXIF 2.3."""
import datetime
import struct
from typing import NamedTuple

LARGEST_HEAD = 1 << 17  # bytes: the segment of EXIF takes 64 KiB at most, and stands at the beginning
APP1, SCAN = 0xE1, 0xDA
EXIF_IFD, DATE, FRACTION = 0x8769, 0x9003, 0x9291
SIZES = {2: 1, 4: 4}  # of a character and of an offset, by the numbers of their types


class Taken(NamedTuple):
    """Seconds by the camera's own clock, in whatever zone, cut off after a digit that counts `unit_s`."""
    date_s: float
    unit_s: float


def taken(path):
    """None where it does not say. Throws OSError."""
    with open(path, "rb") as file:
        head = file.read(LARGEST_HEAD)
    try:
        return _taken(_tiff(head))
    except (ValueError, struct.error):
        return None


def _tiff(head):
    at = 2 if head.startswith(b"\xff\xd8") else len(head)
    while at < len(head):
        mark, kind, size = struct.unpack_from(">BBH", head, at)
        if mark != 0xFF or kind == SCAN:
            break
        if kind == APP1 and head[at + 4:at + 10] == b"Exif\0\0":
            return head[at + 10:at + 2 + size]
        at += 2 + size
    raise ValueError("no EXIF")


def _taken(tiff):
    order = {b"II": "<", b"MM": ">"}.get(tiff[:2])
    if order is None:
        raise ValueError("no TIFF")
    first, = struct.unpack_from(order + "I", tiff, 4)
    inner, = struct.unpack(order + "I", _value(tiff, order, first, EXIF_IFD))
    date, fraction = (_value(tiff, order, inner, tag).split(b"\0")[0].decode("ascii", "replace").strip()
                      for tag in (DATE, FRACTION))
    date_s = datetime.datetime.strptime(date + "+0000", "%Y:%m:%d %H:%M:%S%z").timestamp()
    if not (fraction.isascii() and fraction.isdigit()) or int(fraction) == 0:  # some write zeros without measuring
        return Taken(date_s, 1.0)
    return Taken(date_s + float("0." + fraction), 0.1 ** len(fraction))


def _value(tiff, order, directory, tag):
    """The bytes of a text or an offset. Empty where there is none."""
    count, = struct.unpack_from(order + "H", tiff, directory)
    for at in range(directory + 2, directory + 2 + 12 * count, 12):
        found, kind, length = struct.unpack_from(order + "HHI", tiff, at)
        if found == tag:
            size = length * SIZES.get(kind, 0)
            begin = at + 8 if size <= 4 else struct.unpack_from(order + "I", tiff, at + 8)[0]
            return tiff[begin:begin + size]
    return b""
