"""The clock of this computer, which may be set while a vehicle flies."""
import sys
import time

STEP_S = 0.2  # by which a clock does not move between two looks unless it is set


class WallClock:
    """time.time() seen from time.monotonic(), which nobody sets. `ahead_s`: how far it is ahead."""

    def __init__(self):
        self.ahead_s = time.time() - time.monotonic()
        self._told_ahead_s = self.ahead_s

    def look(self):
        ahead_s = time.time() - time.monotonic()
        moved_s = ahead_s - self.ahead_s
        self.ahead_s = ahead_s
        if abs(moved_s) <= STEP_S:
            self._told_ahead_s += moved_s
        else:
            print(f"the clock was set by {moved_s:+.1f} s", file=sys.stderr)
            self._told_ahead_s = max(self._told_ahead_s, ahead_s)

    def monotonic(self, date_s):
        """Of a date by the clock as it is set now."""
        return date_s - self.ahead_s

    def date_us(self, monotonic_s):
        """By the clock, which here goes on as before where it was set back: steps of a track have increasing times."""
        return round(1e6 * (monotonic_s + self._told_ahead_s))
