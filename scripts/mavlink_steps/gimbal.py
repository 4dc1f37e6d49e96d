"""Which way a gimbal's camera looks, from GIMBAL_DEVICE_ATTITUDE_STATUS."""
import collections
import math
import sys

from boot_clock import BootClock
from camera import in_gimbal
from history import KEPT, Unknown, around, between

STATUS = "GIMBAL_DEVICE_ATTITUDE_STATUS"
YAW_LOCK, YAW_IN_VEHICLE_FRAME, YAW_IN_EARTH_FRAME = 16, 32, 64
HOLE_S = 0.6  # beyond it a gimbal may have turned and come back between two messages


def _is_from_north(flags):
    """Else from the vehicle's heading. Senders that know neither frame mean that of the lock."""
    if flags & (YAW_IN_VEHICLE_FRAME | YAW_IN_EARTH_FRAME):
        return bool(flags & YAW_IN_EARTH_FRAME)
    return bool(flags & YAW_LOCK)


def _heading(fields):
    """The vehicle's, by which a gimbal that tells its yaw from north would turn. None where it does not say."""
    heading = fields["delta_yaw"]
    is_told = fields["flags"] & YAW_IN_EARTH_FRAME and heading != 0.0  # zeros at the end are not sent
    return heading if is_told and math.isfinite(heading) else None


def _yawed(quaternion, yaw):
    """Turned about the axis that points down."""
    c, s = math.cos(0.5 * yaw), math.sin(0.5 * yaw)
    w, x, y, z = quaternion
    return c * w - s * z, c * x - s * y, c * y + s * x, c * z + s * w


class Gimbal:
    """`device`: its id, of those that an autopilot answers for 1 to 6, else that of the component. None: that of the
    first message. Times are those of time.monotonic()."""

    def __init__(self, device=None):
        self._device = device
        self._ignored = set()
        self._clock = BootClock("the gimbal")
        self._from_north = None
        self._attitudes = collections.deque(maxlen=KEPT)  # time, quaternion of as few jumps of the sign as possible

    def hear(self, message, came):
        """A STATUS of the vehicle's system."""
        fields = message.fields
        if not self._is_ours(fields["gimbal_device_id"] or message.component):
            return
        when = self._clock.ours(fields["time_boot_ms"] / 1e3, came)
        quaternion = tuple(fields[name] for name in ("qw", "qx", "qy", "qz"))
        size = math.hypot(*quaternion)
        if when is None or not math.isfinite(size) or size == 0.0:
            return
        from_north, heading = _is_from_north(fields["flags"]), _heading(fields)
        if heading is not None:
            from_north, quaternion = False, _yawed(quaternion, -heading)
        self._add(when, from_north, quaternion)

    def knows(self, when):
        """Whether a message of that time or later has come."""
        return bool(self._attitudes) and self._attitudes[-1][0] >= when

    def camera_at(self, when, heading):
        """Roll, pitch and yaw of its camera in a vehicle of that heading. Throws Unknown."""
        quaternion = between(*around(self._attitudes, when), when, HOLE_S)
        if quaternion is None:
            raise Unknown(f"no two {STATUS} around that time, at most {HOLE_S:g} s apart")
        size = math.hypot(*quaternion)
        return in_gimbal([part / size for part in quaternion], 0.0 if self._from_north else heading)

    def _is_ours(self, device):
        if self._device is None:
            self._device = device
            print(f"listening to gimbal {device}", file=sys.stderr)
        if device != self._device and device not in self._ignored:
            self._ignored.add(device)
            print(f"gimbal {device} is ignored (--gimbal)", file=sys.stderr)
        return device == self._device

    def _add(self, when, from_north, quaternion):
        if from_north != self._from_north:
            self._attitudes.clear()  # nothing lies between yaws from here and from there
            self._from_north = from_north
        if self._attitudes:
            before, *last = self._attitudes[-1]
            if when <= before:
                return
            if sum(a * b for a, b in zip(last, quaternion)) < 0.0:
                quaternion = tuple(-part for part in quaternion)
        self._attitudes.append((when, *quaternion))
