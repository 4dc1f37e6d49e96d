"""What a disaster, another season and another sensor do to a picture. Works on RGB uint8 crops of known scale.

The label stays: a road under debris, a tent or a shadow is still where it was.
"""
import math

import cv2
import numpy as np


def apply(image, label, weight, gsd_m, rng, strength=1.0):
    """Returns the changed float32 picture (0 to 255), the weights, and what was seen of it (bool).
    `strength` in [0, 1] scales the chance of each change: training starts with few of them."""
    hidden = weight_is_unseen(image, weight)
    out = image.astype(np.float32)
    for chance, change in (
            (0.35, lambda x: objects_on_roads(x, label, gsd_m, rng)),
            (0.20, lambda x: debris(x, label, gsd_m, rng)),
            (0.35, lambda x: block_shadows(x, gsd_m, rng)),
            (0.10, lambda x: blob_shadow(x, rng)),
            (0.75, lambda x: tone(x, rng)),
            (0.15, lambda x: season(x, rng)),
            (0.50, lambda x: colour(x, rng)),
            (0.20, lambda x: haze(x, rng)),
            (0.15, lambda x: sharpen(x, rng)),
            (0.20, lambda x: blur(x, rng)),
            (0.12, lambda x: coarse(x, rng)),
            (0.25, lambda x: noise(x, rng)),
            (0.15, lambda x: jpeg(x, rng))):
        if rng.random() < chance * strength:
            out = change(out).astype(np.float32, copy=False)
            np.clip(out, 0, 255, out=out)
    if rng.random() < 0.15 * strength:
        hide(hidden, rng)
    out[hidden] = 118
    return out.astype(np.float32), weight * ~hidden, ~hidden


def weight_is_unseen(image, weight):
    """Pixels that lie outside the tile (fill colour, no label); an ignore band inside the tile stays picture."""
    return (weight == 0) & (cv2.inRange(image, (118,) * 3, (118,) * 3) > 0)


def hide(hidden, rng):
    """An unobserved corner or border, as a rotated frame has."""
    size = hidden.shape[0]
    angle, reach = rng.uniform(0, 2 * math.pi), rng.uniform(0.15, 0.5) * size
    y, x = np.mgrid[:size, :size] - size / 2
    hidden |= x * math.cos(angle) + y * math.sin(angle) > reach


def smooth_field(size, cells, rng):
    """A random field in [0, 1] that varies over size / cells pixels."""
    return cv2.resize(rng.random((cells, cells), dtype=np.float32), (size, size), interpolation=cv2.INTER_CUBIC).clip(0, 1)


def tone(image, rng):
    x = image / 255.0
    x = np.power(np.clip(x, 0, 1), math.exp(rng.uniform(-0.5, 0.5)))
    x = (x - x.mean()) * math.exp(rng.uniform(-0.5, 0.5)) + x.mean()
    return (x + rng.uniform(-0.15, 0.15)) * 255


def season(image, rng):
    """What is green becomes dry and brown, or greener and darker."""
    green = np.clip(image[:, :, 1:2] - 0.5 * (image[:, :, :1] + image[:, :, 2:]), 0, None)
    return image + green * rng.uniform(-1.0, 2.0) * np.array([1.0, -0.4, 0.2], np.float32)


def colour(image, rng):
    grey = image.mean(2, keepdims=True)
    kind = rng.random()
    if kind < 0.3:
        return np.repeat(grey, 3, 2)
    if kind < 0.4:
        return image[:, :, rng.permutation(3)]
    cast = np.exp(rng.uniform(-0.25, 0.25, 3)).astype(np.float32)
    return (grey + (image - grey) * rng.uniform(0.3, 1.6)) * cast


def haze(image, rng):
    """Dust or haze: a light, often brownish veil of varying thickness."""
    veil = np.array([rng.uniform(150, 235)] * 3, np.float32) - np.array([0, rng.uniform(0, 25), rng.uniform(0, 60)], np.float32)
    field = smooth_field(image.shape[0], int(rng.integers(2, 6)), rng)[:, :, None]
    thickness = rng.uniform(0.1, 0.6) * (0.4 + 0.6 * field)
    return image * (1 - thickness) + veil * thickness


def blur(image, rng):
    if rng.random() < 0.6:
        return cv2.GaussianBlur(image, (0, 0), rng.uniform(0.4, 1.4))
    length = int(rng.integers(2, 6))
    kernel = np.zeros((length, length), np.float32)
    kernel[length // 2, :] = 1.0 / length
    if rng.random() < 0.5:
        kernel = kernel.T.copy()
    return cv2.filter2D(image, -1, kernel)


def sharpen(image, rng):
    """The unsharp mask of a sensor's processing, or on larger scales the evened light of a mosaic."""
    base = cv2.GaussianBlur(image, (0, 0), math.exp(rng.uniform(math.log(0.7), math.log(12))))
    return image + (image - base) * rng.uniform(0.3, 1.5)


def coarse(image, rng):
    """Detail of a sensor of up to twice the ground sample distance."""
    size = image.shape[0]
    small = max(8, int(size / rng.uniform(1.2, 2.2)))
    shrunk = cv2.resize(image, (small, small), interpolation=cv2.INTER_AREA)
    return cv2.resize(shrunk, (size, size), interpolation=cv2.INTER_LINEAR)


def noise(image, rng):
    field = rng.standard_normal(image.shape[:2] + (1 if rng.random() < 0.5 else 3,), dtype=np.float32)
    return image + field * rng.uniform(0.03, 0.2) * image.std()


def jpeg(image, rng):
    _, data = cv2.imencode(".jpg", image.astype(np.uint8), [cv2.IMWRITE_JPEG_QUALITY, int(rng.integers(40, 90))])
    return cv2.imdecode(data, cv2.IMREAD_COLOR).astype(np.float32)


def darken(image, mask, rng):
    """Multiplies by a shadow's colour (bluish: it is lit by the sky) where mask, in [0, 1], is set."""
    mask = cv2.GaussianBlur(mask, (0, 0), rng.uniform(0.5, 1.5))[:, :, None]
    shade = rng.uniform(0.2, 0.65) * np.array([1.0, rng.uniform(1.0, 1.08), rng.uniform(1.0, 1.2)], np.float32)
    return image * (1 - mask + mask * shade)


def block_shadows(image, gsd_m, rng):
    """Rows of buildings and their shadows, all in one direction; the gaps between look like streets and are none."""
    size = image.shape[0]
    mask = np.zeros((size, size), np.float32)
    sun, along = rng.uniform(0, 2 * math.pi), rng.uniform(0, math.pi)
    length = rng.uniform(5, 45) / gsd_m
    throw = np.array([math.cos(sun), math.sin(sun)]) * length
    axis = np.array([math.cos(along), math.sin(along)])
    start = rng.uniform(0, size, 2)
    roofs = []
    for row in range(int(rng.integers(1, 4))):
        place = start + np.array([-axis[1], axis[0]]) * row * rng.uniform(25, 70) / gsd_m
        for _ in range(int(rng.integers(1, 6))):
            side = rng.uniform(8, 30, 2) / gsd_m / 2
            box = cv2.boxPoints((tuple(place), tuple(2 * side), math.degrees(along)))
            cast = cv2.convexHull(np.concatenate([box, box + throw]).astype(np.float32))
            cv2.fillConvexPoly(mask, cast.astype(np.int32), 1.0)
            roofs.append(box.astype(np.int32))
            place = place + axis * (2 * side[0] + rng.uniform(3, 25) / gsd_m)
    for box in roofs:
        cv2.fillConvexPoly(mask, box, 0.0)  # the roof itself keeps the picture
    return darken(image, mask, rng)


def blob_shadow(image, rng):
    """A cloud's or a tree belt's shadow of no particular shape."""
    size = image.shape[0]
    field = smooth_field(size, int(rng.integers(3, 12)), rng)
    return darken(image, (field > rng.uniform(0.55, 0.8)).astype(np.float32), rng)


def road_points(label, count, rng):
    rows, cols = np.nonzero(label > 0.5)
    if len(rows) == 0:
        return []
    chosen = rng.integers(0, len(rows), count)
    return np.stack([cols[chosen], rows[chosen]], 1).astype(np.float32)


def objects_on_roads(image, label, gsd_m, rng):
    """Cars, trucks and tents: bright or dark rectangles, most of them on roads."""
    out = image.copy()
    for place in road_points(label, int(rng.integers(3, 60)), rng):
        if rng.random() < 0.25:
            place = rng.uniform(0, image.shape[0], 2)
        kind = rng.random()
        extent = (2.0, 4.5) if kind < 0.6 else (2.6, rng.uniform(7, 15)) if kind < 0.85 else (rng.uniform(4, 7), rng.uniform(5, 9))
        tint = rng.uniform(0, 255) + rng.uniform(-25, 25, 3)
        box = cv2.boxPoints((tuple(map(float, place)), tuple(e / gsd_m for e in extent), rng.uniform(0, 180)))
        cv2.fillConvexPoly(out, (box * 8).astype(np.int32), tuple(map(float, tint)), cv2.LINE_AA, 3)
    return out


def debris(image, label, gsd_m, rng):
    """Rubble that spills over parts of roads: rough, grey to brown, as bright as the scene."""
    size = image.shape[0]
    mask = np.zeros((size, size), np.float32)
    for place in road_points(label, int(rng.integers(1, 8)), rng):
        count, reach = int(rng.integers(5, 10)), rng.uniform(4, 18) / gsd_m
        turns = np.sort(rng.uniform(0, 2 * math.pi, count))
        away = reach * rng.uniform(0.4, 1.0, count)
        outline = place + np.stack([np.cos(turns), np.sin(turns)], 1) * away[:, None]
        cv2.fillPoly(mask, [outline.astype(np.int32)], 1.0)
    mask = cv2.GaussianBlur(mask, (0, 0), 1.0)[:, :, None] * rng.uniform(0.5, 1.0)
    rough = cv2.GaussianBlur(rng.standard_normal((size, size), dtype=np.float32), (0, 0), rng.uniform(0.6, 1.6))
    rough = rough / (rough.std() + 1e-6) * rng.uniform(15, 45)
    base = image.mean() * rng.uniform(0.8, 1.4) + np.array([8, 0, -10], np.float32) * rng.uniform(0, 2)
    return image * (1 - mask) + (base + rough[:, :, None]) * mask
