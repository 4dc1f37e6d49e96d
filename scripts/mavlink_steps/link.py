"""Whether the link to the autopilot brings anything."""
import sys
import time

MISSED_S = 10.0  # without a message


class LinkSilence:
    """Says where nothing of the autopilot comes on a UDP port."""

    def __init__(self, port):
        self._port = port
        self._began = time.monotonic()
        self._told = set()  # of this silence

    def look(self, came, heard):
        """When anything came, and when the autopilot was heard, by time.monotonic(); -inf where that never was."""
        now = time.monotonic()
        if now - max(heard, self._began) > MISSED_S:
            self._say_once(self._nothing_of_it() if now - came <= MISSED_S else self._nothing())
        elif self._told:
            self._told.clear()
            print("the autopilot is heard from here", file=sys.stderr)

    def _nothing(self):
        return (f"nothing has come on UDP port {self._port} for {MISSED_S:g} s: does the autopilot send there, as by "
                f"MAVProxy's --out=udp:ADDRESS:{self._port}?")

    def _nothing_of_it(self):
        return (f"nothing of the autopilot has come for {MISSED_S:g} s, but something else on UDP port {self._port}: "
                "does it send ATTITUDE, and are --system and --component its ids?")

    def _say_once(self, words):
        if words not in self._told:
            self._told.add(words)
            print(words, file=sys.stderr)
