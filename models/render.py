#!/usr/bin/python3
"""Renders labelled pairs to train on: pictures of towns or of open country before and after an earthquake, and masks of their carriageways.

Example: python3 models/render.py --roadfix build/release/cli/roadfix --out build/rendered/train --first-seed 1 --count 60
Writes OUT/images and OUT/masks. Each seed gives two pictures of one place, on two days with their own sun, air and camera.
"""
import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import cv2
import numpy as np
from osgeo import gdal, osr


def with_centre_joined(words):
    """argparse would take -34.9,-56.2 for an option, unless an equals sign joins it to its own."""
    words = list(words)
    if "--centre" in words[:-1]:
        at = words.index("--centre")
        words[at:at + 2] = [f"--centre={words[at + 1]}"]
    return words


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--roadfix", default="build/release/cli/roadfix", help="program that renders (%(default)s)")
    parser.add_argument("--out", required=True, type=Path)
    parser.add_argument("--first-seed", default=1, type=int)
    parser.add_argument("--count", default=60, type=int, help="places (%(default)s)")
    parser.add_argument("--land", choices=("town", "country"), default="town", help="what is rendered (%(default)s)")
    parser.add_argument("--size-km", default="1x1")
    parser.add_argument("--gsd", default=0.5, type=float)
    parser.add_argument("--roads", default="", help="file or folder whose streets are rendered instead of invented ones")
    parser.add_argument("--centre", default="", metavar="LAT,LON", help="of the streets to render")
    return parser.parse_args(with_centre_joined(sys.argv[1:]))


def render(options, seed, folder):
    collapsed = np.random.default_rng(seed).uniform(0.0, 0.35)
    command = [options.roadfix, "world", str(folder), "--seed", str(seed), "--size-km", options.size_km, "--gsd", str(options.gsd),
               "--land", options.land, "--collapsed", f"{collapsed:.2f}", "--frames", "0", "--varied"]
    command += ["--roads", options.roads] if options.roads else []
    command += ["--centre", options.centre] if options.centre else []
    done = subprocess.run(command, check=False, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        raise SystemExit(done.stderr)


def carriageways(truth, picture):
    """uint8 mask, 255 on the carriageway, of the picture's pixels."""
    raster = gdal.Open(str(picture))
    west, step, _, north, _, _ = raster.GetGeoTransform()
    source, target = osr.SpatialReference(), osr.SpatialReference(raster.GetProjection())
    source.ImportFromEPSG(4326)
    for system in (source, target):
        system.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    to_plane = osr.CoordinateTransformation(source, target)
    mask = np.zeros((raster.RasterYSize, raster.RasterXSize), np.uint8)
    for road in json.loads(truth.read_text())["features"]:
        lon_lat = [point[:2] for point in road["geometry"]["coordinates"]]
        points = np.array(to_plane.TransformPoints(lon_lat))[:, :2]
        pixels = (points - [west, north]) / [step, -step] - 0.5
        width = max(1, int(round(road["properties"]["width_m"] / step)))
        cv2.polylines(mask, [np.round(pixels * 16).astype(np.int32)], False, 255, width, cv2.LINE_8, 4)
    return mask


def main():
    options = arguments()
    for part in ("images", "masks"):
        (options.out / part).mkdir(parents=True, exist_ok=True)
    prefix = Path(options.roads).name.split(".")[0] or options.land
    for seed in range(options.first_seed, options.first_seed + options.count):
        with tempfile.TemporaryDirectory() as folder:
            render(options, seed, folder)
            mask = carriageways(Path(folder) / "roads.geojson", Path(folder) / "pre.tif")
            for day in ("pre", "post"):
                name = f"{prefix}-{seed:04d}_{day}"
                picture = cv2.imread(str(Path(folder) / f"{day}.tif"), cv2.IMREAD_COLOR)
                cv2.imwrite(str(options.out / "images" / f"{name}.jpg"), picture, [cv2.IMWRITE_JPEG_QUALITY, 92])
                cv2.imwrite(str(options.out / "masks" / f"{name}.png"), mask)
        print(f"{prefix}-{seed:04d}", flush=True)


if __name__ == "__main__":
    main()
