"""Logits of one picture, by torch or by OpenCV (what the product runs), in cells of 2 x 2 pixels."""
import cv2
import numpy as np
import torch

from .normalise import normalised

MULTIPLE = 16


def padded(image):
    height, width = image.shape[:2]
    return cv2.copyMakeBorder(image, 0, -height % MULTIPLE, 0, -width % MULTIPLE, cv2.BORDER_REFLECT_101)


class TorchNetwork:
    def __init__(self, model, device="cpu"):
        self.model, self.device = model, device

    def __call__(self, image):
        tensor = torch.from_numpy(padded(image).astype(np.float32).transpose(2, 0, 1)[None]).to(self.device)
        self.model.eval()
        with torch.no_grad():
            return self.model(normalised(tensor))[0, 0].cpu().numpy()


class OnnxNetwork:
    def __init__(self, path):
        self.net = cv2.dnn.readNetFromONNX(str(path))

    def __call__(self, image):
        self.net.setInput(normalised(padded(image).astype(np.float32).transpose(2, 0, 1)[None]))
        return self.net.forward()[0, 0]


def probability_of_pixels(logits, shape, scale=1.0, bias=0.0):
    """Calibrated probability brought to the pixels of a picture of `shape`."""
    cells = 1 / (1 + np.exp(-(scale * logits + bias)))
    whole = cv2.resize(cells, (logits.shape[1] * 2, logits.shape[0] * 2), interpolation=cv2.INTER_LINEAR)
    return whole[:shape[0], :shape[1]]
