#!/usr/bin/python3
"""The demo, as far as it can be tried without a map."""
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from functools import partial
from pathlib import Path
from unittest import mock

from fake_service import ROOT, FakeService

sys.path.insert(0, str(ROOT / "scripts"))

from demo_chain import curl  # noqa: E402


class Demo(unittest.TestCase):
    @unittest.skipUnless(shutil.which("curl"), "curl is not installed")
    def test_asks_its_service_and_no_proxy_of_the_environment(self):
        nobody = dict.fromkeys(("http_proxy", "all_proxy"), "http://127.0.0.1:9")
        with FakeService() as fake, mock.patch.dict(os.environ, nobody):
            self.assertEqual(curl("--max-time", "10", fake.url)[0], 200)

    def test_adds_nothing_to_the_map_of_an_earlier_one(self):
        with tempfile.TemporaryDirectory() as folder:
            made = Path(folder, "maps", "demo.gpkg")
            made.parent.mkdir()
            made.write_text("a map")
            demo = subprocess.run([sys.executable, "-B", str(ROOT / "scripts/demo_chain.py"), "--roadfix", "/nowhere",
                                   "--keep", folder], capture_output=True, text=True, timeout=60)
            self.assertEqual((demo.returncode, made.read_text()), (1, "a map"))
            self.assertIn("demo.gpkg is the map of an earlier demo: remove it", demo.stderr)

    def test_says_in_a_line_that_its_folder_cannot_be_made(self):
        with tempfile.NamedTemporaryFile() as file:
            demo = subprocess.run([sys.executable, "-B", str(ROOT / "scripts/demo_chain.py"), "--roadfix", "/nowhere",
                                   "--keep", f"{file.name}/kept"], capture_output=True, text=True, timeout=60)
            self.assertEqual(demo.returncode, 1)
            self.assertRegex(demo.stderr, r"\Ademo: no folder for its files: .*\n\Z")

    def ending_of(self, heard, *endings):
        """Of a demo that never answers and has heard these signals as of a terminal."""
        with tempfile.TemporaryDirectory() as folder:
            endless = Path(folder, "roadfix")
            endless.write_text("#!/bin/sh\nexec sleep 60\n")
            endless.chmod(0o755)
            demo = subprocess.Popen([sys.executable, "-B", str(ROOT / "scripts/demo_chain.py"), "--roadfix", str(endless),
                                     "--once", "--keep", folder], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                    start_new_session=True, preexec_fn=heard)
            self.assertIn("roadfix world", demo.stdout.readline())
            for ending in endings:
                os.killpg(demo.pid, ending)
                time.sleep(0.5)
            _, told = demo.communicate(timeout=60)
            return demo.returncode, told

    def test_has_not_succeeded_where_it_is_stopped_before_its_answers(self):
        # What a shell without job control starts with & ignores it, and so would all that it starts.
        heard = partial(signal.signal, signal.SIGINT, signal.default_int_handler)
        self.assertEqual(self.ending_of(heard, signal.SIGINT), (1, "\ndemo: stopped before its answers\n"))

    def test_ends_with_its_terminal_unless_it_is_told_not_to(self):
        for heard, *endings in ((signal.SIG_DFL, signal.SIGHUP), (signal.SIG_IGN, signal.SIGHUP, signal.SIGTERM)):
            status, _ = self.ending_of(partial(signal.signal, signal.SIGHUP, heard), *endings)
            self.assertEqual(status, 128 + endings[-1])


if __name__ == "__main__":
    unittest.main()
