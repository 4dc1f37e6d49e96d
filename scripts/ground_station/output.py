"""Answers as lines of standard output."""
import json
import os
import sys

from unwaited import Unwaited


class ReadOutput:
    """Of which it is an error where nobody reads them or they find no room."""

    def print(self, answer):
        """Throws OSError."""
        try:
            print(json.dumps(answer), flush=True)
        except OSError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # what is in its buffer, too
            raise

    def finish(self):
        """Whether all were printed."""
        return True


class FlightOutput:
    """Of a flight that goes on where nobody reads them or they find no room, which is said."""

    def __init__(self):
        self._to = Unwaited(sys.stdout, self._lose)
        self._is_told = False

    def print(self, answer):
        if not self._to.write(json.dumps(answer) + "\n"):
            self._lose("nobody reads them")

    def finish(self):
        """Whether all were printed."""
        return self._to.finish() and not self._is_told

    def _lose(self, why):
        if not self._is_told:
            self._is_told = True
            print(f"answers are not printed, the flight goes on: {why}", file=sys.stderr)
