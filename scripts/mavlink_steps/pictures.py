"""Pictures that appear in a folder."""
import pathlib
import time

ENDINGS = {".jpg": b"\xff\xd9", ".jpeg": b"\xff\xd9", ".png": b"IEND\xaeB`\x82"}
QUIET_S = 1.0  # a file that ends otherwise, as some cameras' do, is taken once nothing was written for so long


class NewPictures:
    """Those that are written after this was made."""

    def __init__(self, folder):
        self._folder = pathlib.Path(folder)
        self._known = {path.name for path in self._candidates()}

    def __call__(self):
        """Path and time of each that is complete since the last call, the oldest first."""
        complete = []
        for path in self._candidates():
            if path.name in self._known:
                continue
            try:
                written = path.stat().st_mtime
                if self._is_whole(path) or time.time() - written > QUIET_S:
                    complete.append((written, path))
            except OSError:  # renamed or removed meanwhile
                continue
        self._known.update(path.name for _, path in complete)
        return [(path, written) for written, path in sorted(complete)]

    def _candidates(self):
        return [path for path in self._folder.iterdir() if path.suffix.lower() in ENDINGS]

    @staticmethod
    def _is_whole(path):
        ending = ENDINGS[path.suffix.lower()]
        with open(path, "rb") as file:
            file.seek(0, 2)
            if file.tell() < len(ending):
                return False
            file.seek(-len(ending), 2)
            return file.read() == ending
