"""Pictures that appear in a folder."""
import os
import pathlib
import time

ENDINGS = {".jpg": b"\xff\xd9", ".jpeg": b"\xff\xd9", ".png": b"IEND\xaeB`\x82"}
QUIET_S = 1.0  # a file that ends otherwise, as some cameras' do, is taken once nothing was written for so long


class NewPictures:
    """Those that are written after this was made. `clock`: a WallClock, by which files have their dates."""

    def __init__(self, folder, clock):
        self._folder = pathlib.Path(folder)
        self._clock = clock
        self._written = {}  # of those that are not complete: date of the file, and time.monotonic() of that
        self._known = set(os.listdir(folder))

    def __call__(self):
        """Path and time.monotonic() of each that is complete since the last call, the oldest first."""
        complete = []
        for path in self._candidates():
            try:
                written = self._last_written(path)
                if self._is_whole(path) or time.monotonic() - written > QUIET_S:
                    complete.append((written, path))
            except OSError:  # renamed or removed meanwhile
                continue
        for _, path in complete:
            self._known.add(path.name)
            del self._written[path.name]
        return [(path, written) for written, path in sorted(complete)]

    def _last_written(self, path):
        """By the clock as it was set when the file was first seen with its date."""
        date_s = path.stat().st_mtime
        seen = self._written.get(path.name)
        if seen is None or seen[0] != date_s:
            seen = self._written[path.name] = (date_s, self._clock.monotonic(date_s))
        return seen[1]

    def _candidates(self):
        """Those that were not taken yet. A camera leaves tens of thousands: only for names that are new more is done
        than to look whether they are."""
        paths = [self._folder / name for name in set(os.listdir(self._folder)) - self._known]
        self._known.update(path.name for path in paths if path.suffix.lower() not in ENDINGS)
        return [path for path in paths if path.suffix.lower() in ENDINGS]

    @staticmethod
    def _is_whole(path):
        ending = ENDINGS[path.suffix.lower()]
        with open(path, "rb") as file:
            file.seek(0, 2)
            if file.tell() < len(ending):
                return False
            file.seek(-len(ending), 2)
            return file.read() == ending
