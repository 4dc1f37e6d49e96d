"""Where a vehicle was while it had GPS."""
import collections
import math

from history import KEPT, Unknown, around, between

FIX_3D = 3
FIX_KEPT_S = 2.5  # of messages that come once a second one may be lost
HOLE_S = 1.2      # beyond it a turn lies metres beside the straight line between two places
APART_M = 50.0    # no receiver lags behind as far
DEGREE_M = 111_320.0


def _distance_m(place, other):
    lat, lon = place
    east = math.remainder(other[1] - lon, 360.0) * math.cos(math.radians(lat))
    return DEGREE_M * math.hypot(other[0] - lat, east)


class Gps:
    """The places are those of the autopilot's estimator, which allows for the time by which its receiver lags behind.
    They count only while the receiver has a fix and is where the estimator is, which else may go on without it. Times
    are those of time.monotonic()."""

    def __init__(self):
        self._places = collections.deque(maxlen=KEPT)  # time, latitude, longitude that goes on beyond 180 degrees
        self._fixes = collections.deque(maxlen=KEPT)   # when it came, of what type, latitude, longitude

    def tell_place(self, lat, lon, when):
        """The estimator's, in degrees."""
        if self._places:
            before, _, last = self._places[-1]
            if when <= before:
                return
            lon = last + math.remainder(lon - last, 360.0)
        self._places.append((when, lat, lon))

    def tell_fix(self, fix_type, lat, lon, came):
        """The receiver's."""
        self._fixes.append((came, fix_type, lat, lon))

    def place_at(self, when):
        """Latitude and longitude. Throws Unknown."""
        place = self._estimated(when)
        if place is None:
            raise Unknown(f"no two GLOBAL_POSITION_INT around that time, at most {HOLE_S:g} s apart")
        for came, fix_type, *received in self._fixes_around(when):
            if fix_type < FIX_3D:
                raise Unknown("the GPS had no 3D fix")
            estimated = self._estimated(came)
            if estimated is not None and _distance_m(estimated, received) > APART_M:
                raise Unknown(f"the autopilot was not within {APART_M:g} m of where its GPS was")
        return place[0], math.remainder(place[1], 360.0)

    def _estimated(self, when):
        """None where it is not known."""
        return between(*around(self._places, when), when, HOLE_S)

    def _fixes_around(self, when):
        """That before, and that after if it has come. Throws Unknown."""
        before, after = around(self._fixes, when)
        if before is None or when - before[0] > FIX_KEPT_S:
            raise Unknown(f"no GPS_RAW_INT in the {FIX_KEPT_S:g} s before it")
        return [before] if after is None or after[0] - when > FIX_KEPT_S else [before, after]
