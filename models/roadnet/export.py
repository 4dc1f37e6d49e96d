"""ONNX that OpenCV 4.6 runs, and the description beside it that the product reads."""
import json
import math
from pathlib import Path

import cv2
import numpy as np
import torch

from .normalise import FLOOR, WINDOW

STRIDE = 2  # the network's output cells, in its input pixels


def fnv1a64(data):
    """The checksum of the description: not against forgery, against a file of another model."""
    value = 0xCBF29CE484222325
    for byte in data:
        value = ((value ^ byte) * 0x100000001B3) & 0xFFFFFFFFFFFFFFFF
    return f"{value:016x}"


def export(model, gsd_m, path, name, scale=1.0, bias=0.0, licence=""):
    """Writes `path` and the JSON of the same stem. `scale` and `bias` calibrate: p = sigmoid(scale * logit + bias)."""
    model = model.cpu().eval()
    path = Path(path)
    torch.onnx.export(model, torch.zeros(1, 3, 256, 256), str(path), opset_version=11, input_names=["picture"],
                      output_names=["logits"], do_constant_folding=True)
    description = {
        "name": name, "gsd_m": gsd_m, "stride": STRIDE, "multiple": 16, "tile_px": 1024, "overlap_px": 80,
        "channels": "rgb", "local_contrast": {"window_px": WINDOW, "floor": FLOOR}, "mean": [0, 0, 0], "std": [1, 1, 1], "output": "logits",
        "calibration": {"scale": round(scale, 6), "bias": round(bias, 6)},
        "licence": licence, "fnv1a64": fnv1a64(path.read_bytes())}
    path.with_suffix(".json").write_text(json.dumps(description, indent=2) + "\n")


def difference(model, path, height=208, width=176):
    """Largest difference of the logits between torch and OpenCV on a random picture of another size than exported."""
    picture = np.random.default_rng(1).normal(0, 1, (1, 3, height, width)).astype(np.float32)
    net = cv2.dnn.readNetFromONNX(str(path))
    net.setInput(picture)
    ours = net.forward()
    with torch.no_grad():
        theirs = model.cpu().eval()(torch.from_numpy(picture)).numpy()
    if ours.shape != theirs.shape:
        raise RuntimeError(f"OpenCV answers {ours.shape}, torch {theirs.shape}")
    return float(np.abs(ours - theirs).max())


def fit_calibration(logits, labels):
    """Scale and bias of logistic regression of the labels on the logits, by Newton's method."""
    scale, bias = 1.0, 0.0
    for _ in range(30):
        p = 1 / (1 + np.exp(-(scale * logits + bias)))
        w = np.maximum(p * (1 - p), 1e-6)
        gradient = np.array([((labels - p) * logits).mean(), (labels - p).mean()])
        hessian = np.array([[(w * logits * logits).mean(), (w * logits).mean()], [(w * logits).mean(), w.mean()]])
        step = np.linalg.solve(hessian + 1e-9 * np.eye(2), gradient)
        scale, bias = scale + step[0], bias + step[1]
        if math.hypot(*step) < 1e-7:
            break
    return float(scale), float(bias)
