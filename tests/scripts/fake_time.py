"""Time that passes where a test says so."""
from unittest import mock


class FakeTime:
    """time.monotonic() and the clock, which may be set."""

    def __init__(self):
        self.now, self.ahead_s = 100.0, 1_700_000_000.0

    def __enter__(self):
        self._patches = [mock.patch("time.monotonic", lambda: self.now),
                         mock.patch("time.time", lambda: self.now + self.ahead_s)]
        for patch in self._patches:
            patch.start()
        return self

    def __exit__(self, *_):
        for patch in self._patches:
            patch.stop()
