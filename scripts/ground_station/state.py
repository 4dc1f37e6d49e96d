"""The file that keeps a track for a client that is started again."""
import json
import os
import pathlib
import sys

HEAD = '{"map"'
MOMENT = ("taken_s", "boot", "since_boot_s")
FLIGHT = ("id", "sequence", "origin", "known", *MOMENT)
ASKED = ("sequence", "time_us", "place", "known", *MOMENT)  # of a step without an answer


def _refused(constant):
    raise ValueError(f"{constant} is no place")


def _is_whole(state):
    """Whether it has all members that a flight has, if there was one."""
    if "id" not in state:
        return True
    asked = state.get("asked", dict.fromkeys(ASKED))
    return all(name in state for name in FLIGHT) and isinstance(asked, dict) and all(name in asked for name in ASKED)


class StateFile:
    """`path` None: nothing is kept."""

    def __init__(self, path, map_name):
        self._path = pathlib.Path(path) if path else None
        self._map = map_name
        self._fails = False

    def __str__(self):
        return str(self._path)

    def read(self):
        """{} where there was no flight, the map alone where the file does not tell any more: the power may have failed
        while it was written. Throws ValueError where the file is of something else."""
        if not self._path or not self._path.exists():
            return {}
        text = self._path.read_text(encoding="utf-8", errors="replace")
        try:
            state = json.loads(text, parse_constant=_refused)
        except json.JSONDecodeError:
            state = {"map": self._map} if HEAD.startswith(text.strip("\0")[:len(HEAD)]) else None
        except (ValueError, RecursionError):
            state = None
        if not isinstance(state, dict) or state.get("map", self._map) != self._map or not _is_whole(state):
            raise ValueError(f"{self._path} is not of a track over the map '{self._map}': remove it, or name another "
                             "file")
        return state

    def write(self, state, synced=True):
        """`synced`: for a power cut, too, which takes the time of the disk. Throws OSError."""
        if not self._path:
            return
        written = self._path.with_name(self._path.name + ".part")
        with open(written, "w", encoding="utf-8") as file:
            file.write(json.dumps(state))
            if synced:
                file.flush()
                os.fsync(file.fileno())
        os.replace(written, self._path)

    def keep(self, state, synced=True):
        """In flight: where it cannot be written, the flight goes on without it."""
        try:
            self.write(state, synced)
            self._fails = False
        except OSError as error:
            if not self._fails:
                print(f"{self._path} is not kept up to date: {error}", file=sys.stderr)
            self._fails = True
