"""The clock of this computer, which may be set while a vehicle flies."""
import sys
import time

STEP_S = 0.2  # by which a clock does not move between two looks unless it is set


def _read_both():
    """How long it took, and how far the one clock is ahead of the other."""
    before = time.monotonic()
    ahead_s = time.time() - before
    return time.monotonic() - before, ahead_s


def _ahead_s():
    """By the quickest of some readings: a busy computer may let the process wait between the two clocks."""
    return min(_read_both() for _ in range(3))[1]


class WallClock:
    """time.time() seen from time.monotonic(), which nobody sets. `ahead_s`: how far it is ahead. `was_set`: between the
    last two looks."""

    def __init__(self):
        self.ahead_s = self._first_ahead_s = _ahead_s()
        self.was_set = False

    def look(self):
        ahead_s = _ahead_s()
        moved_s = ahead_s - self.ahead_s
        self.ahead_s = ahead_s
        self.was_set = abs(moved_s) > STEP_S
        if self.was_set:
            print(f"the clock was set by {moved_s:+.1f} s", file=sys.stderr)

    def monotonic(self, date_s):
        """Of a date by the clock as it is set now."""
        return date_s - self.ahead_s

    def date_us(self, monotonic_s):
        """By the clock as it was set at first: between the steps of a track passes as much time as did."""
        return round(1e6 * (monotonic_s + self._first_ahead_s))
