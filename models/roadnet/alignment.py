"""A loss for what the network is used for: that a frame agrees with the map of its place there and nowhere else.

The frame is a part of a second picture of the ground that the map shows. Its correlations with that map at all shifts,
with the map in other orientations and with maps of other places are the classes of a cross-entropy; the true shift is
the right one (InfoNCE: van den Oord, Li and Vinyals 2018).
"""
from dataclasses import dataclass

import torch
from torch.nn import functional as F

TEMPERATURE = 0.05
NEAR = 2  # cells from the true shift that are as right
OTHERS = 4  # maps of other places that each frame is compared with
LEAST_ROAD = 0.03  # share of the frame's cells: with less of it only texture could tell places apart, and that does not last
UNSEEN = -2.0  # stands for a correlation where too little was observed: less than any
LEAST_SEEN = 0.5  # share of the frame's observed cells that a place of the map must have observed


@dataclass
class Footprint:
    """A square part of a map, in cells."""

    row: int
    col: int
    side: int

    def cells(self):
        return ..., slice(self.row, self.row + self.side), slice(self.col, self.col + self.side)

    def pixels(self):
        return ..., slice(2 * self.row, 2 * (self.row + self.side)), slice(2 * self.col, 2 * (self.col + self.side))


def random_footprint(map_side, generator):
    """About 60 to 75 % of the map's side, a multiple of 8 cells: the network's pictures are multiples of 16 pixels."""
    least, most = (max(1, round(share * map_side / 8)) for share in (0.6, 0.75))
    side = 8 * int(torch.randint(least, most + 1, (), generator=generator))
    row, col = (int(torch.randint(0, map_side - side + 1, (), generator=generator)) for _ in range(2))
    return Footprint(row, col, side)


def half_the_log_odds(logits):
    """What the product compares (core/locate/soft_map.hpp), as a probability."""
    return torch.sigmoid(logits / 2)


def correlation(frames, seen, maps, mapped):
    """Pearson's correlation of frames (N x 1 x h x w) with K maps each (N x K x H x W) at each of the (H - h + 1) x
    (W - w + 1) shifts, over the cells that both observed (`seen` and `mapped`: 1, else 0). UNSEEN where these are too few.
    By Fourier transforms (Padfield 2012, "Masked object registration in the Fourier domain")."""
    size = maps.shape[-2:]
    shifts = ..., slice(size[0] - frames.shape[-2] + 1), slice(size[1] - frames.shape[-1] + 1)
    map_mask, map_sum, map_squares = (torch.fft.rfft2(x) for x in (mapped, maps * mapped, maps ** 2 * mapped))
    mask, total, squares = (torch.fft.rfft2(x, size).conj() for x in (seen, frames * seen, frames ** 2 * seen))

    def sums(of_map, of_frame):
        return torch.fft.irfft2(of_map * of_frame, size)[shifts]

    both = sums(map_mask, mask)
    count = both.clamp(min=1)
    map_mean, mean = sums(map_sum, mask) / count, sums(map_mask, total) / count
    map_variance, variance = sums(map_squares, mask) / count - map_mean ** 2, sums(map_mask, squares) / count - mean ** 2
    rho = (sums(map_sum, total) / count - map_mean * mean) / (map_variance.clamp(min=1e-4) * variance.clamp(min=1e-4)).sqrt()
    return rho.masked_fill(both < LEAST_SEEN * seen.sum((-2, -1), keepdim=True), UNSEEN)


def candidates(maps):
    """N x 1 x H x W, squares, to N x K x H x W: each map, itself in the other three orientations, and some of other places."""
    turned = [torch.rot90(maps, quarters, (2, 3)) for quarters in range(4)]
    others = [turned[number % 4].roll(number, 0) for number in range(1, min(OTHERS + 1, len(maps)))]
    return torch.cat(turned + others, 1)


def alignment_loss(frames, seen, maps, mapped, footprint, road):
    """Mean over the frames that show roads of -log(share of the true shift among all). `frames` and `maps` are logits of
    N places each, `seen` and `mapped` masks of the pixels that their pictures observed, `road` the share of labelled road
    of each frame."""
    seen, mapped = observed_cells(seen), observed_cells(mapped)
    rho = correlation(half_the_log_odds(frames), seen, candidates(half_the_log_odds(maps)), candidates(mapped))
    scores = rho / TEMPERATURE
    rows, cols = (slice(max(0, at - NEAR), at + NEAR + 1) for at in (footprint.row, footprint.col))
    loss = scores.flatten(1).logsumexp(1) - scores[:, 0, rows, cols].flatten(1).logsumexp(1)
    counts = (road >= LEAST_ROAD) & (rho[:, 0, footprint.row, footprint.col] > UNSEEN)
    return (loss * counts).sum() / counts.sum().clamp(min=1)


def observed_cells(seen):
    """Of masks of pixels: cells of 2 x 2 of which half were seen, as 1 and 0."""
    return (F.avg_pool2d(seen.float(), 2) >= 0.5).float()
