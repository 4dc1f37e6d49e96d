"""What the network sees of a picture: local contrast, so that a dark, hazy or flat picture looks like any other.

Each channel minus the local mean of grey, over the local standard deviation of grey plus a floor; the window is a
square, and only what was seen counts. The product computes the same (core/detect/network_picture.cpp).
"""
from torch.nn import functional as F

WINDOW = 129  # pixels of the network
FLOOR = 4.0   # grey levels: flat areas are not blown up to noise
OFFSET = 118.0


def box(values):
    """Sum over the window round each pixel, by running sums along rows and then columns."""
    for axis in (3, 2):
        ahead = [0, 0] * (3 - axis) + [WINDOW // 2 + 1, WINDOW // 2]
        running = F.pad(values, ahead).cumsum(axis)
        size = values.shape[axis]
        values = running.narrow(axis, WINDOW, size) - running.narrow(axis, 0, size)
    return values


def network_input(rgb, seen):
    """float32 N x 3 x H x W, 0 where not seen, of RGB pictures N x 3 x H x W (0 to 255) and masks N x 1 x H x W."""
    mask = seen.float()
    shifted = rgb.float() - OFFSET
    grey = shifted.mean(1, keepdim=True) * mask
    count = box(mask).clamp(min=1.0)
    mean = box(grey) / count
    spread = (box(grey * grey) / count - mean * mean).clamp(min=0.0).sqrt() + FLOOR
    return (shifted - mean) / spread * mask
