"""A flight that a track follows, for its tests."""
import unittest

import fake_service  # noqa: F401 (it makes the client importable)
from words import said

from service import Service
from track import Track


class Followed(unittest.TestCase):
    def setUp(self):
        words = said()
        self.words = words.__enter__()
        self.addCleanup(words.__exit__, None, None, None)

    def fly(self, fake, count, patience_s=10.0, request=None, **options):
        service = Service(fake.url, patience_s)
        self.addCleanup(service.close)
        track = Track(service, request or {"map": "m", "lat": 1, "lon": 2, "radius_m": 3}, **options)
        return track, [track.step((10.0 * i, 0.0, 0.0), {"time_us": i + 1}) for i in range(count)]
