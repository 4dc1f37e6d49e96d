"""Whether pictures come later and later after they were taken, as where their link brings fewer than are taken. A track
cannot tell that from a vehicle that flies slower than its odometry says."""
import math
import re
import sys

import exif

LATE_S = 0.3            # later than the promptest: the vehicle was elsewhere
FORGOTTEN_SHARE = 1e-4  # of the time that passes: clocks drift
OVERTAKEN_BY = 10       # pictures, of one that comes late or once more: numbers that fall farther begin anew
NUMBERED = re.compile("(.*?)([0-9]+)")


class _Row:
    """Pictures of which the times, or the numbers, are those of one camera."""

    def __init__(self):
        self.highest = -1  # of the numbers
        self._least_s = math.inf  # from the time that a picture tells to its file; holds a difference of the clocks
        self._last = None

    def later_than_the_promptest_s(self, taken, written):
        came_s = written - taken.date_s
        passed_s = 0.0 if self._last is None else max(0.0, written - self._last)
        self._last = written
        self._least_s = min(came_s, self._least_s + FORGOTTEN_SHARE * passed_s)
        return came_s - taken.unit_s - self._least_s


class Lateness:
    """Compares the times that the files tell with the pictures' own: what a camera writes of its clock is enough, in
    whatever zone and however wrong. `every_s`: instead, of pictures that are numbered by the time between them."""

    def __init__(self, every_s=None):
        self._every_s = every_s
        self._rows = {}  # by the name before the number

    def of(self, path, written):
        """Seconds by which it surely came later than the promptest one; below 0 is not surely later, and 0 where it
        does not say when it was taken. `written`: by time.monotonic()."""
        row, taken = self._by_clock(path) if self._every_s is None else self._by_number(path)
        return 0.0 if taken is None else row.later_than_the_promptest_s(taken, written)

    def _by_clock(self, path):
        row = self._rows.setdefault("", _Row())
        try:
            return row, exif.taken(path)
        except OSError:  # removed meanwhile
            return row, None

    def _by_number(self, path):
        found = NUMBERED.fullmatch(path.stem)
        if not found:
            return None, None
        name, number = found[1], int(found[2])
        row = self._rows.setdefault(name, _Row())
        if number < row.highest and (number <= 1 or number < row.highest - OVERTAKEN_BY):
            row = self._rows[name] = _Row()  # the camera or its link began anew
        row.highest = max(row.highest, number)
        return row, exif.Taken(number * self._every_s, 0.0)

    def is_late(self, path, written):
        """Says so."""
        late_s = self.of(path, written)
        if late_s > LATE_S:
            print(f"{path} is left out: it came {late_s:.1f} s later after it was taken than others: the link is too "
                  f"slow, or {'--every is wrong' if self._every_s else 'the camera was given another time'} (then "
                  "start again)", file=sys.stderr)
        return late_s > LATE_S
