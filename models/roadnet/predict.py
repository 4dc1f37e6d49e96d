"""Logits of one picture, by torch or by OpenCV (what the product runs), in cells of 2 x 2 pixels."""
import cv2
import numpy as np
import torch
from torch.nn import functional as F

from .normalise import network_input

MULTIPLE = 16


def blob(image, seen):
    """1 x 3 x rows x columns; the sides are padded to the network's multiple with what was not seen."""
    height, width = image.shape[:2]
    mask = np.ones((height, width), bool) if seen is None else seen
    values = network_input(torch.from_numpy(image).permute(2, 0, 1)[None], torch.from_numpy(mask)[None, None])
    return F.pad(values, (0, -width % MULTIPLE, 0, -height % MULTIPLE)).contiguous()


class TorchNetwork:
    def __init__(self, model, device="cpu"):
        self.model, self.device = model, device

    def __call__(self, image, seen=None):
        self.model.eval()
        with torch.no_grad():
            return self.model(blob(image, seen).to(self.device))[0, 0].cpu().numpy()


class OnnxNetwork:
    def __init__(self, path):
        self.net = cv2.dnn.readNetFromONNX(str(path))

    def __call__(self, image, seen=None):
        self.net.setInput(blob(image, seen).numpy())
        return self.net.forward()[0, 0]


def probability_of_pixels(logits, shape, scale=1.0, bias=0.0):
    """Calibrated probability brought to the pixels of a picture of `shape`."""
    cells = 1 / (1 + np.exp(-(scale * logits + bias)))
    whole = cv2.resize(cells, (logits.shape[1] * 2, logits.shape[0] * 2), interpolation=cv2.INTER_LINEAR)
    return whole[:shape[0], :shape[1]]
