#!/usr/bin/python3
"""The demo, as far as it can be tried without a map."""
import os
import shutil
import signal
import subprocess
import sys
import tempfile
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

    def test_has_not_succeeded_where_it_is_stopped_before_its_answers(self):
        with tempfile.TemporaryDirectory() as folder:
            endless = Path(folder, "roadfix")
            endless.write_text("#!/bin/sh\nexec sleep 60\n")
            endless.chmod(0o755)
            # What a shell without job control starts with & ignores it, and so would all that it starts.
            heard = partial(signal.signal, signal.SIGINT, signal.default_int_handler)
            demo = subprocess.Popen([sys.executable, "-B", str(ROOT / "scripts/demo_chain.py"), "--roadfix", str(endless),
                                     "--once", "--keep", folder], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                    start_new_session=True, preexec_fn=heard)
            self.assertIn("roadfix world", demo.stdout.readline())
            os.killpg(demo.pid, signal.SIGINT)  # as a terminal does
            _, told = demo.communicate(timeout=60)
            self.assertEqual((demo.returncode, told), (1, "\ndemo: stopped before its answers\n"))


if __name__ == "__main__":
    unittest.main()
