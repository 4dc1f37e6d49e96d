#!/usr/bin/python3
"""The demo, as far as it can be tried without a map."""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
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


if __name__ == "__main__":
    unittest.main()
