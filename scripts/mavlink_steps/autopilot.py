"""Which messages are those of the vehicle's autopilot."""
import sys

EVERY_SYSTEM = 0  # of receivers; no vehicle may have this id


class Autopilot:
    """Gimbals and companion computers of a vehicle send the same messages, of their own attitude and time. `system`
    None: the first one whose `component` is heard."""

    def __init__(self, system, component):
        self.system = system
        self._component = component
        self._any_system = system is None
        self._ignored = set()

    def sent(self, message):
        """Whether it is one of them."""
        is_autopilot = message.component == self._component
        if is_autopilot and self.system is None and message.system != EVERY_SYSTEM:
            self.system = message.system
            print(f"listening to system {self.system}, component {self._component}", file=sys.stderr)
        if is_autopilot and message.system == self.system:
            return True
        if message.name == "ATTITUDE":
            self._ignore(message.system, message.component)
        return False

    def _ignore(self, system, component):
        """Says so of what may be meant."""
        if component != self._component:
            if self.system in (None, system):
                self._say_once(f"component {component} of system {system}", "--component")
        elif self._any_system and system != EVERY_SYSTEM:
            self._say_once(f"system {system}, another vehicle,", "--system")

    def _say_once(self, sender, option):
        if sender not in self._ignored:
            self._ignored.add(sender)
            print(f"{sender} sends ATTITUDE too and is ignored ({option})", file=sys.stderr)
