#!/usr/bin/python3
"""The yardstick that networks are chosen by: roads place a window, what has nothing to do with roads does not; seconds.

Skips (exit 77) where torch or OpenCV for Python is not installed.
"""
import unittest

import with_torch  # noqa: F401

import cv2
import numpy as np
import torch
from roadnet import data, network, predict
from roadnet.localize import best_place, recall


def random_roads(rng, size):
    mask = np.zeros((size, size), np.uint8)
    for _ in range(size // 20):
        ends = rng.integers(0, size, 4).tolist()
        cv2.line(mask, ends[:2], ends[2:], 255, 6)
    return mask


def pairs(contrast, count=3, size=400):
    """Ground that any filter tells apart, by smooth random patches; its roads are brighter by `contrast`."""
    rng = np.random.default_rng(3)
    for number in range(count):
        mask = random_roads(rng, size)
        patches = cv2.GaussianBlur(rng.normal(0, 1, (size, size)), (0, 0), 4)
        image = 100 + 20 * patches / patches.std() + contrast * (mask > 0)
        image = np.repeat(image[:, :, None], 3, 2).clip(0, 255).astype(np.uint8)
        yield data.Pair(data.SetOptions("drawn", "", "", 1.0), str(number), image, mask)


def brightness(image, seen):
    """A fixed filter as a network's logits."""
    grey = image.mean(2)
    return cv2.resize((grey - grey.mean()) / grey.std(), None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA)


class Localize(unittest.TestCase):
    def test_a_filter_that_shows_roads_places_windows(self):
        share, count = recall(brightness, list(pairs(contrast=100)), 1.0)
        self.assertEqual(count, 18)
        self.assertGreater(share, 0.7)

    def test_a_filter_that_shows_anything_but_roads_does_not(self):
        self.assertLess(recall(brightness, list(pairs(contrast=0)), 1.0)[0], 0.2)

    def test_an_untrained_network_does_not(self):
        torch.manual_seed(1)
        untrained = predict.TorchNetwork(network.RoadNet())
        self.assertLess(recall(untrained, list(pairs(contrast=0)), 1.0)[0], 0.2)


class BestPlace(unittest.TestCase):
    def setUp(self):
        self.roads = random_roads(np.random.default_rng(7), 200).astype(np.float32) / 255
        self.window = self.roads[60:140, 30:110].copy()
        self.labelled, self.visible = np.ones((200, 200), bool), np.ones((80, 80), bool)

    def place(self):
        return tuple(best_place(self.window, self.visible, self.roads, self.labelled))

    def test_of_the_truth_itself_is_where_it_was_cut_out(self):
        self.assertEqual(self.place(), (60, 30))

    def test_does_not_depend_on_what_was_not_seen(self):
        self.visible[:, 50:] = False
        self.window[:, 50:] = np.random.default_rng(1).random((80, 30))
        self.assertEqual(self.place(), (60, 30))

    def test_does_not_depend_on_what_has_no_label(self):
        self.labelled[60:90, 30:110] = False
        self.roads[60:90, 30:110] = 1
        self.assertEqual(self.place(), (60, 30))

    def test_is_the_same_however_little_the_answer_varies(self):
        self.window = 0.4 + 1e-4 * self.window
        self.assertEqual(self.place(), (60, 30))


if __name__ == "__main__":
    unittest.main()
