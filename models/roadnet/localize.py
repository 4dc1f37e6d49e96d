"""The mission in small, on clean places: is a changed picture found again by the labelled roads of its place?

By the labels and not by what the network says of the unchanged picture: with itself any fixed filter agrees, trained or
not. The heading is given, as it is a training-time yardstick to choose networks by; `roadfix bench` measures the product.
"""
import cv2
import numpy as np

from . import augment
from .metrics import at_scale, labelled_at_scale


def recall(predict, pairs, gsd_m, footprint_m=200.0, queries=6, tolerance_m=10.0, seed=1):
    """Share of queries whose best place by correlation lies within the tolerance, and how many there were."""
    side = int(footprint_m / gsd_m) // 16 * 16
    right = total = 0
    for number, pair in enumerate(pairs):
        image, truth, seen = at_scale(pair, gsd_m)
        if min(image.shape[:2]) < 1.5 * side:
            continue
        roads, labelled = cells(truth), cells(labelled_at_scale(pair, gsd_m)) == 1
        rng = np.random.default_rng([seed, number])
        for _ in range(queries):
            col, row = (int(rng.integers(0, (limit - side) // 2)) * 2 for limit in (image.shape[1], image.shape[0]))
            place = np.s_[row:row + side, col:col + side]
            if seen[place].mean() < 0.95 or truth[place].mean() < 0.01:
                continue
            weight = np.ones((side, side), np.float32)
            changed, _, visible = augment.apply(image[place].copy(), truth[place].astype(np.float32), weight, gsd_m, rng)
            found = 1 / (1 + np.exp(-predict(changed, visible)))
            best = best_place(found, cells(visible) == 1, roads, labelled)
            error = np.hypot(best[0] * 2 - row, best[1] * 2 - col) * gsd_m
            right, total = right + (error <= tolerance_m), total + 1
    return right / max(1, total), total


def cells(mask):
    """Share of each 2 x 2 pixels, the network's cells."""
    height, width = (side // 2 for side in mask.shape)
    return cv2.resize(mask[:2 * height, :2 * width].astype(np.float32), (width, height), interpolation=cv2.INTER_AREA)


def best_place(found, visible, roads, labelled):
    """Row and column of the corner at which `found` correlates best with `roads`, over the cells that are both visible and
    labelled there; at least half of the visible ones."""
    found = np.where(visible, found - found[visible].mean(), 0).astype(np.float32)  # what varies little keeps its digits
    roads = np.where(labelled, roads, 0)
    visible, labelled = visible.astype(np.float32), labelled.astype(np.float32)

    def sums(of_map, of_window):
        return cv2.matchTemplate(of_map, of_window, cv2.TM_CCORR).astype(np.float64)

    count = np.maximum(sums(labelled, visible), 1)
    map_mean, window_mean = sums(roads, visible) / count, sums(labelled, found) / count
    map_variance = sums(roads * roads, visible) / count - map_mean ** 2
    window_variance = sums(labelled, found * found) / count - window_mean ** 2
    covariance = sums(roads, found) / count - map_mean * window_mean
    rho = covariance / np.sqrt(np.maximum(map_variance, 1e-4) * np.maximum(window_variance, 1e-12))
    rho[count < 0.5 * visible.sum()] = -1
    return np.unravel_index(np.argmax(rho), rho.shape)
