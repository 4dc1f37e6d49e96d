"""Precision, recall and F1 with a tolerance, and reliability, on held-out pairs at the network's scale."""
from collections import defaultdict
from dataclasses import dataclass, fields

import cv2
import numpy as np

from .data import FILL
from .predict import probability_of_pixels


@dataclass
class Counts:
    """Sums over pixels; several pictures add up."""

    predicted: float = 0
    predicted_right: float = 0
    labelled: float = 0
    labelled_found: float = 0

    def __add__(self, other):
        return Counts(*(getattr(self, f.name) + getattr(other, f.name) for f in fields(self)))

    @property
    def precision(self):
        return self.predicted_right / max(1, self.predicted)

    @property
    def recall(self):
        return self.labelled_found / max(1, self.labelled)

    @property
    def f1(self):
        return 2 * self.precision * self.recall / max(1e-9, self.precision + self.recall)

    def __str__(self):
        return f"precision {self.precision:.3f} recall {self.recall:.3f} F1 {self.f1:.3f}"


def at_scale(pair, gsd_m):
    """Picture, truth (bool) and seen (bool) of a pair with pixels of `gsd_m`."""
    base = pair.levels[0]
    scale = base.gsd_m / gsd_m
    size = tuple(int(round(side * scale)) for side in base.image.shape[1::-1])
    shrink = [cv2.resize(a, size, interpolation=cv2.INTER_AREA)
              for a in (base.image, pair.truth.astype(np.float32), pair.seen.astype(np.float32))]
    image, truth, seen = shrink[0], shrink[1] > 0.5, shrink[2] > 0.5
    image[~seen] = FILL
    return image, truth, seen


def labelled_at_scale(pair, gsd_m):
    """bool, as `at_scale`: where the label says road or no road, outside the band where it is unsure."""
    base = pair.levels[0]
    size = tuple(int(round(side * base.gsd_m / gsd_m)) for side in base.weight.shape[::-1])
    return cv2.resize(base.weight, size, interpolation=cv2.INTER_AREA) > 191


def relaxed_counts(predicted, truth, seen, tolerance_m, gsd_m):
    """Predicted road counts as right within the tolerance of labelled road, and the other way round."""
    def near(mask):
        if not mask.any():
            return np.zeros(mask.shape, bool)
        return cv2.distanceTransform((~mask).astype(np.uint8), cv2.DIST_L2, 5) * gsd_m <= tolerance_m
    found, labelled = predicted & seen, truth & seen
    return Counts(found.sum(), (found & near(truth)).sum(), labelled.sum(), (labelled & near(predicted)).sum())


def evaluate_pairs(predict, pairs, gsd_m, threshold=0.5, tolerance_m=3.0, scale=1.0, bias=0.0):
    """Counts by set name, with the sum of all under "all". `predict` gives the logits of a picture."""
    totals = defaultdict(Counts)
    for pair in pairs:
        image, truth, seen = at_scale(pair, gsd_m)
        found = probability_of_pixels(predict(image, seen), image.shape, scale, bias) > threshold
        counts = relaxed_counts(found, truth, seen, tolerance_m, gsd_m)
        totals[pair.set_name] += counts
    return {**totals, "all": sum(totals.values(), Counts())}


def logits_and_labels(predict, pairs, gsd_m, each=20000, seed=1):
    """Random observed pixels of each pair, with weight: outside the band where the label is unsure."""
    rng = np.random.default_rng(seed)
    logits, labels = [], []
    for pair in pairs:
        image, truth, seen = at_scale(pair, gsd_m)
        sure = labelled_at_scale(pair, gsd_m)
        cells = predict(image, seen)
        whole = cv2.resize(cells, (cells.shape[1] * 2, cells.shape[0] * 2), interpolation=cv2.INTER_LINEAR)
        rows, cols = np.nonzero(seen & sure)
        chosen = rng.integers(0, len(rows), min(each, len(rows)))
        logits.append(whole[rows[chosen], cols[chosen]])
        labels.append(truth[rows[chosen], cols[chosen]].astype(np.float64))
    return np.concatenate(logits).astype(np.float64), np.concatenate(labels)


def reliability(logits, labels, scale, bias, bins=10):
    """Rows of (mean probability, share of road, count) by tenths of probability, and the expected calibration error."""
    p = 1 / (1 + np.exp(-(scale * logits + bias)))
    which = np.minimum((p * bins).astype(int), bins - 1)
    rows = [(p[which == b].mean(), labels[which == b].mean(), int((which == b).sum())) for b in range(bins) if (which == b).any()]
    return rows, sum(abs(mean - share) * n for mean, share, n in rows) / len(p)
