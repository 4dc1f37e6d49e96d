#!/usr/bin/python3
"""What the program of the client of ground stations looks at before a flight."""
import subprocess
import sys
import unittest

from fake_service import BEFORE, PROGRAM, FakeService


class BeforeTheFlight(unittest.TestCase):
    def checked(self, fake, *options):
        """The exit status, and what was said, of a program that would wait for a first step. It leaves no track."""
        asked = len(fake.requests)
        program = subprocess.run([sys.executable, "-B", str(PROGRAM), "--server", fake.url, "--map", "m", *options],
                                 stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60)
        if "--check" not in options:
            self.assertEqual(len(fake.requests), asked)
        self.assertEqual(len(fake.ended), len(fake.begun()) if fake.never_begun is None else 0)
        return program.returncode, program.stderr

    def test_the_map_is_looked_for(self):
        with FakeService() as fake:
            for check in ([], ["--check"]):
                status, words = self.checked(fake, "--track", "lat=37.7", "lon=38.3", "radius_m=10", *check)
                self.assertEqual(status, 0)
                self.assertRegex(words, f"^{BEFORE}$")
            self.assertEqual(fake.begun(), [{"map": "m", "lat": 37.7, "lon": 38.3, "radius_m": 10}])
            fake.map = (404, {"code": "map-not-found", "detail": "there is town"})
            status, words = self.checked(fake)
            self.assertEqual(status, 1)
            self.assertIn("ground_station: 404 map-not-found: there is town", words)
            fake.map = (200, {"name": "m", "status": "empty", "version": "0", "bbox": None})
            self.assertEqual(self.checked(fake)[0], 1)
            fake.map = (200, {"id": "of something else"})
            self.assertIn("something other than Roadfix answered", self.checked(fake)[1])

    def test_a_place_beside_the_map_is_refused(self):
        with FakeService() as fake:
            for place, km in ((("lat=38.25", "lon=37.75", "radius_m=2000"), "47.7"),
                              (("lat=37.75", "lon=38.32", "radius_m=2000"), None),
                              (("lat=37.75", "lon=38.32", "radius_m=1000"), "0.7"),
                              (("lat=37.75", "lon=-321.75", "radius_m=1"), None),
                              (("bbox=[38.4,37.7,38.5,37.8]",), "5.2"), (("bbox=[38.29,37.7,38.5,37.8]",), None),
                              (("lat=37.75",), None), (("radius_m=5",), None),
                              (("lat=north", "lon=1", "radius_m=5"), None)):
                status, words = self.checked(fake, "--track", *place)
                self.assertEqual(status, 0 if km is None else 1, place)
                if km:
                    self.assertIn(f"the track would begin at least {km} km beside the map, which shows lat 37.7000", words)

    def test_fields_of_frames_that_no_step_has_are_refused(self):
        with FakeService() as fake:
            status, words = self.checked(fake, "--frame", "fov_deg=78", "satelites=10")
            self.assertEqual(status, 1)
            self.assertIn("--frame satelites: no such field of a step", words)
            self.assertEqual(self.checked(fake, "--frame", "fov_deg=78", "satellites=10", "exif=true")[0], 0)

    def test_lines_are_said_to_need_a_height_above_ground_where_the_map_knows_no_heights(self):
        camera = ("--frame", "fov_deg=78")
        for frame, terrain, is_said in ((camera, {}, True), (("--frame", "focal_px=900", "alt_m=1200"), {}, True),
                                        (camera, {"terrain": {"lowest_m": 500.0, "highest_m": 518.0}}, False),
                                        ((*camera, "agl_m=300"), {}, False), (("--frame", "gsd_m=0.5"), {}, False),
                                        (("--frame", "exif=true"), {}, False), ((), {}, False)):
            with FakeService() as fake:
                fake.map = (200, {**fake.map[1], **terrain})
                for check in ((), ("--check",)):
                    status, words = self.checked(fake, *frame, *check)
                    self.assertEqual(status, 0)
                    self.assertEqual("lines of pictures need agl_m, alt_m alone will not do" in words, is_said, frame)

    def test_a_height_of_the_take_off_is_refused_where_the_map_knows_no_heights(self):
        photos = ("--frame", "exif=true", "takeoff_alt_m=655")
        for terrain, expected in (({}, 1), ({"terrain": {"lowest_m": 500.0, "highest_m": 518.0}}, 0)):
            with FakeService() as fake:
                fake.map = (200, {**fake.map[1], **terrain})
                status, words = self.checked(fake, *photos)
                self.assertEqual(status, expected)
                self.assertEqual("does not know how high its ground is" in words, expected == 1)

    def test_what_no_track_can_begin_with_is_told_by_a_check(self):
        for refusal, words in (((400, {"code": "missing-parameter", "detail": "'lon' is missing"}),
                                "ground_station: --track: 400 missing-parameter: 'lon' is missing"),
                               ((422, {"code": "search-area-too-large", "detail": "give a place"}),
                                "ground_station: 422 search-area-too-large: give a place")):
            with FakeService() as fake:
                fake.never_begun = refusal
                status, told = self.checked(fake, "--track", "lat=37.76", "--check")
                self.assertEqual(status, 1)
                self.assertIn(words, told)
                self.assertEqual(self.checked(fake, "--track", "lat=37.76")[0], 0)

    def test_fields_of_frames_with_which_each_step_would_be_refused_are_told_by_a_check(self):
        wrong = (400, {"code": "bad-parameter", "field": "fov_deg", "detail": "'fov_deg' must be a number"})
        for refusal, expected, words in ((wrong, 1, "--frame: 400 bad-parameter: 'fov_deg' must be a number"),
                                         ((422, {"code": "frame-too-coarse"}), 0, None), (200, 0, None)):
            with FakeService([refusal]) as fake:
                fake.map = (200, {**fake.map[1], "terrain": {}})
                status, told = self.checked(fake, "--frame", "fov_deg=seventy", "--check")
                self.assertEqual(status, expected)
                self.assertRegex(told, f"^{BEFORE}" + (rf"\S+Z ground_station: {words}\n$" if words else "$"))
                step, = fake.steps()
                self.assertEqual((step["fov_deg"], step["kind"], step["agl_m"]), ("seventy", "frame", "100.0"))

    def test_what_only_lines_can_tell_of_pictures_is_told_by_a_check_and_no_error(self):
        missing = (400, {"code": "missing-parameter", "field": "fov_deg", "detail": "a frame needs gsd_m"})
        for frame in ([], ["--frame", "roll_deg=0"]):
            with FakeService([missing]) as fake:
                status, words = self.checked(fake, *frame, "--check")
                self.assertEqual(status, 0)
                self.assertIn("so their lines or files have to: a frame needs gsd_m", words)

    def test_a_track_is_removed_also_where_the_service_falls_silent_at_its_step(self):
        with FakeService(["hang up"] * 100) as fake:
            status, words = self.checked(fake, "--patience", "0.5", "--check")
            self.assertEqual(status, 1)
            self.assertIn("ground_station: no answer of 127.0.0.1 within 0.5 s", words)

    def test_what_is_wrong_is_told_by_a_check_also_where_its_track_cannot_be_removed(self):
        wrong = (400, {"code": "bad-parameter", "field": "fov_deg", "detail": "'fov_deg' must be a number"})
        for refusal, expected, words in ((wrong, 1, "ground_station: --frame: 400 bad-parameter"), (200, 0, "version")):
            with FakeService([refusal]) as fake:
                fake.gone = (410, {"code": "track-ended"})
                status, told = self.checked(fake, "--frame", "fov_deg=seventy", "--check")
                self.assertEqual(status, expected)
                self.assertIn(words, told)

    def test_a_service_that_is_away_is_told_and_no_error(self):
        with FakeService() as fake:
            pass
        for check, expected in (([], 0), (["--check"], 1)):
            status, words = self.checked(fake, *check)
            self.assertEqual(status, expected)
            self.assertIn("nothing is checked before the flight: no answer of 127.0.0.1 within 3 s", words)

    def test_a_place_beside_the_map_is_refused_also_where_the_service_then_falls_silent(self):
        with FakeService() as fake:
            fake.readiness = None
            status, words = self.checked(fake, "--track", "lat=38.25", "lon=37.75", "radius_m=2000")
            self.assertEqual(status, 1)
            self.assertIn("the track would begin at least 47.7 km beside the map", words)
            self.assertRegex(self.checked(fake)[1], f"^{BEFORE}.*Z nothing more is checked before the flight: ")

    def test_tracks_that_cannot_be_kept_are_told(self):
        with FakeService() as fake:
            fake.readiness = {"status": "ready", "tracks": "unavailable", "tracks_problem": "the disk is full"}
            for check, expected in (([], 0), (["--check"], 1)):
                status, words = self.checked(fake, *check)
                self.assertEqual(status, expected)
                self.assertIn("no track can be flown now: the disk is full", words)
            self.assertEqual(fake.begun(), [])


if __name__ == "__main__":
    unittest.main()
