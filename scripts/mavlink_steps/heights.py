"""How high a vehicle is above the ground, and above the sea."""
import collections
import math
import sys

from history import KEPT, around

KEPT_S = 2.5  # of messages that come once a second one may be lost
MSL_M = (-1000.0, 50_000.0)  # what the service takes


class Told:
    """A height as it was told, for as long as it counts."""

    def __init__(self):
        self._told = collections.deque(maxlen=KEPT)  # when it came, height

    def tell(self, height_m, came):
        """NaN: it is not known any more."""
        self._told.append((came, height_m))

    def at(self, when):
        """As it was told nearest to that time. None where it is not known."""
        told = [entry for entry in around(self._told, when) if entry is not None]
        came, height_m = min(told, key=lambda entry: abs(entry[0] - when), default=(-math.inf, math.nan))
        return height_m if abs(when - came) <= KEPT_S and math.isfinite(height_m) else None


class Heights:
    """From what the autopilot told: above the ground, or else above the take-off; and above the sea. Times are those at
    which messages came: a picture may have been taken long before the last."""

    def __init__(self, takeoff_agl_m):
        self._takeoff_agl_m = takeoff_agl_m
        self._above_ground = Told()
        self._above_origin = Told()
        self._takeoff_m = 0.0  # above the origin
        self._above_takeoff = Told()
        self._above_sea = {"ALTITUDE": Told(), "VFR_HUD": Told()}  # the better one first
        self._knew_ground = None
        self._was_by_pressure = False  # the last height above the sea
        self._said = set()  # once

    def tell_above_ground(self, height_m, came):
        """One that is NaN or not above 0 is not known."""
        self._above_ground.tell(height_m if height_m > 0.0 else math.nan, came)

    def tell_above_origin(self, height_m, came):
        """Of the vehicle above the zero of its estimator, which is not where it took off."""
        self._above_origin.tell(height_m, came)

    def tell_takeoff(self, height_m):
        """Of the take-off above that zero, until another is told. It stays as it was where it is not known (NaN), or
        where nobody takes off."""
        if abs(height_m) <= MSL_M[1]:
            self._takeoff_m = height_m

    def tell_above_takeoff(self, height_m, came):
        """For where the estimator has no zero yet."""
        self._above_takeoff.tell(height_m, came)

    def tell_above_sea(self, message, height_m, came):
        """As one of two messages has it. What no vehicle can be at is not known, and as little is 0 to the last digit,
        which an ArduPilot without an origin tells."""
        if height_m == 0.0:
            self._say_once(f"{message} tells a height above the sea of 0 to the last digit, which counts as not known: "
                           "the autopilot has no origin yet (SET_GPS_GLOBAL_ORIGIN)")
        is_known = height_m != 0.0 and MSL_M[0] <= height_m <= MSL_M[1]
        self._above_sea[message].tell(height_m if is_known else math.nan, came)

    def say_of_pressure(self, height_m, by_pressure_m):
        """Of a height above the sea and that of the barometer alone, which PX4 tells for it while it has no origin. One
        alone may be equal by chance."""
        is_by_pressure = height_m == by_pressure_m
        if is_by_pressure and self._was_by_pressure:
            self._say_once("the height above the sea is that of the barometer alone, 8 m off for each hPa by which the "
                           "air pressure is not what the autopilot takes it for (SENS_BARO_QNH): it has no origin yet "
                           "(SET_GPS_GLOBAL_ORIGIN)")
        self._was_by_pressure = is_by_pressure

    def agl_m(self, when):
        """None where nothing is known."""
        above_ground_m = self._above_ground.at(when)
        self._say(above_ground_m is not None)
        if above_ground_m is not None:
            return above_ground_m
        above_origin_m = self._above_origin.at(when)
        above_takeoff_m = self._above_takeoff.at(when) if above_origin_m is None else above_origin_m - self._takeoff_m
        return None if above_takeoff_m is None else above_takeoff_m + self._takeoff_agl_m

    def alt_m(self, when):
        """None where nothing is known."""
        return next((height_m for height_m in (told.at(when) for told in self._above_sea.values())
                     if height_m is not None), None)

    def _say_once(self, words):
        if words not in self._said:
            self._said.add(words)
            print(words, file=sys.stderr)

    def _say(self, knows_ground):
        """Where it is not as before."""
        if self._knew_ground not in (None, knows_ground):
            now = "known now" if knows_ground else "not known any more: that above the take-off is taken"
            print(f"the height above ground is {now}", file=sys.stderr)
        self._knew_ground = knows_ground
