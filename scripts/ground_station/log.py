"""What a program tells on standard error. scripts/ground_station and scripts/mavlink_steps each have a copy of this
file, since their folders are used apart."""
import datetime
import io

from unwaited import Unwaited


def _now():
    """As the service's log has it."""
    return datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="milliseconds").replace("+00:00", "Z")


class Log(io.TextIOBase):
    """In place of sys.stderr: each line begins with its time. A flight goes on where nothing can be told, as on a full
    disk, or nobody reads it."""

    def __init__(self, stream):
        self._to = Unwaited(stream)
        self._begins_line = True

    def write(self, text):
        for line in text.splitlines(keepends=True):
            self._to.write(f"{_now()} {line}" if self._begins_line else line)
            self._begins_line = line.endswith("\n")
        return len(text)
