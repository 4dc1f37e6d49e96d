"""Whom a message concerns."""
from answers import ACK, Answers
from gimbal import STATUS


class Receiver:
    """`gimbal`: None where nobody listens to one."""

    def __init__(self, autopilot, vehicle, gimbal):
        self._autopilot = autopilot
        self._vehicle = vehicle
        self._gimbal = gimbal
        self._answers = Answers()

    def take(self, message, came):
        """`came`: when, by time.monotonic()."""
        if message.name == STATUS:  # of whatever component
            if self._gimbal is not None and message.system == self._autopilot.system:
                self._gimbal.hear(message, came)
        elif self._autopilot.sent(message):
            if message.name == ACK:
                self._answers.hear(message.fields)
            else:
                self._vehicle.hear(message.name, message.fields, came)
