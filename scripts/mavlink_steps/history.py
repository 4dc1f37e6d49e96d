"""What was told over time: entries of a time, in its order, and values."""

KEPT = 3000  # some minutes of telemetry


class Unknown(Exception):
    """What was not told of a time."""


def around(history, when):
    """The last entry before a time, or of it, and the first one after it. None where there is none."""
    at = next((i for i in range(len(history) - 1, -1, -1) if history[i][0] <= when), -1)
    return history[at] if at >= 0 else None, history[at + 1] if at + 1 < len(history) else None


def between(before, after, when, longest_s):
    """Values at a time on the straight line between two entries. None where they lie farther apart than that."""
    if before is None or (before[0] < when and (after is None or after[0] - before[0] > longest_s)):
        return None
    if before[0] == when:
        return before[1:]
    (t0, *values), (t1, *then) = before, after
    return tuple(a + (when - t0) / (t1 - t0) * (b - a) for a, b in zip(values, then))
