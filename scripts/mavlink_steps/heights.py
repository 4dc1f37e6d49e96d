"""How high a vehicle is above the ground."""
import math
import sys

KEPT_S = 2.5  # of messages that come once a second one may be lost


class Heights:
    """From what the autopilot told last: above the ground, or else above the take-off. Times are those at which
    messages came."""

    def __init__(self, takeoff_agl_m):
        self._takeoff_agl_m = takeoff_agl_m
        self._above_ground = (0.0, -math.inf)
        self._above_takeoff = (0.0, -math.inf)
        self._knew_ground = None

    def tell_above_ground(self, height_m, came):
        """One that is NaN or not above 0 is not known."""
        self._above_ground = (height_m, came if 0.0 < height_m < math.inf else -math.inf)

    def tell_above_takeoff(self, height_m, came):
        self._above_takeoff = (height_m, came)

    def agl_m(self, now):
        """None where nothing is known."""
        height_m, came = self._above_ground
        knows_ground = now - came <= KEPT_S
        self._say(knows_ground)
        if knows_ground:
            return height_m
        height_m, came = self._above_takeoff
        return height_m + self._takeoff_agl_m if now - came <= KEPT_S else None

    def _say(self, knows_ground):
        """Where it is not as before."""
        if self._knew_ground not in (None, knows_ground):
            now = "known now" if knows_ground else "not known any more: that above the take-off is taken"
            print(f"the height above ground is {now}", file=sys.stderr)
        self._knew_ground = knows_ground
