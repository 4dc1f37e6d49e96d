"""Text for somebody who may have stopped reading, as a terminal after Ctrl-S: a flight does not wait for them.
scripts/ground_station and scripts/mavlink_steps each have a copy of this file, since their folders are used apart."""
import atexit
import os
import queue
import threading

MOST_WAITING = 500  # texts
LEFT_S = 1.0        # for them when the program ends


class Unwaited:
    """Writes to a stream, in a thread of its own; None: one that was closed from the start. `failed` is called there
    with the OSError of a text, which is lost."""

    def __init__(self, stream, failed=lambda error: None):
        self._descriptor = os.open(os.devnull, os.O_WRONLY) if stream is None else stream.fileno()
        self._failed = failed
        self._texts = queue.Queue(MOST_WAITING)
        threading.Thread(target=self._write_all, daemon=True).start()
        atexit.register(self.finish)

    def write(self, text):
        """Whether there is room for it. Else it is lost."""
        try:
            self._texts.put_nowait(text.encode(errors="backslashreplace"))
        except queue.Full:
            return False
        return True

    def finish(self):
        """Whether all was read or lost, within a moment."""
        with self._texts.all_tasks_done:
            return self._texts.all_tasks_done.wait_for(lambda: not self._texts.unfinished_tasks, LEFT_S)

    def _write_all(self):
        while True:
            rest = self._texts.get()
            try:
                while rest:
                    rest = rest[os.write(self._descriptor, rest):]
            except OSError as error:
                self._failed(error)
            self._texts.task_done()
