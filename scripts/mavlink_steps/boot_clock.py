"""The clock of a component, which counts from its start."""
import sys

LATE_S = 1.0     # messages of one link overtake each other by less
COUNTED_S = 1.0  # for which another count goes on before it is believed
LATEST_S = 10.0  # the same where a link that is so far behind would look like it


class _Count:
    """That of a start of the component: its time, as it came first and last."""

    def __init__(self, boot_s, came):
        self._first = self._last = (boot_s, came)

    def goes_on(self, boot_s, came):
        """Whether a message continues it: as much time passed there as here."""
        last_boot_s, last_came = self._last
        return boot_s >= last_boot_s - LATE_S and abs((boot_s - last_boot_s) - (came - last_came)) < LATE_S

    def add(self, boot_s, came):
        self._last = (boot_s, came)

    @property
    def lasted_s(self):
        return self._last[1] - self._first[1]


class BootClock:
    """The time since the start of a component as time.monotonic(): messages are late by different amounts, so the least
    late one counts. It may be forgotten by 0.1 ms a second, since clocks drift. `name`: whose clock, for those who are
    told that it was started again."""

    def __init__(self, name="the autopilot"):
        self._name = name
        self._offset = None
        self._last = 0.0
        self._other = None  # a count that may be that of another start

    def ours(self, boot_s, came):
        """None of a message that comes twice or late: by another link, or from before a restart."""
        if self._offset is not None and boot_s < self._last - LATE_S:
            if not self._was_started_again(boot_s, came):
                return None
            print(f"{self._name} was started again", file=sys.stderr)
            self._offset = None
        self._other = None
        if self._offset is None:
            self._offset, self._last = came - boot_s, boot_s
        self._offset = min(came - boot_s, self._offset + 1e-4 * max(0.0, boot_s - self._last))
        self._last = max(self._last, boot_s)
        return boot_s + self._offset

    def _was_started_again(self, boot_s, came):
        """Only if all messages count on from there: between those of a slow link come those of the quick one. A start
        before the last message was sent can only be that of another vehicle, or the quick link was lost."""
        if self._other is None or not self._other.goes_on(boot_s, came):
            self._other = _Count(boot_s, came)
        self._other.add(boot_s, came)
        since_last_message = came - boot_s > self._last + self._offset
        return self._other.lasted_s >= (COUNTED_S if since_last_message else LATEST_S)
