"""Where a vehicle was, which way it looked and how high it was, from what its autopilot tells."""
import collections
import math

from airspeed import true_airspeed
from boot_clock import BootClock
from gps import Gps
from heights import Heights
from history import KEPT, Unknown, around, between

LONGEST_HOLE_S = 2.0   # beyond it the movement between two velocities is a guess
CARRIED_ON_S = 1.0     # by the last velocity
FASTEST_M_S = 1000.0   # what the service takes; with one such velocity the sum would never be right again
STATUS = ("ESTIMATOR_STATUS", "EKF_STATUS_REPORT")  # of the estimator of PX4, and of ArduPilot
VELOCITY_HORIZ = 2     # of their flags
ATTITUDE_HOLE_S = 0.6  # beyond it a vehicle may have banked and come back between two attitudes


def _finite(*values):
    return all(map(math.isfinite, values))


class Vehicle:
    """`by_air`: movements from airspeed and heading, as a track with wind_sigma_m_s takes them, instead of from the
    estimator's velocity over ground. Positions are no movements: they jump where the autopilot is told better ones. All
    times are those of time.monotonic()."""

    def __init__(self, by_air=False, takeoff_agl_m=0.0):
        self._by_air = by_air
        self._heights = Heights(takeoff_agl_m)
        self._gps = Gps()
        self._clock = BootClock()
        self._places = collections.deque(maxlen=KEPT)     # time, north, east, velocity to the north and to the east
        self._attitudes = collections.deque(maxlen=KEPT)  # time, roll, pitch, yaw that goes on beyond 360 degrees
        self._holes = []  # when each ended
        self._knows_velocity = True  # the estimator, as it says: some tell one near 0 while nothing aids it
        self.heard = -math.inf

    def hear(self, name, fields, came):
        self.heard = came
        if "time_boot_ms" in fields:
            when = self._clock.ours(fields["time_boot_ms"] / 1e3, came)
            if when is not None:
                self._hear_at(when, name, fields, came)
        elif name == "GPS_RAW_INT":
            self._gps.tell_fix(fields["fix_type"], 1e-7 * fields["lat"], 1e-7 * fields["lon"], came)
        elif name in STATUS:
            self._knows_velocity = bool(fields["flags"] & VELOCITY_HORIZ)
        elif name == "HOME_POSITION":
            self._heights.tell_takeoff(-fields["z"])
        elif name == "VFR_HUD":
            self._heights.tell_above_sea(name, fields["alt"], came)
            if self._by_air:
                self._move_by_air(fields["airspeed"], came)
        elif name == "TERRAIN_REPORT":
            self._hear_of_terrain(fields["current_height"], fields["spacing"] > 0, came)
        elif name == "ALTITUDE":
            self._heights.tell_above_ground(fields["bottom_clearance"], came)
            self._heights.tell_above_sea(name, fields["altitude_amsl"], came)
            self._heights.say_of_pressure(fields["altitude_amsl"], fields["altitude_monotonic"])

    def _hear_at(self, when, name, fields, came):
        if name == "ATTITUDE":
            self._turn((fields["roll"], fields["pitch"], fields["yaw"]), when)
        elif name == "LOCAL_POSITION_NED":
            if math.isfinite(fields["z"]):
                self._heights.tell_above_origin(-fields["z"], came)
            if not self._by_air and self._knows_velocity:
                self._move((fields["vx"], fields["vy"]), when)
        elif name == "GLOBAL_POSITION_INT":
            self._heights.tell_above_takeoff(1e-3 * fields["relative_alt"], came)
            self._gps.tell_place(1e-7 * fields["lat"], 1e-7 * fields["lon"], when)

    def seen_at(self, when):
        """North and east in metres from anywhere, None where they are not known, and roll, pitch and yaw in radians.
        Throws Unknown."""
        attitude = between(*around(self._attitudes, when), when, ATTITUDE_HOLE_S)
        if attitude is None:
            if self.heard == -math.inf:
                raise Unknown("the autopilot was not heard yet")
            raise Unknown(f"no two ATTITUDE around that time, at most {ATTITUDE_HOLE_S:g} s apart")
        return self._place_at(when), attitude

    def gps_place_at(self, when):
        """Latitude and longitude in degrees, while it had GPS. Throws Unknown."""
        return self._gps.place_at(when)

    @property
    def velocities(self):
        """What tells them."""
        if self._by_air:
            return "VFR_HUD with a height above the sea"
        return "LOCAL_POSITION_NED" + ("" if self._knows_velocity else f" that counts by {' or '.join(STATUS)}")

    def holes_before(self, when):
        """How many there were in the velocities: the movement between a place before one and a place after it is not
        known."""
        return sum(ended <= when for ended in self._holes)

    def agl_m(self, when):
        """Throws Unknown."""
        height_m = self._heights.agl_m(when)
        if height_m is None:
            raise Unknown("no height (ALTITUDE, TERRAIN_REPORT, LOCAL_POSITION_NED or GLOBAL_POSITION_INT): give --agl, "
                          "or ask the autopilot for one of them (SET_MESSAGE_INTERVAL)")
        return height_m

    def alt_m(self, when):
        """Above mean sea level. None where it is not known."""
        return self._heights.alt_m(when)

    def knows(self, when):
        """Whether messages of that time and later ones have come. Velocities that have ended are not waited for."""
        last_place = self._places[-1][0] if self._places else -math.inf
        return bool(self._attitudes) and self._attitudes[-1][0] >= when and (
            last_place >= when or last_place < when - CARRIED_ON_S)

    def _place_at(self, when):
        """None where it is not known."""
        before, after = around(self._places, when)
        place = between(before, after, when, LONGEST_HOLE_S)
        if place is not None:
            return place[:2]
        if before is None or when - before[0] > CARRIED_ON_S:
            return None
        last, north, east, north_m_s, east_m_s = before
        return north + (when - last) * north_m_s, east + (when - last) * east_m_s

    def _hear_of_terrain(self, height_m, is_known, came):
        # Without any height it is the answer to a question about a place of which nothing is known. Those about other
        # places cannot be told from the vehicle's own.
        if is_known or height_m != 0.0:
            self._heights.tell_above_ground(height_m if is_known else math.nan, came)

    def _turn(self, attitude, when):
        if not _finite(*attitude):
            return
        roll, pitch, yaw = attitude
        if self._attitudes:
            if when <= self._attitudes[-1][0]:
                return
            last = self._attitudes[-1][3]
            yaw = last + math.remainder(yaw - last, math.tau)
        self._attitudes.append((when, roll, pitch, yaw))

    def _move_by_air(self, airspeed, came):
        speed = true_airspeed(airspeed, self._heights.alt_m(came))
        if speed is not None and self._attitudes and came - self._attitudes[-1][0] <= 0.5 * ATTITUDE_HOLE_S:
            yaw = self._attitudes[-1][3]
            self._move((speed * math.cos(yaw), speed * math.sin(yaw)), came)

    def _move(self, velocity, when):
        if not math.hypot(*velocity) <= FASTEST_M_S or (self._places and when <= self._places[-1][0]):  # nor is NaN
            return
        last, north, east, *before = self._places[-1] if self._places else (when, 0.0, 0.0, 0.0, 0.0)
        if when - last > LONGEST_HOLE_S:
            self._holes.append(when)
        else:
            half_s = 0.5 * (when - last)
            north += half_s * (before[0] + velocity[0])
            east += half_s * (before[1] + velocity[1])
        self._places.append((when, north, east, *velocity))
