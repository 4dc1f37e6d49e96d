#!/usr/bin/python3
"""What models/render.py asks of `roadfix world`, with one that renders nothing.

Skips (exit 77) where OpenCV or GDAL is not installed for Python.
"""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

try:
    import cv2  # noqa: F401  (render.py needs them)
    from osgeo import gdal  # noqa: F401
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

PROGRAM = Path(__file__).resolve().parents[2] / "models" / "render.py"


def asked(*arguments):
    with tempfile.TemporaryDirectory() as folder:
        roadfix = Path(folder, "roadfix")
        roadfix.write_text('#!/bin/sh\necho "$@" >&2\nexit 1\n')
        roadfix.chmod(0o755)
        done = subprocess.run([sys.executable, "-B", str(PROGRAM), "--roadfix", str(roadfix), "--out", folder, *arguments],
                              capture_output=True, text=True, timeout=60)
        return done.stderr


class Rendering(unittest.TestCase):
    def test_takes_a_centre_in_any_hemisphere_as_it_is_typed(self):
        for centre in ("-34.9,-56.2", "-0.5,32.6", "57.7,11.97"):
            self.assertIn(f"--centre {centre}", asked("--centre", centre, "--count", "1"))
            self.assertIn(f"--centre {centre}", asked(f"--centre={centre}", "--count", "1"))
        self.assertIn("expected one argument", asked("--centre"))


if __name__ == "__main__":
    unittest.main()
