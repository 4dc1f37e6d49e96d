#!/usr/bin/python3
"""Measures a road network on pairs that it was not trained on, as a Markdown table.

Example: python3 models/evaluate.py --model models/roadnet.onnx --data ../shared/data
Held-out pairs of models/datasets.json and all pairs of models/evaluation.json are measured with OpenCV's DNN module,
the way the product runs the network.
"""
import argparse
import json
from pathlib import Path

import cv2

from roadnet.checkpoints import require_file
from roadnet.data import load_pairs, read_sets
from roadnet.localize import recall
from roadnet.metrics import evaluate_pairs, logits_and_labels, reliability
from roadnet.predict import OnnxNetwork


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    here = Path(__file__).resolve().parent
    parser.add_argument("--model", default=here / "roadnet.onnx", type=Path)
    parser.add_argument("--data", default=here.parent / "../shared/data", type=Path)
    parser.add_argument("--sets", default=here / "datasets.json", type=Path, help="their held-out pairs are measured")
    parser.add_argument("--evaluation-sets", default=here / "evaluation.json", type=Path, help="all of their pairs are measured")
    parser.add_argument("--threshold", default=0.5, type=float)
    parser.add_argument("--tolerance", default=3.0, type=float, help="metres (%(default)s)")
    parser.add_argument("--threads", default=2, type=int)
    return parser.parse_args()


def table(title, figures):
    print(f"\n{title}\n\n| place | precision | recall | F1 |\n|---|---|---|---|")
    for name, counts in figures.items():
        print(f"| {name} | {counts.precision:.3f} | {counts.recall:.3f} | {counts.f1:.3f} |")


def main():
    options = arguments()
    cv2.setNumThreads(options.threads)
    for path in (options.model, options.model.with_suffix(".json")):
        require_file(path)
    predict = OnnxNetwork(options.model)
    description = json.loads(options.model.with_suffix(".json").read_text())
    gsd_m, fit = description["gsd_m"], description["calibration"]
    held_out = [p for s in read_sets(options.sets, options.data) for p in load_pairs(s, options.data)[1]]
    foreign = [p for s in read_sets(options.evaluation_sets, options.data) for part in load_pairs(s, options.data) for p in part]
    if not held_out and not foreign:
        raise SystemExit(f"no pairs found below {options.data}")
    how = f"(tolerance {options.tolerance:g} m, threshold {options.threshold:g})"
    for title, pairs in ((f"Held-out pairs {how}", held_out), (f"Places of other sets {how}", foreign)):
        if pairs:
            table(title, evaluate_pairs(predict, pairs, gsd_m, options.threshold, options.tolerance, fit["scale"], fit["bias"]))
    if not held_out:
        return
    logits, labels = logits_and_labels(predict, held_out, gsd_m)
    rows, error = reliability(logits, labels, fit["scale"], fit["bias"])
    print(f"\nReliability on the held-out pairs, expected calibration error {error:.3f}\n\n| probability | road | pixels |\n|---|---|---|")
    for mean, share, count in rows:
        print(f"| {mean:.2f} | {share:.2f} | {count} |")
    share, count = recall(predict, held_out, gsd_m)
    print(f"\nLocalization of augmented 200 m windows by the labelled roads of their held-out picture, heading known: "
          f"{share:.2f} of {count} within 10 m")


if __name__ == "__main__":
    main()
