#!/usr/bin/python3
"""A link to the autopilot that brings nothing, or nothing of use."""
import math
import sys
import unittest
from pathlib import Path

from fake_time import FakeTime
from words import said

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts" / "mavlink_steps"))

from link import LinkSilence  # noqa: E402
from vehicle import Unknown, Vehicle  # noqa: E402

NOTHING = "nothing has come on UDP port 14551 for 10 s: does the autopilot send there"
OTHERS = "nothing of the autopilot has come for 10 s, but something else on UDP port 14551"
AGAIN = "the autopilot is heard from here"


class Links(unittest.TestCase):
    def check(self, looks):
        """Each: seconds since the last, whether something comes then, whether it is of the autopilot, what is said."""
        came = heard = -math.inf
        with FakeTime() as fake:
            silence = LinkSilence(14551)
            for pause_s, comes, is_autopilot, expected in looks:
                fake.now += pause_s
                came, heard = fake.now if comes else came, fake.now if is_autopilot else heard
                with said() as words:
                    silence.look(came, heard)
                self.assertEqual(words.getvalue()[:len(expected) or None], expected)

    def test_that_bring_nothing_are_told_of_once_in_each_silence(self):
        self.check([(9.9, False, False, ""), (0.2, False, False, NOTHING), (60.0, False, False, ""),
                    (1.0, True, True, AGAIN), (1.0, True, True, ""), (9.9, False, False, ""),
                    (0.2, False, False, NOTHING), (1.0, True, True, AGAIN)])

    def test_that_bring_nothing_of_the_autopilot_are_told_apart(self):
        self.check([(5.0, True, False, ""), (5.1, True, False, OTHERS), (5.0, True, False, ""),
                    (10.1, False, False, NOTHING), (1.0, True, False, ""), (1.0, True, True, AGAIN)])

    def test_that_brought_nothing_yet_are_why_nothing_is_known_of_a_time(self):
        with self.assertRaisesRegex(Unknown, "^the autopilot was not heard yet$"):
            Vehicle().seen_at(100.0)


if __name__ == "__main__":
    unittest.main()
