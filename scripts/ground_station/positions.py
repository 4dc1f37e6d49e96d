"""Positions to an autopilot by UDP, unless they are too old."""
import math
import socket
import sys
import time

from packet_age import TIMES, is_whole, told_age_s, with_age

#: These say nothing of their age: a late position would move a flying vehicle back to where it was.
FORMATS_WITHOUT_AGE = ("gps_input", "mavproxy", "nmea")
FORMATS_OF_GPS_INPUT = ("gps_input", "mavproxy")
#: Fields of a step without which ArduPilot does not fly on GPS_INPUT, and why.
WANTED_BY_ARDUPILOT = {
    "alt_m": "(height above the sea): its position is a 2D fix, which ArduPilot does not use for flight",
    "satellites": "(--frame satellites=10): its position counts 0, and ArduPilot begins to use none with fewer than 6",
}
#: These say how old they are: as the service sends them, how long it took.
FORMATS_WITH_AGE = tuple(TIMES)
#: ArduPilot sets its position by a command_int, moved on by its velocity, and takes those of more than 5 s ago for 5 s
#: old. The rest is for the way to it. PX4 drops what is older than EKF2_DELAY_MAX, which is 1 s at most.
LONGEST_S = {"command_int": 4.5, "global_position_sensor": 1.0}


class Sender:
    """`max_age_s`: how much older than it says a position may be."""

    def __init__(self, packet_format, address, max_age_s):
        family, kind, protocol, _, self._address = socket.getaddrinfo(*address, type=socket.SOCK_DGRAM)[0]
        self._socket = socket.socket(family, kind, protocol)
        self._format = packet_format
        self._max_age_s = max_age_s
        self._missed = set()

    def expect(self, fields):
        """Of a step, whose position is to be sent. Says once of each missing field that it will be of no use."""
        if self._format not in FORMATS_OF_GPS_INPUT:
            return
        for name, why in WANTED_BY_ARDUPILOT.items():
            if name not in fields and name not in self._missed:
                self._missed.add(name)
                print(f"a step says no {name} {why}", file=sys.stderr)

    def send(self, captured, packet):
        """`captured`: when, by time.monotonic()."""
        if self._format in FORMATS_WITH_AGE and not is_whole(packet):
            print("a position is not sent: its message is damaged or cut off", file=sys.stderr)
            return
        told_s = told_age_s(self._format, packet) if self._format in FORMATS_WITH_AGE else 0.0
        age_s = max(time.monotonic() - captured, told_s)
        why = None
        if not age_s - told_s <= self._max_age_s:  # not even where it says no number
            why = f"{age_s - told_s:.3g} s old" + (f"er than the {told_s:.3g} s that it says" if told_s else "")
            why += f", more than --max-age {self._max_age_s:g}"
        elif age_s > LONGEST_S.get(self._format, math.inf):
            why = f"{age_s:.3g} s old, more than the {LONGEST_S[self._format]:g} s that its receiver believes"
        if why:
            print(f"a position is not sent: it is {why}", file=sys.stderr)
            return
        if self._format in FORMATS_WITH_AGE:
            packet = with_age(self._format, packet, age_s)
        try:
            self._socket.sendto(packet, self._address)
        except OSError as error:  # the step is taken all the same
            print(f"a position is not sent: {error}", file=sys.stderr)
