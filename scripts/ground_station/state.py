"""The file that keeps a track for a client that is started again."""
import json
import math
import os
import pathlib
import sys
import time

#: What was known longer ago is of another flight.
FORGOTTEN_S = 600.0


def _refused(constant):
    raise ValueError(f"{constant} is no place")


class StateFile:
    """`path` None: nothing is kept."""

    def __init__(self, path, map_name):
        self._path = pathlib.Path(path) if path else None
        self._map = map_name
        self._fails = False

    def read(self):
        """Of the flight under way, {} if there is none. Throws ValueError where the file is of something else."""
        if not self._path or not self._path.exists():
            return {}
        try:
            state = json.loads(self._path.read_text(encoding="utf-8"), parse_constant=_refused)
        except (ValueError, RecursionError):
            state = None
        if not isinstance(state, dict) or state.get("map", self._map) != self._map:
            raise ValueError(f"{self._path} is not of a track over the map '{self._map}': remove it, or name another "
                             "file")
        return state if 0.0 <= time.time() - state.get("taken_s", -math.inf) < FORGOTTEN_S else {}

    def write(self, state):
        """Throws OSError."""
        if self._path:
            written = self._path.with_name(self._path.name + ".part")
            written.write_text(json.dumps(state), encoding="utf-8")
            os.replace(written, self._path)

    def keep(self, state):
        """In flight: where it cannot be written, the flight goes on without it."""
        try:
            self.write(state)
            self._fails = False
        except OSError as error:
            if not self._fails:
                print(f"{self._path} is not kept up to date: {error}", file=sys.stderr)
            self._fails = True
