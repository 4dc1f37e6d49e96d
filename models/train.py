#!/usr/bin/python3
"""Trains Roadfix's road network from labelled pairs.

Example: nice python3 models/train.py --data ../shared/data --out build/roadnet --steps 3000
A run that was interrupted goes on from its last checkpoint when the same command is given again.
"""
import argparse
from dataclasses import replace
from pathlib import Path

import cv2
import torch

from roadnet.data import Crops, SetOptions, read_sets
from roadnet.network import SMALL
from roadnet.training import train


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    here = Path(__file__).resolve().parent
    parser.add_argument("--data", default=here.parent / "../shared/data", type=Path, help="folder that the manifest's paths start from")
    parser.add_argument("--sets", default=here / "datasets.json", type=Path, help="manifest of sets (%(default)s)")
    parser.add_argument("--pairs", action="append", default=[], metavar="DIR[=GSD_M][:SHARE]",
                        help="own pairs: DIR/images and DIR/masks with equal file stems, and their share of the crops "
                             "(against those of the manifest); may be given again. Of a folder that roadfix pairs wrote "
                             "pairs.json says the scale and what was not seen")
    parser.add_argument("--only-pairs", action="store_true", help="train on --pairs alone")
    parser.add_argument("--out", default=Path("build/roadnet"), type=Path, help="folder for checkpoints (%(default)s)")
    parser.add_argument("--begin-with", type=Path, metavar="FILE", help="weights of a checkpoint or of an exported network (.onnx) instead of random ones")
    parser.add_argument("--teacher", type=Path, nargs="+", default=[], metavar="FILE",
                        help="learn too what the mean of these networks says of the crops before augmentation, in any "
                             "orientation: one network that answers like several in all of them")
    parser.add_argument("--trust", default=0.5, type=float, help="share of the loss that is the teacher's, the rest is the labels' (%(default)s)")
    parser.add_argument("--align", default=0.0, type=float, metavar="WEIGHT",
                        help="learn too from a second picture of each crop's ground, and that a part of it agrees with the "
                             "crop at its own place alone; weight of that loss (%(default)s)")
    parser.add_argument("--steps", default=3000, type=int)
    parser.add_argument("--minutes", default=0.0, type=float, help="stop after this time if the steps are not done; 0 = no limit")
    parser.add_argument("--batch", default=8, type=int)
    parser.add_argument("--widths", default=SMALL, type=int, nargs=4, metavar="CHANNELS",
                        help="channels of the network's four levels; more learn more and take longer (%(default)s)")
    parser.add_argument("--size", default=192, type=int, help="side of a crop in pixels, a multiple of 32 (%(default)s)")
    parser.add_argument("--gsd", default=1.0, type=float, help="metres per pixel that the network sees (%(default)s)")
    parser.add_argument("--rate", default=1.5e-3, type=float, help="peak learning rate (%(default)s)")
    parser.add_argument("--cool", default=0.3, type=float, help="share of the steps (or minutes) over which the rate falls to zero")
    parser.add_argument("--ramp", default=1500, type=int, help="steps until augmentation has its full strength (%(default)s)")
    parser.add_argument("--seed", default=1, type=int)
    parser.add_argument("--device", default="cuda" if torch.cuda.is_available() else "cpu")
    parser.add_argument("--threads", default=2, type=int, help="CPU threads for the network")
    parser.add_argument("--workers", default=0, type=int, help="processes that prepare crops; 0 = in this one")
    parser.add_argument("--bf16", action="store_true", help="half precision where the processor has it: about twice as fast")
    parser.add_argument("--restart", action="store_true", help="ignore an earlier checkpoint in --out")
    parser.add_argument("--report", default=20, type=int, help="steps between lines of progress")
    parser.add_argument("--save-every", default=100, type=int)
    parser.add_argument("--validate-every", default=300, type=int)
    return parser.parse_args()


def described_sets(folder):
    """Of a folder that roadfix pairs wrote."""
    manifest = folder / "pairs.json"
    if not manifest.is_file():
        raise SystemExit(f"--pairs {folder}: there is no {manifest}, which roadfix pairs writes; of other pairs write "
                         "DIR=GSD_M or DIR=GSD_M:SHARE, for example my-pairs=0.5")
    for options in read_sets(manifest, folder):
        yield replace(options, images=str(folder / options.images), masks=str(folder / options.masks))


def parts_of(text):
    """Folder, scale and share of --pairs; empty where they are not told."""
    if Path(text).is_dir():
        return text, "", ""
    folder, told, rest = text.rpartition("=")
    if told:
        gsd, _, share = rest.partition(":")
        return folder, gsd, share
    folder, _, share = text.rpartition(":")
    return folder or text, "", share


def number(text, told):
    try:
        return float(told)
    except ValueError:
        raise SystemExit(f"--pairs {text}: '{told}' is no number; write DIR, DIR:SHARE, DIR=GSD_M or DIR=GSD_M:SHARE") from None


def sets_of(text, folder, gsd):
    """As pairs.json says where there is one: by the scale alone, what is black in its pictures would count as seen."""
    if not gsd:
        return list(described_sets(folder))
    gsd_m = number(text, gsd)
    if not (folder / "pairs.json").is_file():
        return [SetOptions(name=folder.name, images=str(folder / "images"), masks=str(folder / "masks"), gsd_m=gsd_m, ignore_band_m=1.0)]
    sets = list(described_sets(folder))
    for options in sets:
        if options.gsd_m != gsd_m:
            raise SystemExit(f"--pairs {text}: {folder / 'pairs.json'} says that its pictures have {options.gsd_m} m per pixel: "
                             "leave the scale out")
    return sets


def own_sets(texts):
    for text in texts:
        folder, gsd, share = parts_of(text)
        folder = Path(folder).resolve()
        for part in ("images", "masks"):
            if not (folder / part).is_dir():
                raise SystemExit(f"--pairs {text}: there is no folder {folder / part}")
        for options in sets_of(text, folder, gsd):
            yield replace(options, share=number(text, share)) if share else options


def main():
    options = arguments()
    if options.size % 32:
        raise SystemExit("--size must be a multiple of 32")
    torch.set_num_threads(options.threads)
    cv2.setNumThreads(1)
    options.out.mkdir(parents=True, exist_ok=True)
    sets = [] if options.only_pairs else read_sets(options.sets, options.data)
    sets += own_sets(options.pairs)
    if not sets:
        raise SystemExit(f"no pairs found below {options.data}; name your own with --pairs DIR=GSD_M")
    train(Crops(sets, options.data, options.gsd, options.size, options.seed, options.ramp * options.batch, options.align > 0), options)


if __name__ == "__main__":
    main()
