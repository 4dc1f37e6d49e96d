"""How long ago a step was taken. The date alone does not tell: a clock is set in flight, and one without a battery is
behind after a restart of the computer."""
import pathlib
import time

#: What was known longer ago is of another flight.
FORGOTTEN_S = 600.0
SAME_S = 0.2       # of the sum of silence and what is left of a track's time, asked twice
SAME_DATE_S = 3.0  # HTTP tells whole seconds


def _boot():
    """Another one with each start of the computer. None where it does not tell."""
    try:
        return pathlib.Path("/proc/sys/kernel/random/boot_id").read_text(encoding="ascii").strip()
    except (OSError, ValueError):
        return None


BOOT = _boot()


def _now_s():
    """By a clock that nobody sets and that counts while the computer sleeps, where it has one."""
    return time.clock_gettime(time.CLOCK_BOOTTIME) if hasattr(time, "CLOCK_BOOTTIME") else time.monotonic()


def moment(ago_s=0.0):
    """As a state keeps it, for what comes after a restart of the client or of its computer."""
    return {"taken_s": time.time() - ago_s, "boot": BOOT, "since_boot_s": _now_s() - ago_s}


def since(state):
    """Seconds, of a state that this process has kept."""
    return _now_s() - state["since_boot_s"]


def since_in_this_boot(state):
    """Seconds, of a state that another process has kept. None where the computer was started since."""
    if BOOT is None or state.get("boot") != BOOT or since(state) < 0.0:
        return None
    return since(state)


def was_asked_lately(state):
    """Of a step, in this boot: the service may have been away for longer."""
    since_s = since_in_this_boot(state.get("asked", state))
    return since_s is not None and since_s < FORGOTTEN_S


def time_of_silence(track):
    """For how long the service keeps a silent track, of its answer about one. None where it does not say."""
    return track["silent_s"] + track["expires_in_s"] if "silent_s" in track and "expires_in_s" in track else None


def _is_last(step, track):
    """Whether a step, or the beginning, is the last that the service took."""
    last = track.get("last", {"sequence": 0})
    return all(last.get(name) == step.get(name) for name in ("sequence", "time_us"))


def _was_running(state, track, date_s):
    """The service, since the last step. A restart gives a track all of its time again, while `silent_s` goes by the
    date, or where that is behind does not go with it."""
    kept_s, now_s = state.get("time_of_silence_s"), time_of_silence(track)
    if kept_s is None or now_s is None or date_s is None or "touched_us" not in track:
        return False
    return abs(now_s - kept_s) <= SAME_S and abs(date_s - 1e-6 * track["touched_us"] - track["silent_s"]) <= SAME_DATE_S


def since_by_service(state, track, date_s):
    """Seconds since the last step, by the service's answer about the track, which it gave on `date_s`. None where it
    does not know, or has taken a later step than those of the state."""
    ours = any(_is_last(step, track) for step in (state, state.get("asked", {})))
    return track["silent_s"] if ours and _was_running(state, track, date_s) else None


def is_forgotten_by_date(state, track):
    """A clock that is behind makes the silence shorter; one that is right tells a flight of yesterday."""
    return max(time.time() - state["taken_s"], track.get("silent_s", 0.0)) >= FORGOTTEN_S
