"""Labelled pairs (picture, road mask) and random training crops of them at the network's scale.

Pictures are RGB uint8; labels and weights are uint8 0 to 255 in a pair and float32 in [0, 1] in a crop. A weight is 0
where a label says nothing (nodata, outside the tile, the uncertain band round a road's edge).
"""
import json
import math
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from . import augment

EXTENSIONS = (".png", ".jpg", ".jpeg", ".tif", ".tiff", ".webp")
MAX_TILT_DEG = 15.0  # of a camera that is not gimballed
WILDER = 1.6  # chance of each change of the second of two pictures of one ground, against that of the first
FILL = 118  # grey that stands for "not seen", close to the mean that the network subtracts


@dataclass
class SetOptions:
    """How one folder of pairs is to be read; `models/datasets.json` holds those of the shipped weights."""

    name: str
    images: str
    masks: str
    gsd_m: float
    share: float = 1.0
    label: str = "surface"
    ignore_band_m: float = 1.5
    close_holes_m: float = 0.0
    nodata: str = ""
    hold_out_every: int = 6
    terms: str = ""
    attribution: str = ""

    def __post_init__(self):
        for field, words in (("label", ("surface", "centreline")), ("nodata", ("", "black", "white"))):
            self.require(field, getattr(self, field) in words, f"one of {', '.join(map(repr, words))}")
        for field, least in (("gsd_m", 0.001), ("share", 0), ("ignore_band_m", 0), ("close_holes_m", 0), ("hold_out_every", 0)):
            value = getattr(self, field)
            self.require(field, isinstance(value, (int, float)) and least <= value < math.inf, f"a number of at least {least}")

    def require(self, field, holds, what):
        if not holds:
            raise SystemExit(f"set '{self.name}': {field} is {getattr(self, field)!r}, which must be {what}")


@dataclass
class Level:
    """One pair at one resolution."""

    gsd_m: float
    image: np.ndarray
    label: np.ndarray
    weight: np.ndarray
    another_day: tuple[np.ndarray, np.ndarray] | None = None  # a second picture of the same ground, and the weight there


class Pair:
    """A labelled picture as a pyramid, so that shrinking it never aliases."""

    def __init__(self, options, name, image, mask):
        self.set_name, self.name = options.name, name
        seen = observed(image, options.nodata)
        image[seen == 0] = FILL
        label, weight = label_and_weight(mask, seen, options)
        self.seen = seen > 0
        self.levels = [Level(options.gsd_m, image, label, weight)]
        while self.levels[-1].gsd_m < 0.8 and min(self.levels[-1].image.shape[:2]) > 64:
            self.levels.append(half(self.levels[-1]))

    @property
    def truth(self):
        return (self.levels[0].label > 127) & self.seen

    def level_for(self, gsd_m):
        fitting = [level for level in self.levels if level.gsd_m <= gsd_m * 1.25]
        return fitting[-1] if fitting else self.levels[0]


def half(level):
    height, width = (side // 2 for side in level.image.shape[:2])
    shrink = [cv2.resize(a, (width, height), interpolation=cv2.INTER_AREA) for a in (level.image, level.label, level.weight)]
    return Level(level.gsd_m * 2, *shrink)


def observed(image, nodata):
    """uint8 mask, 1 = seen. Nodata areas are large: single black or white pixels are picture."""
    if not nodata:
        return np.ones(image.shape[:2], np.uint8)
    empty = image.max(2) <= 3 if nodata == "black" else image.min(2) >= 250
    kernel = np.ones((9, 9), np.uint8)
    core = cv2.morphologyEx(empty.astype(np.uint8), cv2.MORPH_OPEN, kernel)
    return 1 - cv2.dilate(core, kernel)


def label_and_weight(mask, seen, options):
    road = (mask > 127).astype(np.uint8)
    if options.close_holes_m > 0:
        size = 2 * int(round(options.close_holes_m / options.gsd_m / 2)) + 1
        road = cv2.morphologyEx(road, cv2.MORPH_CLOSE, np.ones((size, size), np.uint8))
    outside = cv2.distanceTransform(1 - road, cv2.DIST_L2, 3) * options.gsd_m
    inside = cv2.distanceTransform(road, cv2.DIST_L2, 3) * options.gsd_m
    unsure = (road == 0) & (outside < options.ignore_band_m)
    if options.label == "surface":
        # A drawn edge is off by a pixel or two on both sides; the middle of a road stays certain.
        unsure |= (road > 0) & (inside < min(options.ignore_band_m, 1.0) * 0.5)
    weight = seen * np.uint8(255)
    weight[unsure] = 0
    return road * np.uint8(255), weight


def read_sets(manifest, root):
    """SetOptions of a manifest whose folders exist below `root`; missing ones are named and skipped."""
    found = []
    for entry in json.loads(Path(manifest).read_text())["sets"]:
        options = SetOptions(**entry)
        if (Path(root) / options.images).is_dir():
            found.append(options)
        else:
            print(f"skip {options.name}: {Path(root) / options.images} is not there", flush=True)
    return found


def place_of(stem):
    """Pictures of one place on several days (NAME_pre, NAME_post) are held out together."""
    return stem.removesuffix("_pre").removesuffix("_post")


def read_picture(path, flags):
    picture = cv2.imread(str(path), flags)
    if picture is None:
        raise ValueError(f"{path}: this cannot be read as a picture")
    return picture


def load_pairs(options, root):
    """All pairs of a set, in the order of their names, as (training, held-out)."""
    images, masks = Path(root) / options.images, Path(root) / options.masks
    by_stem = {p.stem: p for p in masks.iterdir() if p.suffix.lower() in EXTENSIONS}
    training, held_out = [], []
    paths = sorted(p for p in images.iterdir() if p.suffix.lower() in EXTENSIONS and p.stem in by_stem)
    places = {place: number for number, place in enumerate(sorted({place_of(p.stem) for p in paths}))}
    for path in paths:
        index = places[place_of(path.stem)]
        image = cv2.cvtColor(read_picture(path, cv2.IMREAD_COLOR), cv2.COLOR_BGR2RGB)
        mask = read_picture(by_stem[path.stem], cv2.IMREAD_GRAYSCALE)
        if mask.shape != image.shape[:2]:
            raise ValueError(f"{path}: picture and mask differ in size")
        wanted = options.hold_out_every > 0 and index % options.hold_out_every == options.hold_out_every // 2
        (held_out if wanted else training).append(Pair(options, path.stem, image, mask))
    return training, held_out


def join_days(pairs):
    """Gives each picture the one that shows its place on another day, with no weight where that day did not see the ground."""
    places = {}
    for pair in pairs:
        places.setdefault(place_of(pair.name), []).append(pair)
    for days in places.values():
        for pair, other in zip(days, days[1:] + days[:1]):
            for level, same in zip(pair.levels, other.levels):
                if other is not pair and same.image.shape == level.image.shape:
                    seen = cv2.resize(other.seen * np.uint8(255), level.weight.shape[::-1], interpolation=cv2.INTER_AREA)
                    level.another_day = same.image, np.minimum(level.weight, seen)


def oblique(size, tilt, distance):
    """Homography from the pixels of a camera that looks past the vertical by `tilt`, in radians, to those of one above the
    same middle. `distance` to the ground in the middle of the view, in pixels; ground is taken as flat."""
    cos, sin = math.cos(tilt), math.sin(tilt)
    view = np.array([[distance * cos, 0.0, 0.0], [0.0, distance, 0.0], [0.0, -sin, distance * cos]])
    middle = np.array([[1.0, 0.0, (size - 1) / 2], [0.0, 1.0, (size - 1) / 2], [0.0, 0.0, 1.0]])
    return middle @ view @ np.linalg.inv(middle)


def warp(level, gsd_m, size, angle, flip, centre, view):
    """A square of `size` pixels of `gsd_m` round `centre` (in the level's pixels), turned by `angle` and seen through the
    homography `view` of its pixels: picture, label, weight, and picture and weight of another day or, without one, the same."""
    step = gsd_m / level.gsd_m
    cos, sin = math.cos(angle) * step, math.sin(angle) * step
    matrix = np.array([[cos * flip, -sin, 0.0], [sin * flip, cos, 0.0]])
    middle = (size - 1) / 2
    matrix[:, 2] = np.array(centre) - matrix[:, :2] @ np.array([middle, middle])
    matrix = np.vstack([matrix, [0.0, 0.0, 1.0]]) @ view
    how = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP

    def warped(values, beyond=0):
        return cv2.warpPerspective(values, matrix, (size, size), flags=how, borderValue=beyond)

    def day(picture, weight):
        return warped(picture, (FILL,) * 3), (warped(weight) > 191).astype(np.float32)

    image, weight = day(level.image, level.weight)
    another = day(*level.another_day) if level.another_day else (image, weight)
    return image, warped(level.label).astype(np.float32) / 255, weight, *another


class Crops:
    """Endless augmented crops; crop number i of a seed is always the same one. Augmentation reaches its full strength
    at crop number `ramp`. A crop is a picture with what was seen of it, the same without the augmentation of its colours and
    objects, label and weight; with `twice` also a second picture of this ground, of another day where there is one, with what
    was seen of it and the weight there. uint8, channels first, pictures 0 to 255 and the rest 0 or 1 (labels 0 to 255)."""

    def __init__(self, sets, root, gsd_m, size, seed, ramp=1, twice=False):
        self.gsd_m, self.size, self.seed, self.ramp, self.twice = gsd_m, size, seed, ramp, twice
        self.sets, self.pairs, self.held_out = [], [], []  # sets to train on, the pairs of each, and what is held out of all
        for options in sets:
            training, held_out = load_pairs(options, root)
            if twice:
                join_days(training)
            if training and options.share > 0:
                self.sets.append(options)
                self.pairs.append(training)
            self.held_out += held_out
            print(f"{options.name}: {len(training)} pairs to train on, {len(held_out)} held out", flush=True)
        if not self.pairs:
            raise SystemExit("there is nothing to train on: no set with a share above 0 has pairs that are not held out")
        shares = [options.share for options in self.sets]
        self.shares = np.array(shares) / sum(shares)
        self.areas = [np.array([p.levels[0].weight.mean() * p.seen.size * p.levels[0].gsd_m ** 2 for p in pairs]) for pairs in self.pairs]

    def __len__(self):
        return 1 << 40

    def __getitem__(self, index):
        rng = np.random.default_rng([self.seed, index])
        chosen = int(rng.choice(len(self.pairs), p=self.shares))
        image, label, weight, another, weight_there = self.crop(chosen, self.size, rng)
        strength = min(1.0, 0.2 + index / self.ramp)
        changed, kept, seen = augment.apply(image, label, weight, self.gsd_m, rng, strength)
        clean = image, ~augment.weight_is_unseen(image, weight)
        parts = [changed, seen, *clean, label * 255, kept]
        if self.twice:
            changed, kept, seen = augment.apply(another, label, weight_there, self.gsd_m, rng, WILDER * strength)
            parts += [changed, seen, kept]
        return tuple(map(channels_first, parts))

    def crop(self, chosen, size, rng):
        """A tile that is much smaller than the crop is joined with three others into one."""
        area = self.areas[chosen]
        pair = self.pairs[chosen][int(rng.choice(len(area), p=area / area.sum()))]
        gsd_m = self.gsd_m * math.exp(rng.uniform(math.log(0.7), math.log(1.4)))
        base = pair.levels[0]
        side = min(base.image.shape[:2]) * base.gsd_m / gsd_m
        if side < 0.8 * size and size >= 64 and size % 2 == 0:
            quarters = [self.crop(chosen, size // 2, rng) for _ in range(4)]
            return tuple(join(part) for part in zip(*quarters))
        return self.one_crop(pair, gsd_m, size, rng)

    @staticmethod
    def one_crop(pair, gsd_m, size, rng):
        level = pair.level_for(gsd_m)
        height, width = level.image.shape[:2]
        reach = 0.5 * size * gsd_m / level.gsd_m
        tilt = math.radians(rng.uniform(0, MAX_TILT_DEG)) if rng.random() < 0.4 else 0.0
        view = oblique(size, tilt, size * rng.uniform(0.8, 3.0))
        best = None
        for _ in range(4):
            centre = [rng.uniform(min(reach, s / 2), max(s - reach, s / 2)) for s in (width, height)]
            crop = warp(level, gsd_m, size, rng.uniform(0, 2 * math.pi), rng.choice([-1, 1]), centre, view)
            seen = crop[2].mean()
            if best is None or seen > best[0]:
                best = (seen, crop)
            if seen > 0.6:
                break
        return best[1]


def channels_first(values):
    """uint8; floats are not negative and are rounded."""
    whole = (values + 0.5).astype(np.uint8) if values.dtype.kind == "f" else values.astype(np.uint8)
    return whole[None] if whole.ndim == 2 else np.ascontiguousarray(whole.transpose(2, 0, 1))


def join(quarters):
    top, bottom = np.concatenate(quarters[:2], 1), np.concatenate(quarters[2:], 1)
    return np.concatenate([top, bottom], 0)
