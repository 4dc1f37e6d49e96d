#!/usr/bin/python3
"""The loss of frames that agree with the map of their place alone, on streets drawn here.

Skips (exit 77) where torch or OpenCV for Python is not installed.
"""
import tempfile
import unittest
from pathlib import Path

import with_torch  # noqa: F401

import cv2
import numpy as np
import torch
from roadnet import alignment, augment, data

FOOTPRINT = alignment.Footprint(row=11, col=5, side=40)


def streets(count, side=64):
    """Logits of `count` places, each of a few streets."""
    rng = np.random.default_rng(3)
    places = np.full((count, 1, side, side), -4, np.float32)
    for place in places[:, 0]:
        for _ in range(5):
            ends = rng.integers(0, side, 4).tolist()
            cv2.line(place, ends[:2], ends[2:], 3.0, 3)
    return torch.from_numpy(places)


def all_pixels(logits):
    return torch.ones(len(logits), 1, *(2 * side for side in logits.shape[-2:]))


def loss(frames, maps, seen=None, mapped=None, footprint=FOOTPRINT, road=0.1):
    seen, mapped = (all_pixels(of) if mask is None else mask for of, mask in ((frames, seen), (maps, mapped)))
    return alignment.alignment_loss(frames, seen, maps, mapped, footprint, torch.full((len(frames),), road))


class Alignment(unittest.TestCase):
    def setUp(self):
        self.maps = streets(6)
        self.frames = self.maps[FOOTPRINT.cells()].clone()

    def test_the_correlation_is_pearsons_over_the_cells_that_both_observed(self):
        torch.manual_seed(1)
        frame, maps = torch.rand(1, 1, 5, 4), torch.rand(1, 2, 8, 7)
        seen, mapped = ((torch.rand_like(values) < 0.8).float() for values in (frame, maps))
        found = alignment.correlation(frame, seen, maps, mapped)
        self.assertEqual(found.shape, (1, 2, 4, 4))
        for place in np.ndindex(2, 4, 4):
            here = np.s_[0, place[0], place[1]:place[1] + 5, place[2]:place[2] + 4]
            both = (seen[0, 0] * mapped[here]).bool()
            expected = np.corrcoef(frame[0, 0][both], maps[here][both])[0, 1]
            self.assertAlmostEqual(found[(0, *place)].item(), expected, 4)

    def test_the_true_shift_wins_against_others_other_orientations_and_other_places(self):
        self.assertLess(loss(self.frames, self.maps).item(), 0.05)
        self.assertLess(loss(self.frames, self.maps, footprint=alignment.Footprint(12, 4, 40)).item(), 0.1)
        for wrong in (self.frames.roll(1, 0), self.frames.rot90(1, (2, 3)), self.maps[..., :40, 20:60]):
            self.assertGreater(loss(wrong, self.maps).item(), 3.0)

    def test_its_gradient_makes_frame_and_map_agree(self):
        torch.manual_seed(1)
        frames, maps = ((part + 8 * torch.randn_like(part)).requires_grad_() for part in (self.frames, self.maps))
        steps = torch.optim.Adam([frames, maps], 0.3)
        losses = []
        for _ in range(20):
            losses.append(loss(frames, maps))
            steps.zero_grad()
            losses[-1].backward()
            self.assertTrue(torch.isfinite(frames.grad).all() and torch.isfinite(maps.grad).all())
            steps.step()
        self.assertLess(losses[-1].item(), 0.7 * losses[0].item())

    def test_cells_that_were_not_observed_do_not_count(self):
        for hidden, part, name in ((self.frames, np.s_[..., :12], "seen"), (self.maps, np.s_[..., :20, :], "mapped")):
            mask, other = all_pixels(hidden), hidden.clone()
            other[part] = 9.0
            cells = torch.ones_like(hidden)
            cells[part] = 0
            mask = cells.repeat_interleave(2, 2).repeat_interleave(2, 3)
            pairs = [(of, self.maps) if name == "seen" else (self.frames, of) for of in (hidden, other)]
            one, two = (loss(*pair, **{name: mask}).item() for pair in pairs)
            self.assertAlmostEqual(one, two, 4)

    def test_frames_that_show_no_road_or_whose_place_was_hardly_observed_do_not_count(self):
        wrong = self.frames.roll(1, 0).requires_grad_()
        self.assertEqual(loss(wrong, self.maps, road=0.01).item(), 0.0)
        nothing = loss(wrong, self.maps, mapped=0 * all_pixels(self.maps))
        nothing.backward()
        self.assertEqual(nothing.item(), 0.0)
        self.assertTrue((wrong.grad == 0).all())

    def test_a_footprint_lies_in_its_map_and_fits_the_network(self):
        generator = torch.Generator().manual_seed(1)
        for _ in range(100):
            footprint = alignment.random_footprint(96, generator)
            self.assertTrue(footprint.side % 8 == 0 and 0.55 * 96 <= footprint.side <= 0.8 * 96)
            self.assertTrue(0 <= min(footprint.row, footprint.col) and max(footprint.row, footprint.col) + footprint.side <= 96)


class TwoPictures(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.folder = Path(place.name)

    def crops(self, unseen_later=0):
        """Of three places on two days, of which the second shows none of the first `unseen_later` columns."""
        for part in ("images", "masks"):
            (self.folder / part).mkdir()
        mask = np.zeros((160, 160), np.uint8)
        cv2.line(mask, (20, 10), (140, 150), 255, 9)
        for place in "abc":
            for day, value in (("pre", 40), ("post", 210)):
                picture = np.full((160, 160, 3), value, np.uint8)
                picture[mask > 0] = 125
                if day == "post":
                    picture[:, :unseen_later] = 0
                cv2.imwrite(f"{self.folder}/images/{place}_{day}.png", picture)
                cv2.imwrite(f"{self.folder}/masks/{place}_{day}.png", mask)
        options = data.SetOptions("own", "images", "masks", 1.0, nodata="black")
        return data.Crops([options], self.folder, 1.0, 96, 3, 10 ** 9, twice=True)

    def test_of_a_crop_are_two_days_of_one_place_in_one_geometry(self):
        crops = self.crops()
        changed, _, clean, _, label, _, another, *_ = crops[4]
        self.assertEqual([part.shape for part in (changed, another)], [(3, 96, 96)] * 2)
        first, _, weight, again, weight_again = crops.crop(0, 96, np.random.default_rng(1))
        self.assertEqual({*np.unique(first)} & {40, 210} | {*np.unique(again)} & {40, 210}, {40, 210})
        np.testing.assert_array_equal(first == 125, again == 125)
        np.testing.assert_array_equal(weight, weight_again)

    def test_ground_that_the_second_did_not_see_is_not_told_as_seen(self):
        crops, shares = self.crops(unseen_later=80), []
        for seed in range(20):
            _, label, _, another, weight = crops.crop(0, 96, np.random.default_rng(seed))
            unseen = (another == data.FILL).all(2) & (label == 0)  # where a road blurs into the ground, some pixels are as grey
            self.assertTrue(augment.weight_is_unseen(another, weight)[unseen].all())
            shares.append(unseen.mean())
        self.assertTrue(min(shares) < 0.2 and max(shares) > 0.5)

    def test_a_second_that_saw_nothing_of_the_ground_teaches_nothing(self):
        crops = self.crops(unseen_later=160)
        for number in range(5):
            *_, seen, weight = crops[number]
            self.assertFalse(seen.any() or weight.any())


if __name__ == "__main__":
    unittest.main()
