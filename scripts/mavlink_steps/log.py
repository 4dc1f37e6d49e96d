"""What a program tells on standard error. scripts/ground_station and scripts/mavlink_steps each have a copy of this file,
since their folders are used apart."""
import contextlib
import io


class Log(io.TextIOBase):
    """In place of sys.stderr. A flight goes on where nothing can be told, as on a full disk."""

    def __init__(self, stream):
        self._stream = stream

    def write(self, text):
        with contextlib.suppress(OSError):
            self._stream.write(text)
            self._stream.flush()
        return len(text)
