"""What the network sees of a picture: local contrast, so that a dark, hazy or flat picture looks like any other.

Each channel minus the local mean of grey, over the local standard deviation of grey plus a floor; the window is a
square, and only what was seen counts. The product computes the same (core/detect/network_picture.cpp).
"""
import cv2
import numpy as np

WINDOW = 129  # pixels of the network
FLOOR = 4.0   # grey levels: flat areas are not blown up to noise
OFFSET = 118.0


def box(values):
    return cv2.boxFilter(values, cv2.CV_32F, (WINDOW, WINDOW), normalize=False, borderType=cv2.BORDER_CONSTANT)


def network_input(image, seen=None):
    """float32 rows x columns x 3 of an RGB picture; 0 where not seen."""
    rgb = image.astype(np.float32) - OFFSET
    mask = np.ones(rgb.shape[:2], np.float32) if seen is None else seen.astype(np.float32)
    grey = rgb.mean(2) * mask
    count = np.maximum(box(mask), 1.0)
    mean = box(grey) / count
    spread = np.sqrt(np.maximum(box(grey * grey) / count - mean * mean, 0.0)) + FLOOR
    return (rgb - mean[:, :, None]) / spread[:, :, None] * mask[:, :, None]
