"""Which messages are those of the vehicle's autopilot."""
import sys

EVERY_SYSTEM = 0  # of receivers; no vehicle may have this id


class Autopilot:
    """Gimbals and companion computers of a vehicle send the same messages, of their own attitude and time. `system`
    None: the first one whose `component` is heard."""

    def __init__(self, system, component):
        self.system = system
        self._component = component
        self._ignored = set()

    def sent(self, message):
        """Whether it is one of them."""
        if message.component != self._component:
            self._ignore(message)
            return False
        if self.system is None and message.system != EVERY_SYSTEM:
            self.system = message.system
            print(f"listening to system {self.system}, component {self._component}", file=sys.stderr)
        return message.system == self.system

    def _ignore(self, message):
        if message.name != "ATTITUDE" or self.system not in (None, message.system):
            return
        if message.component not in self._ignored:
            self._ignored.add(message.component)
            print(f"component {message.component} of system {message.system} sends ATTITUDE too and is ignored "
                  "(--component)", file=sys.stderr)
