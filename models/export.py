#!/usr/bin/python3
"""Turns a checkpoint of models/train.py, or several, into ONNX and the JSON beside it, calibrated on held-out pairs.

Example: python3 models/export.py --checkpoint build/roadnet/checkpoint.pt --out models/roadnet.onnx --data ../shared/data
"""
import argparse
from pathlib import Path

import cv2
import torch

from roadnet.checkpoints import mean_of_weights, read_network, state_of
from roadnet.data import load_pairs, read_sets
from roadnet.export import difference, export, fit_calibration
from roadnet.metrics import logits_and_labels
from roadnet.predict import TorchNetwork


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    here = Path(__file__).resolve().parent
    parser.add_argument("--checkpoint", default=[Path("build/roadnet/checkpoint.pt")], type=Path, nargs="+",
                        help="several become one network: the mean of their logits")
    parser.add_argument("--mean-weights", action="store_true",
                        help="of several checkpoints of which one began with another, the mean of their weights: no slower than one")
    parser.add_argument("--out", default=here / "roadnet.onnx", type=Path)
    parser.add_argument("--name", default="", help="name in the provenance of maps; the file's stem and the step by default")
    parser.add_argument("--data", default=here.parent / "../shared/data", type=Path)
    parser.add_argument("--sets", default=here / "datasets.json", type=Path, help="calibrate on their held-out pairs")
    parser.add_argument("--licence", default="CC BY-SA 4.0")
    parser.add_argument("--threads", default=2, type=int)
    return parser.parse_args()


def main():
    options = arguments()
    torch.set_num_threads(options.threads)
    cv2.setNumThreads(options.threads)
    states = [state_of(path) for path in options.checkpoint]
    gsd_m = states[0]["gsd_m"]
    if any(state["gsd_m"] != gsd_m for state in states):
        raise SystemExit("the checkpoints see different metres per pixel: they cannot become one network")
    model = (mean_of_weights if options.mean_weights else read_network)(options.checkpoint)
    held_out = [p for s in read_sets(options.sets, options.data) if s.share > 0 for p in load_pairs(s, options.data)[1]]
    scale, bias = 1.0, 0.0
    if held_out:
        scale, bias = fit_calibration(*logits_and_labels(TorchNetwork(model), held_out, gsd_m))
    else:
        print("no held-out pairs: the probabilities stay uncalibrated")
    name = options.name or "-".join([options.out.stem] + [str(state["step"]) for state in states])
    export(model, gsd_m, options.out, name, scale, bias, options.licence)
    worst = difference(model, options.out)
    print(f"{options.out}: {options.out.stat().st_size} bytes, calibration scale {scale:.3f} bias {bias:.3f}, "
          f"OpenCV {cv2.__version__} differs from torch by at most {worst:.1e}")
    if worst > 1e-3:
        raise SystemExit("OpenCV and torch disagree: do not use this file")


if __name__ == "__main__":
    main()
