"""To be imported first: makes the package roadnet importable, and ends a test as skipped (exit 77) where torch or OpenCV
for Python is not installed."""
import sys
from pathlib import Path

try:
    import cv2  # noqa: F401
    import numpy  # noqa: F401
    import torch  # noqa: F401
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

MODELS = Path(__file__).resolve().parents[2] / "models"
sys.path.insert(0, str(MODELS))
