"""Lines of steps for scripts/ground_station."""
import collections
import json
import math
import sys
import time

from camera import turned
from history import Unknown
from vehicle import LONGEST_HOLE_S

WAIT_S = 0.5  # for what the autopilot tells of the time after a picture


def _degrees(angle):
    """Without the sign of a zero."""
    return round(math.degrees(angle), 3) + 0.0


class Lines:
    """Pictures, and what the autopilot tells of the time at which each was taken. Positions that come of them go to its
    `system`. `gimbal`: None where nobody listens to one. `clock`: a WallClock. `recording`: a Recording, None for
    none."""

    def __init__(self, vehicle, gimbal, autopilot, clock, options, recording=None):
        self._vehicle = vehicle
        self._gimbal = gimbal
        self._autopilot = autopilot
        self._clock = clock
        self._options = options
        self._recording = recording
        self._waiting = collections.deque()  # path, time.monotonic()
        self._origin = None
        self._knows_place = True
        self._last_us = -math.inf

    def add(self, path, captured):
        ahead_s = captured - time.monotonic()
        if ahead_s > WAIT_S:  # it would keep back all that come after it
            print(f"{path} is left out: its time lies {ahead_s:.1f} s ahead: check the camera's clock and --delay",
                  file=sys.stderr)
        else:
            self._waiting.append((path, captured))

    def print_due(self):
        """Those that wait for nothing more."""
        while self._waiting and self._is_due(self._waiting[0][1]):
            path, captured = self._waiting.popleft()
            try:
                step, heading_deg = self._step(path, captured)
            except Unknown as why:
                print(f"{path} is left out: {why}", file=sys.stderr)
                continue
            self._last_us = step["time_us"]
            self._say_what_is_not_known(step)
            print(json.dumps(step), flush=True)
            if self._recording is not None:
                self._recording.add(captured, step, heading_deg)

    def _is_due(self, captured):
        if time.monotonic() > captured + self._options.delay + WAIT_S:
            return True
        return self._vehicle.knows(captured) and (self._gimbal is None or self._gimbal.knows(captured))

    def _camera_at(self, captured, attitude):
        """In a vehicle of that attitude. Throws Unknown."""
        if self._gimbal is not None:
            attitude = self._gimbal.camera_at(captured, attitude[2])
        elif self._options.camera == "level":
            attitude = (0.0, 0.0, attitude[2])
        mount = (self._options.camera_roll, self._options.camera_pitch, self._options.camera_yaw)
        return turned(attitude, tuple(map(math.radians, mount)))

    def _step(self, path, captured):
        """And the heading of the picture's upper edge. Throws Unknown."""
        place, attitude = self._vehicle.seen_at(captured)
        roll, pitch, yaw = self._camera_at(captured, attitude)
        camera_yaw = math.remainder(yaw - attitude[2], math.tau)
        heights = self._heights(captured)
        time_us = self._clock.date_us(captured)
        if time_us <= self._last_us:
            raise Unknown("it was not taken after the one before it")
        step = {"time_us": time_us, "monotonic_s": round(captured, 6),
                "origin": f"{self._options.origin}-{self._vehicle.holes_before(captured)}",
                "roll_deg": _degrees(roll), "pitch_deg": _degrees(pitch), **heights,
                "camera_yaw_deg": _degrees(camera_yaw), "image": str(path),
                "system": self._autopilot.system}
        heading_deg = _degrees(yaw % math.tau)
        if place is not None:
            step.update(north_m=round(place[0], 3), east_m=round(place[1], 3), yaw_deg=heading_deg)
        return step, heading_deg

    def _heights(self, captured):
        """Throws Unknown."""
        alt_m = self._vehicle.alt_m(captured)
        above_sea = {} if alt_m is None else {"alt_m": round(alt_m, 2)}
        if self._options.by_terrain:
            if alt_m is None:
                raise Unknown("no height above the sea (ALTITUDE or VFR_HUD): ask the autopilot for one of them "
                              "(SET_MESSAGE_INTERVAL)")
            return above_sea
        agl_m = round(self._options.agl if self._options.agl is not None else self._vehicle.agl_m(captured), 2)
        if agl_m <= 0.0:
            raise Unknown(f"it was taken {agl_m:.1f} m above ground")
        return {"agl_m": agl_m, **above_sea}

    def _say_what_is_not_known(self, step):
        """Where it is not as before."""
        knew_place, self._knows_place = self._knows_place, "north_m" in step
        last_origin, self._origin = self._origin, step["origin"]
        if self._knows_place != knew_place:
            print(f"{step['image']}: " + ("movements are known again from here" if self._knows_place else
                                          f"no {self._vehicle.velocities} of that time: its movement is not known"),
                  file=sys.stderr)
        elif last_origin not in (None, self._origin):
            print(f"{step['image']}: no velocity for more than {LONGEST_HOLE_S:g} s before it: the movement is not "
                  "known", file=sys.stderr)
