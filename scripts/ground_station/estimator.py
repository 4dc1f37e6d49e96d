"""The vehicle's own estimator, which may stop while its last place is told on."""
import sys


class Estimator:
    """Of places that it tells one after the other."""

    def __init__(self):
        self._last = None
        self._moved = False  # to the last
        self._is_told = False

    def place(self, told):
        """None where it is not known: none was told, or that of before to the last bit though the vehicle had moved,
        which no vehicle in the air does."""
        if told is None:
            return None
        if told != self._last:
            self._moved, self._last = self._last is not None, told
        elif self._moved:
            self._tell()
            return None
        return told

    def _tell(self):
        if not self._is_told:
            self._is_told = True
            print("a place came twice to the last digit: has the vehicle's estimator stopped? Movements to such places "
                  "and from them count as unknown", file=sys.stderr)
