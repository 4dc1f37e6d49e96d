"""Steps as lines of JSON."""
import json
import pathlib
import sys
import threading
import time
from typing import NamedTuple, Optional

from silence import FORGOTTEN_S

PLACE = ("north_m", "east_m", "yaw_deg")
LENS_FIELDS = ("fov_deg", "focal_px")
CAMERA_FIELDS = (*LENS_FIELDS, "gsd_m", "exif")
PICTURE_FIELDS = CAMERA_FIELDS + ("kind", "cell_m", "unobserved", "agl_m", "takeoff_alt_m", "roll_deg", "pitch_deg",
                                  "attitude_sigma_deg", "principal_px", "lens", "distortion", "nadir_col", "nadir_row",
                                  "nadir_sigma_m", "nadir_heading_sigma_deg")
POSITION_FIELDS = ("covariance", "alt_m", "camera_yaw_deg", "satellites", "system", "sensor", "component")


class Line(NamedTuple):
    """A line and when it came, by time.monotonic() and by the date. `step` is what it says, None where it is no JSON
    object; `passed` are those since the last one that are not sent."""
    number: int
    came: float
    came_us: int
    step: Optional[dict]
    passed: tuple = ()

    @property
    def name(self):
        """With that of its picture: nobody keeps the lines of a flight that is under way."""
        return f"line {self.number}" + (f" ({self.step['image']})" if self.has_picture else "")

    @property
    def has_picture(self):
        return self.step is not None and self.step.get("image") is not None


def _line(number, text):
    try:
        step = json.loads(text)
    except (ValueError, RecursionError):
        step = None
    return Line(number, time.monotonic(), time.time_ns() // 1000, step if isinstance(step, dict) else None)


def all_lines(texts):
    """Of a recording."""
    for number, text in enumerate(texts, 1):
        if text.strip():
            yield _line(number, text)


class NewestLine:
    """Of a flight under way: of the lines that came since the last only the newest. A late frame is of no use, and
    since movements are taken from places nothing is lost with it. A step without a picture displaces none with one."""

    def __init__(self, texts):
        self._changed = threading.Condition()
        self._lines = []      # since the last
        self._newest = None   # of them
        self._end = None      # of the input: StopIteration, or why it cannot be read on
        threading.Thread(target=self._read, args=(texts,), daemon=True).start()

    def __iter__(self):
        return self

    def __next__(self):
        with self._changed:
            while not self._changed.wait_for(lambda: self._newest is not None or self._end, timeout=1.0):
                pass  # without a limit Ctrl-C would not be heard everywhere
            if self._newest is None:
                if not self._lines:
                    raise self._end
                self._newest = len(self._lines) - 1  # those behind the last picture: the flight ends with them
            *passed, line = self._lines[:self._newest + 1]
            del self._lines[:self._newest + 1]
            self._newest = None
        return line._replace(passed=tuple(passed))

    def _read(self, texts):
        end = StopIteration()
        try:
            for line in all_lines(texts):
                with self._changed:
                    self._lines.append(line)
                    if self._newest is None or line.has_picture or not self._lines[self._newest].has_picture:
                        self._newest = len(self._lines) - 1
                    self._changed.notify()
        except Exception as failure:
            end = failure
        with self._changed:
            self._end = end
            self._changed.notify()


class Step(NamedTuple):
    """`place` None: it is not known."""
    place: Optional[tuple]
    origin: Optional[str]
    fields: dict
    image: Optional[bytes]


def is_number(value):
    """A finite one: the place of a step with another would make all movements after it unknown."""
    return isinstance(value, (int, float)) and abs(value) <= sys.float_info.max


def _place(step):
    """None of a picture whose place is not known. Throws ValueError."""
    if step.get("image") is not None and not any(name in step for name in PLACE):
        return None
    try:
        place = tuple(step[name] for name in PLACE)
    except KeyError as missing:
        raise ValueError(f"a step needs {missing.args[0]}") from None
    if not all(map(is_number, place)):
        raise ValueError("north_m, east_m and yaw_deg are numbers")
    return place


def place_and_covariance(line, frame_fields):
    """Of a line that is not sent, each None where it does not tell."""
    if line.step is None:
        return None, None
    try:
        return _place(line.step), {**frame_fields, **line.step}.get("covariance")
    except ValueError:
        return None, None


def with_kind(fields):
    """Those of a picture: one of a camera, where they tell of it."""
    is_frame = "kind" not in fields and any(name in fields for name in CAMERA_FIELDS)
    return {**fields, "kind": "frame"} if is_frame else fields


def read_step(line, folder, frame_fields):
    """What a line says. `frame_fields` are the same of all steps, those of pictures of all pictures. Throws ValueError,
    OSError."""
    if line.step is None:
        raise ValueError("a step is a JSON object, in one line")
    place = _place(line.step)
    step = {name: value for name, value in line.step.items() if name not in PLACE}
    origin = step.pop("origin", None)
    file = step.pop("image", None)
    monotonic_s = step.pop("monotonic_s", 0.0)
    fields = {"time_us": line.came_us, **frame_fields, **step}
    for name, value in (("time_us", fields["time_us"]), ("monotonic_s", monotonic_s)):
        if not is_number(value):
            raise ValueError(f"{name} is a number")
    if file is None:
        fields = {name: value for name, value in fields.items() if name not in PICTURE_FIELDS}
        return Step(place, origin, fields, None)
    if not isinstance(file, str):
        raise ValueError("image is the name of a file")
    return Step(place, origin, with_kind(fields), pathlib.Path(folder, file).read_bytes())


def captured(line, fields):
    """When, by time.monotonic(), of a line and the fields of its step. By monotonic_s, which no set clock shifts; else
    by time_us where it is of this computer's clock, which that of a recording is not; else when the line came."""
    now = time.monotonic()
    monotonic_s = line.step.get("monotonic_s", -1.0)
    if 0.0 <= monotonic_s <= now:  # from the start of the computer on
        return min(line.came, monotonic_s)
    ago_s = time.time() - 1e-6 * fields["time_us"]
    return min(line.came, now - ago_s) if 0.0 <= ago_s < FORGOTTEN_S else line.came
