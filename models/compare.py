#!/usr/bin/python3
"""Measures detectors of `roadfix` on places that the network was not trained on, as a Markdown table.

Example: python3 models/compare.py --roadfix build/release/cli/roadfix --data ../shared/data \\
             --scene vegas-lines=spacenet-samples/AOI_2_Vegas_img0.tif=spacenet-samples/AOI_2_Vegas_img0_roads.geojson
Precision, recall and F1 bear 3 m; of scenes with road lines, lines are compared with the middle of what was detected.
APLS is the mean over pictures (models/roadnet/paths.py); the middle of a drawn mask stands for lines where there are none.
"""
import argparse
import subprocess
import tempfile
from collections import defaultdict
from pathlib import Path

import cv2
import numpy as np

from roadnet.data import load_pairs, read_sets
from roadnet.metrics import Counts, relaxed_counts
from roadnet.paths import similarity, skeleton

CELL_M = 2.0
PIXEL_M = 1.0
THRESHOLDS = (0.02, 0.05, *np.round(np.arange(0.1, 0.91, 0.1), 1))


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    here = Path(__file__).resolve().parent
    parser.add_argument("--roadfix", required=True, type=Path, help="the program")
    parser.add_argument("--detectors", default="tree,neural", help="of roadfix, by comma; neural:8 = mean of 8 orientations (%(default)s)")
    parser.add_argument("--model", type=Path, help="another network for the neural detector")
    parser.add_argument("--data", default=here.parent / "../shared/data", type=Path)
    parser.add_argument("--sets", default=here / "datasets.json", type=Path, help="their held-out pairs are measured")
    parser.add_argument("--evaluation-sets", default=here / "evaluation.json", type=Path, help="all of their pairs are measured")
    parser.add_argument("--scene", action="append", default=[], metavar="NAME=PICTURE=LINES", help="below --data; needs GDAL for Python")
    parser.add_argument("--tolerance", default=3.0, type=float, help="metres (%(default)s)")
    return parser.parse_args()


def detected(options, detector, pair):
    """Probability of road in pixels of 1 m."""
    level = pair.levels[0]
    with tempfile.TemporaryDirectory() as place:
        picture, answer = Path(place) / "picture.png", Path(place) / "roads.png"
        cv2.imwrite(str(picture), np.dstack([level.image[:, :, ::-1], pair.seen.astype(np.uint8) * 255]))
        name, _, orientations = detector.partition(":")
        command = [options.roadfix, "detect", picture, answer, "--gsd", level.gsd_m, "--cell", CELL_M, "--detector", name,
                   "--compare-with", "roads"]
        command += ["--orientations", orientations] if orientations else []
        command += ["--model", options.model] if options.model and name == "neural" else []
        subprocess.run(list(map(str, command)), check=True, stdout=subprocess.DEVNULL)
        cells = cv2.imread(str(answer), cv2.IMREAD_UNCHANGED)
    probability = np.where(cells[:, :, -1] > 127, cells[:, :, 0] / 254.0, 0.0).astype(np.float32)
    times = CELL_M / PIXEL_M
    return cv2.resize(probability, None, fx=times, fy=times, interpolation=cv2.INTER_LINEAR)


def at_pixels(mask, shape):
    return cv2.resize(mask.astype(np.float32), shape[::-1], interpolation=cv2.INTER_AREA) > 0.5


class Row:
    """One place and detector: counts for each threshold; path similarity, which takes long, only where it is asked for."""

    def __init__(self):
        self.counts = {t: Counts() for t in THRESHOLDS}
        self.pictures = []

    def add(self, pair, probability, tolerance_m):
        shape = tuple(int(round(side * pair.levels[0].gsd_m / PIXEL_M)) for side in pair.seen.shape)
        probability = probability[:shape[0], :shape[1]]
        truth, seen = at_pixels(pair.truth, shape), at_pixels(pair.seen, shape)
        lines = getattr(pair, "lines", False)
        for t in THRESHOLDS:
            found = (probability > t) & seen
            counted = (skeleton(found), skeleton(truth)) if lines else (found, truth)
            self.counts[t] += relaxed_counts(*counted, seen, tolerance_m, PIXEL_M)
        self.pictures.append((probability * seen, truth))

    def best(self):
        return max(THRESHOLDS, key=lambda t: self.counts[t].f1)

    def figures(self, t):
        scores = [similarity(truth, probability > t, PIXEL_M) for probability, truth in self.pictures]
        scores = [score for score in scores if score is not None]
        apls = f"{np.mean(scores):.3f}" if scores else "-"
        counts = self.counts[t]
        return f"{counts.precision:.3f} | {counts.recall:.3f} | {counts.f1:.3f} | {apls}"


def scenes(options):
    if not options.scene:
        return []
    from roadnet.scenes import Scene
    return [Scene(name, options.data / picture, options.data / lines)
            for name, picture, lines in (text.split("=") for text in options.scene)]


def main():
    options = arguments()
    pairs = [p for s in read_sets(options.sets, options.data) for p in load_pairs(s, options.data)[1]]
    pairs += [p for s in read_sets(options.evaluation_sets, options.data) for part in load_pairs(s, options.data) for p in part]
    pairs += scenes(options)
    print("| place | detector | precision | recall | F1 | APLS | best threshold | precision | recall | F1 | APLS |\n" + "|---" * 11 + "|")
    for detector in options.detectors.split(","):
        rows = defaultdict(Row)
        for pair in pairs:
            rows[pair.set_name].add(pair, detected(options, detector, pair), options.tolerance)
        for name, row in rows.items():
            best = row.best()
            print(f"| {name} | {detector} | {row.figures(0.5)} | {best:g} | {row.figures(best)} |", flush=True)


if __name__ == "__main__":
    main()
