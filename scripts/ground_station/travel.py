"""Movements of a vehicle between the places that its own estimator tells, and what is known of their errors."""
import math

from steps import is_number

MOST_JOINED = 1000  # movements; of a service that was away for so long nothing is left of the belief


def movement(before, now):
    """Forward, right (metres, in the body frame of `before`) and turn (degrees, clockwise) between two places
    (north_m, east_m, yaw_deg), as a step has them."""
    north_m, east_m, yaw = now[0] - before[0], now[1] - before[1], math.radians(before[2])
    return {"forward_m": north_m * math.cos(yaw) + east_m * math.sin(yaw),
            "right_m": east_m * math.cos(yaw) - north_m * math.sin(yaw),
            "turn_deg": (now[2] - before[2] + 180.0) % 360.0 - 180.0}


def _product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def _carried(jacobian, covariance):
    return _product(_product(jacobian, covariance), [list(column) for column in zip(*jacobian)])


def joined(first, then):
    """Two movements, one after the other, as one. Each: (forward_m, right_m, turn in rad) and its covariance, 3 x 3;
    their errors have nothing to do with each other."""
    (forward_m, right_m, turn), covariance = first
    (then_forward_m, then_right_m, then_turn), then_covariance = then
    c, s = math.cos(turn), math.sin(turn)
    ahead_m, aside_m = c * then_forward_m - s * then_right_m, s * then_forward_m + c * then_right_m
    # An error of the first turn moves all that comes after it; errors of the second movement are along its own axes.
    of_first = _carried([[1, 0, -aside_m], [0, 1, ahead_m], [0, 0, 1]], covariance)
    of_second = _carried([[c, -s, 0], [s, c, 0], [0, 0, 1]], then_covariance)
    return ((forward_m + ahead_m, right_m + aside_m, turn + then_turn),
            [[a + b for a, b in zip(row, other)] for row, other in zip(of_first, of_second)])


def _matrix(covariance):
    """None for what is no list of nine numbers."""
    if isinstance(covariance, list) and len(covariance) == 9 and all(map(is_number, covariance)):
        return [covariance[0:3], covariance[3:6], covariance[6:9]]
    return None


class Travel:
    """Of the places since the last step that was taken: the covariance of the movement that spans them all. Each comes
    with the covariance of the movement from the place before it."""

    def __init__(self):
        self._places = []
        self._begin = None  # None: where another client, or this one before its restart, left off

    def __len__(self):
        return len(self._places)

    def add(self, place, covariance):
        """None for what is not known."""
        self._places.append((place, covariance))

    def taken(self, count):
        """A step was that moved the vehicle over the first `count` places."""
        if count:
            self._begin = self._places[count - 1][0]
            del self._places[:count]

    def covariance(self):
        """As a step has it, None where it is not known. What was told of one movement is not looked at."""
        if self._begin is None or len(self._places) > MOST_JOINED:
            return None
        if len(self._places) == 1:
            return self._places[0][1]
        whole, before = None, self._begin
        for place, told in self._places:
            covariance = _matrix(told)
            if place is None or covariance is None:
                return None
            moved = movement(before, place)
            part = ((moved["forward_m"], moved["right_m"], math.radians(moved["turn_deg"])), covariance)
            whole = joined(whole, part) if whole else part
            before = place
        return [value for row in whole[1] for value in row] if whole else None
