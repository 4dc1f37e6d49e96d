"""The mission in small, on clean places: is a changed picture found again in the map made from the unchanged one?

The heading is given, as it is a training-time yardstick to choose networks by; `roadfix bench` measures the product.
"""
import cv2
import numpy as np

from . import augment
from .metrics import at_scale


def recall(predict, pairs, gsd_m, footprint_m=200.0, queries=6, tolerance_m=10.0, seed=1):
    """Share of queries whose best place by correlation lies within the tolerance, and how many there were."""
    side = int(footprint_m / gsd_m) // 16 * 16
    right = total = 0
    for number, pair in enumerate(pairs):
        image, truth, seen = at_scale(pair, gsd_m)
        if min(image.shape[:2]) < 1.5 * side:
            continue
        city = road_map(predict, image, seen)
        rng = np.random.default_rng([seed, number])
        for _ in range(queries):
            col, row = (int(rng.integers(0, (limit - side) // 2)) * 2 for limit in (image.shape[1], image.shape[0]))
            place = np.s_[row:row + side, col:col + side]
            if seen[place].mean() < 0.95 or truth[place].mean() < 0.01:
                continue
            weight = np.ones((side, side), np.float32)
            changed, _, visible = augment.apply(image[place].copy(), truth[place].astype(np.float32), weight, gsd_m, rng)
            found = road_map(predict, changed, visible)
            answer = cv2.matchTemplate(city, found, cv2.TM_CCOEFF_NORMED)
            best = np.unravel_index(np.argmax(answer), answer.shape)
            error = np.hypot(best[0] * 2 - row, best[1] * 2 - col) * gsd_m
            right, total = right + (error <= tolerance_m), total + 1
    return right / max(1, total), total


def road_map(predict, image, seen):
    return (1 / (1 + np.exp(-predict(image, seen)))).astype(np.float32)
