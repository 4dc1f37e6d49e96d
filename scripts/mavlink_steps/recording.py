"""The flight of a vehicle that has GPS, as a table of its pictures for `roadfix bench` and `roadfix fly --over`."""
import collections
import math
import os
import pathlib
import sys
import time

from camera import FLATTEST, lean
from gps import FIX_KEPT_S
from history import Unknown
from table import fits_a_cell

WAIT_S = FIX_KEPT_S  # for what GPS tells of the time after a picture


def _height(options):
    """Of a step, as the table has it."""
    return "alt_m" if options.by_terrain else "agl_m"


def columns(options):
    return ("file", "sequence", "time_s", "lat", "lon", "heading_deg", "roll_deg", "pitch_deg", _height(options),
            *options.frame)


class Recording:
    """In a Table of these columns."""

    def __init__(self, table, vehicle, options):
        self._table = table
        self._vehicle = vehicle
        self._options = options
        self._folder = os.path.realpath(os.path.dirname(table.path))
        self._sequence = pathlib.Path(table.path).stem
        self._waiting = collections.deque()  # time.monotonic(), step, heading
        self._lacks = None   # of the last picture
        self._files = set()  # that rows name

    def add(self, captured, step, heading_deg):
        """`heading_deg`: of the picture's upper edge, which a step has only where movements are known."""
        self._waiting.append((captured, step, heading_deg))

    def write_due(self):
        while self._waiting and time.monotonic() > self._waiting[0][0] + WAIT_S:
            captured, step, heading_deg = self._waiting.popleft()
            try:
                self._table.append(self._row(captured, step, heading_deg))
            except (Unknown, OSError) as why:
                self._say(step["image"], str(why))
            else:
                self._say(step["image"], None)

    def _row(self, captured, step, heading_deg):
        """Throws Unknown."""
        file = os.path.relpath(os.path.realpath(step["image"]), self._folder)
        if not fits_a_cell(file):
            raise Unknown("no table can hold the commas, quotes, line breaks or outer blanks of its name")
        if lean(math.radians(step["roll_deg"]), math.radians(step["pitch_deg"])) > FLATTEST:
            raise Unknown("its camera looked at the horizon or the sky")
        if file in self._files:
            raise Unknown("its name is that of a picture that is in the table and was written over: remove that row, "
                          "and give each picture a name of its own")
        lat, lon = self._vehicle.gps_place_at(captured)
        self._files.add(file)
        return (file, self._sequence, f"{1e-6 * step['time_us']:.6f}", f"{lat:.8f}", f"{lon:.8f}", str(heading_deg),
                str(step["roll_deg"]), str(step["pitch_deg"]), str(step[_height(self._options)]),
                *self._options.frame.values())

    def _say(self, picture, lacks):
        """Where it is not as before."""
        if lacks != self._lacks:
            print(f"{picture}: " + (f"not in {self._table.path}, nor are those after it: {lacks}" if lacks else
                                    f"in {self._table.path} again, as are those after it"), file=sys.stderr)
        self._lacks = lacks
