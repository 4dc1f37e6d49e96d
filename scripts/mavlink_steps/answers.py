"""What an autopilot answers to positions, which scripts/ground_station sends it without hearing of it."""
import sys

ACK = "COMMAND_ACK"
EXTERNAL_POSITION_ESTIMATE = 43003
ACCEPTED = 0
RESULTS = ("ACCEPTED", "TEMPORARILY_REJECTED", "DENIED", "UNSUPPORTED", "FAILED", "IN_PROGRESS", "CANCELLED")


class Answers:
    """Says where the autopilot begins to take positions and where it takes none any more, or for another reason."""

    def __init__(self):
        self._last = None

    def hear(self, fields):
        """Of any COMMAND_ACK."""
        result = fields["result"]
        if fields["command"] != EXTERNAL_POSITION_ESTIMATE or result == self._last:
            return
        self._last = result
        name = RESULTS[result] if result < len(RESULTS) else result
        print(f"the autopilot {'takes positions' if result == ACCEPTED else 'takes no position'}: it answers {name} to "
              "MAV_CMD_EXTERNAL_POSITION_ESTIMATE", file=sys.stderr)
