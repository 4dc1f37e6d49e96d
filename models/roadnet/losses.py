"""Losses that bear incomplete and slightly shifted labels, and the one of a teacher."""
import torch
from torch.nn import functional as F


def to_cells(label, weight):
    """Labels and weights of pixels averaged into the output's cells of 2 x 2 pixels; half-ignored cells are ignored."""
    seen = F.avg_pool2d(weight, 2)
    road = F.avg_pool2d(label * weight, 2) / seen.clamp(min=1e-6)
    return road, (seen >= 0.5).float()


def share_of_road(label, weight):
    """Of the labelled cells of each picture; labels 0 to 255."""
    road, seen = to_cells(label / 255, weight.float())
    return (road * seen).sum((1, 2, 3)) / seen.sum((1, 2, 3)).clamp(min=1)


def road_loss(logits, label, weight, missing=0.05):
    """Cross-entropy plus soft Dice over the cells with a label. `missing` is the share of background that may be an
    unlabelled road: the target there is that much above 0, so that a confident right road costs little."""
    road, seen = to_cells(label, weight)
    target = road * (1 - missing) + missing * 0.5
    entropy = F.binary_cross_entropy_with_logits(logits, target, reduction="none")
    entropy = (entropy * (1 + road) * seen).sum() / seen.sum().clamp(min=1)
    found = torch.sigmoid(logits) * seen
    overlap, total = (found * road).sum(), found.sum() + (road * seen).sum()
    dice = 1 - (2 * overlap + 1) / (total + 1)
    return entropy + 0.5 * dice


def distillation_loss(logits, taught, picture):
    """Cross-entropy against the probabilities of a teacher's logits (Hinton, Vinyals and Dean 2015, at temperature 1). It
    speaks about every cell of the picture that the pupil saw, also where a label is missing or unsure."""
    seen = (F.max_pool2d(picture.abs().amax(1, keepdim=True), 2) > 0).float()
    entropy = F.binary_cross_entropy_with_logits(logits, torch.sigmoid(taught), reduction="none")
    return (entropy * seen).sum() / seen.sum().clamp(min=1)


def in_a_random_orientation(network, picture, generator):
    """A network's logits of a picture turned by quarters or flipped, turned back. The mean over many crops is what it
    says on the mean of all eight orientations, for the price of one."""
    quarters, flip = (int(torch.randint(n, (), generator=generator)) for n in (4, 2))
    turned = torch.rot90(picture.flip(3) if flip else picture, quarters, (2, 3))
    back = torch.rot90(network(turned.contiguous(memory_format=torch.channels_last)), -quarters, (2, 3))
    return back.flip(3) if flip else back
