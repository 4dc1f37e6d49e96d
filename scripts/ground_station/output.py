"""Answers as lines of standard output."""
import json
import os
import sys


class Output:
    """`must_be_read`: it is an error where nobody reads them or they find no room. Else the flight goes on, which is
    said."""

    def __init__(self, must_be_read):
        self._must_be_read = must_be_read
        self.has_failed = False

    def print(self, answer):
        """Throws OSError."""
        try:
            print(json.dumps(answer), flush=True)
        except OSError as error:
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # what is in its buffer, too
            if self._must_be_read:
                raise
            self.has_failed = True
            print(f"no answers are printed from here, the flight goes on: {error}", file=sys.stderr)
