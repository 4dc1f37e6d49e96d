#!/usr/bin/python3
"""Training from a user's own folder, resuming, exporting and running by OpenCV, on pairs drawn here; half a minute.

Skips (exit 77) where torch or OpenCV for Python is not installed.
"""
import io
import json
import runpy
import shutil
import subprocess
import sys
import tempfile
import unittest
from contextlib import redirect_stdout
from pathlib import Path
from unittest import mock

from with_torch import MODELS

import cv2
import numpy as np
import torch
import train
from roadnet import augment, checkpoints, data, export, losses, metrics, network, unfold


def draw_pairs(folder, count=8, size=160):
    """Bright straight roads on dark noise."""
    rng = np.random.default_rng(5)
    for part in ("images", "masks"):
        (folder / part).mkdir(parents=True)
    for number in range(count):
        mask = np.zeros((size, size), np.uint8)
        for _ in range(3):
            ends = rng.integers(0, size, 4).tolist()
            cv2.line(mask, ends[:2], ends[2:], 255, 8)
        image = rng.normal(70, 12, (size, size, 3)) + 110.0 * (mask[:, :, None] > 0)
        cv2.imwrite(str(folder / "images" / f"{number}.png"), image.clip(0, 255).astype(np.uint8))
        cv2.imwrite(str(folder / "masks" / f"{number}.png"), mask)


def arguments_of(script, *arguments):
    return [sys.executable, str(MODELS / script), *map(str, arguments)]


def run(script, *arguments):
    """What the script prints, run in this process: it need not load torch."""
    with mock.patch.object(sys, "argv", list(map(str, (script, *arguments)))), redirect_stdout(io.StringIO()) as said:
        runpy.run_path(str(MODELS / script), run_name="__main__")
    return said.getvalue()


def f1_of(checkpoint, folder):
    """Of the exported network on the pairs in folder/pairs."""
    sets, model = folder / "sets.json", checkpoint.with_suffix(".onnx")
    sets.write_text(json.dumps({"sets": [{"name": "own", "images": "pairs/images", "masks": "pairs/masks", "gsd_m": 1.0}]}))
    run("export.py", "--checkpoint", checkpoint, "--out", model, "--data", folder, "--sets", sets)
    report = run("evaluate.py", "--model", model, "--data", folder, "--sets", sets, "--evaluation-sets", sets)
    return float(report.split("| own |")[1].split("|")[2])


class Training(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.folder = Path(place.name)
        draw_pairs(self.folder / "pairs")

    def command(self, pairs, out, *more):
        return ("train.py", "--pairs", f"{self.folder / pairs}=1.0", "--only-pairs", "--out", self.folder / out, "--size", 96,
                "--batch", 4, "--save-every", 10, "--validate-every", 1000, "--threads", 1, "--device", "cpu",
                "--widths", 8, 12, 20, 28, *more)

    def describe(self, pairs, **options):
        sets = [{"name": "own", "images": "images", "masks": "masks", "gsd_m": 0.5, "nodata": "black", **options}]
        (self.folder / pairs / "pairs.json").write_text(json.dumps({"sets": sets}))

    def train(self, pairs, out, *more):
        return run(*self.command(pairs, out, *more))

    def kill_after(self, step, *command):
        with subprocess.Popen(arguments_of(*command), stdout=subprocess.PIPE, text=True) as process:
            for line in process.stdout:
                if line.startswith(f"step {step}/"):
                    process.kill()

    def test_pairs_that_roadfix_wrote_say_their_scale_and_the_command_their_share(self):
        self.describe("pairs")
        folder = self.folder / "pairs"
        for told, share in ((folder, 1.0), (f"{folder}:0.3", 0.3)):
            [found] = train.own_sets([str(told)])
            self.assertEqual((found.gsd_m, found.nodata, found.share), (0.5, "black", share))
            self.assertEqual(len(data.load_pairs(found, self.folder / "elsewhere")[0]), 7, "one of six is held out")

    def test_a_scale_that_is_told_too_leaves_unseen_what_roadfix_wrote_as_unseen(self):
        self.describe("pairs")
        folder = self.folder / "pairs"
        [found] = train.own_sets([f"{folder}=0.5:0.2"])
        self.assertEqual((found.gsd_m, found.nodata, found.share), (0.5, "black", 0.2))
        with self.assertRaisesRegex(SystemExit, "pairs.json says .* 0.5 m per pixel"):
            list(train.own_sets([f"{folder}=1.5:0.2"]))

    def test_a_scale_of_pairs_that_nobody_described_is_as_the_command_says(self):
        [found] = train.own_sets([f"{self.folder / 'pairs'}=1.5:0.2"])
        self.assertEqual((found.gsd_m, found.nodata, found.share), (1.5, "", 0.2))

    def test_a_folder_of_pairs_may_be_called_as_one_likes(self):
        for name in ("scale=2", "scale=2:1"):
            shutil.copytree(self.folder / "pairs", self.folder / name)
            self.describe(name)
            [found] = train.own_sets([str(self.folder / name)])
            self.assertEqual((found.gsd_m, found.share), (0.5, 1.0))

    def test_what_is_no_number_in_the_pairs_of_the_command_is_named(self):
        for told in ("=half", "=0.5:much", ":much"):
            self.describe("pairs")
            with self.assertRaisesRegex(SystemExit, "(half|much)' is no number"):
                list(train.own_sets([f"{self.folder / 'pairs'}{told}"]))

    def test_pairs_without_a_scale_are_refused(self):
        for told, message in ((self.folder / "pairs", "pairs.json"), (self.folder / "absent", "no folder")):
            with self.assertRaisesRegex(SystemExit, message):
                list(train.own_sets([str(told)]))

    def test_a_users_own_pairs_become_a_network_that_opencv_runs(self):
        self.train("pairs", "run", "--steps", 30, "--ramp", 1000000)
        self.assertIn("resume from", self.train("pairs", "run", "--steps", 60, "--ramp", 1000000))
        self.assertGreater(f1_of(self.folder / "run/checkpoint.pt", self.folder), 0.5)

    def test_a_run_without_held_out_pairs_tells_no_figures_of_them(self):
        self.describe("pairs", gsd_m=1.0, hold_out_every=0)
        said = self.train("pairs", "run", "--steps", 1)
        self.assertIn("8 pairs to train on, 0 held out", said)
        self.assertNotIn("precision", said)

    def test_a_pupil_learns_from_its_teacher_what_no_label_says(self):
        shutil.copytree(self.folder / "pairs", self.folder / "unlabelled")
        for mask in (self.folder / "unlabelled/masks").iterdir():
            cv2.imwrite(str(mask), np.zeros_like(cv2.imread(str(mask), cv2.IMREAD_GRAYSCALE)))
        teacher = self.folder / "teacher/checkpoint.pt"
        self.train("pairs", "teacher", "--steps", 60, "--ramp", 1000000)
        self.assertGreater(f1_of(teacher, self.folder), 0.5)
        self.train("unlabelled", "pupil", "--steps", 60, "--ramp", 1000000, "--teacher", teacher, "--trust", 1, "--seed", 2)
        self.assertGreater(f1_of(self.folder / "pupil/checkpoint.pt", self.folder), 0.5)
        for beginning in (teacher, teacher.with_suffix(".onnx")):
            self.train("unlabelled", "heir", "--steps", 1, "--restart", "--begin-with", beginning)
            self.assertGreater(f1_of(self.folder / "heir/checkpoint.pt", self.folder), 0.5)

    def test_a_killed_run_ends_as_if_it_had_not_been_killed(self):
        teacher = self.folder / "teacher/checkpoint.pt"
        self.train("pairs", "teacher", "--steps", 10)
        options = ("--steps", 20, "--report", 1, "--teacher", teacher, "--align", 0.5)
        self.train("pairs", "whole", *options)
        self.kill_after(13, *self.command("pairs", "killed", *options))
        self.assertIn("at step 10", self.train("pairs", "killed", *options))
        whole, killed = (torch.load(self.folder / out / "checkpoint.pt") for out in ("whole", "killed"))
        for name, value in whole["averaged"].items():
            torch.testing.assert_close(killed["averaged"][name], value, rtol=0, atol=0)

    def test_a_run_that_differs_in_what_it_learns_or_how_is_not_gone_on_with(self):
        def train_on(pairs, *more):
            arguments = [*self.command(pairs, "run", "--steps", 1, "--report", 1), *more]
            with mock.patch.object(sys, "argv", list(map(str, arguments))):
                train.main()

        train_on("pairs")
        checkpoint = self.folder / "run/checkpoint.pt"
        for option, value in (("seed", 2), ("gsd", 0.8), ("batch", 2), ("size", 64), ("rate", 1e-3), ("cool", 0.5), ("ramp", 9),
                              ("trust", 1), ("align", 1.6), ("begin_with", checkpoint), ("teacher", checkpoint)):
            with self.subTest(option), self.assertRaisesRegex(SystemExit, f"{option}.*, not .*--restart"):
                train_on("pairs", "--" + option.replace("_", "-"), value)
        for pairs, what in (("others", "sets"), ("elsewhere/pairs", "set 1")):
            shutil.copytree(self.folder / "pairs", self.folder / pairs)
            with self.subTest(what), self.assertRaisesRegex(SystemExit, f"{what} .*, not .*--restart"):
                train_on(pairs)
        train_on("pairs", "--report", 5, "--save-every", 5)

class Parts(unittest.TestCase):
    def test_the_same_seed_and_number_give_the_same_crop(self):
        with tempfile.TemporaryDirectory() as place:
            draw_pairs(Path(place) / "pairs")
            options = data.SetOptions("own", "pairs/images", "pairs/masks", 0.5)
            crops = [data.Crops([options], place, 1.0, 64, 3) for _ in range(2)]
            for one, other in zip(crops[0][17], crops[1][17]):
                np.testing.assert_array_equal(one, other)

    def test_a_picture_or_mask_that_cannot_be_read_is_named(self):
        options = data.SetOptions("own", "pairs/images", "pairs/masks", 1.0)
        for broken in ("pairs/images/1.png", "pairs/masks/1.png"):
            with tempfile.TemporaryDirectory() as place:
                draw_pairs(Path(place) / "pairs", count=2, size=32)
                (Path(place) / broken).write_bytes(b"\x89PNG")
                with self.assertRaisesRegex(ValueError, f"{broken}: .* cannot be read"):
                    data.load_pairs(options, place)

    def test_a_set_with_a_wrong_word_or_number_is_refused_by_set_and_field(self):
        for field, value in (("label", "Surface"), ("nodata", "Black"), ("gsd_m", 0.0), ("gsd_m", float("nan")), ("share", -1.0),
                             ("share", "1"), ("ignore_band_m", -3), ("close_holes_m", -1.0), ("hold_out_every", -1)):
            with self.assertRaisesRegex(SystemExit, f"'own': {field} is {value!r}"):
                data.SetOptions(**{"name": "own", "images": "", "masks": "", "gsd_m": 1.0, field: value})

    def test_sets_of_which_nothing_is_left_to_train_on_are_refused(self):
        with tempfile.TemporaryDirectory() as place:
            draw_pairs(Path(place) / "pairs", count=2, size=32)
            for field, value in (("hold_out_every", 1), ("share", 0)):
                options = data.SetOptions("own", "pairs/images", "pairs/masks", 1.0, **{field: value})
                with self.assertRaisesRegex(SystemExit, "nothing to train on"):
                    data.Crops([options], place, 1.0, 64, 3)

    def test_the_band_round_a_centreline_is_ignored_and_its_middle_is_road(self):
        mask = np.zeros((60, 60), np.uint8)
        mask[28:32] = 255
        options = data.SetOptions("own", "", "", 1.0, label="centreline", ignore_band_m=3.5)
        label, weight = data.label_and_weight(mask, np.ones_like(mask), options)
        self.assertTrue((label[29] == 255).all() and (weight[29] == 255).all())
        self.assertTrue((weight[26] == 0).all())
        self.assertTrue((weight[20] == 255).all() and (label[20] == 0).all())

    def test_an_oblique_view_is_where_its_rays_meet_the_ground(self):
        tilt, distance, middle = np.radians(15.0), 200.0, 96.0
        view = data.oblique(193, tilt, distance)
        for u, v in ((0, 0), (50, -70), (-96, 96)):
            ray = np.array([u, v * np.cos(tilt) + distance * np.sin(tilt), distance * np.cos(tilt) - v * np.sin(tilt)])
            ground = ray[:2] * distance * np.cos(tilt) / ray[2] - [0.0, distance * np.sin(tilt)]
            seen = view @ [u + middle, v + middle, 1.0]
            np.testing.assert_allclose(seen[:2] / seen[2] - middle, ground, atol=1e-9)

    def test_augmentation_leaves_what_was_not_seen_at_the_fill(self):
        image = np.full((64, 64, 3), 60, np.uint8)
        image[:, :20] = data.FILL
        weight = np.ones((64, 64), np.float32)
        weight[:, :20] = 0
        for seed in range(20):
            changed, after, _ = augment.apply(image, (image[:, :, 0] > 200).astype(np.float32), weight, 1.0,
                                           np.random.default_rng(seed))
            self.assertTrue((changed[:, :20] == data.FILL).all())
            self.assertTrue((after[:, :20] == 0).all())

    def test_the_loss_ignores_cells_without_a_label(self):
        logits = torch.randn(1, 1, 8, 8)
        label, weight = torch.zeros(1, 1, 16, 16), torch.ones(1, 1, 16, 16)
        label[:, :, 4:8] = 1
        weight[:, :, 12:] = 0
        other = logits.clone()
        other[:, :, 6:] = 30
        self.assertAlmostEqual(losses.road_loss(logits, label, weight).item(), losses.road_loss(other, label, weight).item(), 5)

    def test_a_teacher_is_asked_in_every_orientation_and_answers_in_the_pictures_own(self):
        asked = []

        def teacher(picture):
            asked.append(picture.flatten().tolist())
            return torch.nn.functional.avg_pool2d(picture, 2)

        picture, turns = torch.randn(1, 1, 8, 8), torch.Generator().manual_seed(1)
        for _ in range(100):
            answer = losses.in_a_random_orientation(teacher, picture, turns)
            torch.testing.assert_close(answer, torch.nn.functional.avg_pool2d(picture, 2))
        self.assertEqual(len({tuple(values) for values in asked}), 8)

    def test_the_mean_of_weights_lies_half_way_between_two_networks(self):
        with tempfile.TemporaryDirectory() as place:
            paths = [Path(place) / name for name in ("a.pt", "b.pt")]
            members = [network.RoadNet() for _ in paths]
            for path, member in zip(paths, members):
                torch.save({"averaged": member.state_dict(), "widths": member.widths}, path)
            mean = checkpoints.mean_of_weights(paths)
            torch.testing.assert_close(mean.head.weight, (members[0].head.weight + members[1].head.weight) / 2)
            torch.testing.assert_close(checkpoints.mean_of_weights(paths[:1]).state_dict(), members[0].state_dict())

    def test_what_is_no_network_is_named(self):
        with tempfile.TemporaryDirectory() as place:
            text, other = Path(place) / "text.pt", Path(place) / "other.pt"
            text.write_text("no network")
            torch.save([1, 2], other)
            for path, message in ((Path(place) / "absent.pt", "no such file"), (Path(place) / "absent.onnx", "no such file"),
                                  (text, "no checkpoint"), (other, "no checkpoint")):
                with self.assertRaisesRegex(SystemExit, f"{path}.*{message}"):
                    checkpoints.read_network([path])

    def test_an_exported_network_comes_back_and_answers_alike_while_it_learns(self):
        torch.manual_seed(1)
        trained, pictures = network.RoadNet((8, 12, 16, 20)), torch.randn(16, 3, 64, 64)
        for module in trained.modules():
            if isinstance(module, torch.nn.BatchNorm2d):
                torch.nn.init.uniform_(module.bias, -0.5, 0.5)
                torch.nn.init.uniform_(module.running_var, 0.5, 2.0)
        with tempfile.TemporaryDirectory() as place, torch.no_grad():
            export.export(trained, 1.0, Path(place) / "net.onnx", "net")
            back = unfold.read_onnx(Path(place) / "net.onnx")
            wanted = trained.eval()(pictures)
            torch.testing.assert_close(back(pictures), wanted, rtol=1e-4, atol=1e-4)
            unfold.settle(back, pictures)
            torch.testing.assert_close(back(pictures), wanted, rtol=1e-3, atol=1e-3)
            torch.testing.assert_close(back.train()(pictures), wanted, rtol=1e-2, atol=1e-2)

    def test_a_teacher_is_not_heard_where_the_pupil_saw_nothing(self):
        logits, taught, picture = torch.randn(1, 1, 8, 8), torch.randn(1, 1, 8, 8), torch.ones(1, 3, 16, 16)
        picture[:, :, 12:] = 0
        other = taught.clone()
        other[:, :, 6:] = 30
        self.assertEqual(losses.distillation_loss(logits, taught, picture).item(), losses.distillation_loss(logits, other, picture).item())

    def test_precision_and_recall_bear_a_shift_within_the_tolerance_only(self):
        truth = np.zeros((50, 50), bool)
        truth[20:24] = True
        seen = np.ones_like(truth)
        near = metrics.relaxed_counts(np.roll(truth, 3, 0), truth, seen, 3.0, 1.0)
        far = metrics.relaxed_counts(np.roll(truth, 12, 0), truth, seen, 3.0, 1.0)
        self.assertEqual((near.precision, near.recall, far.precision, far.recall), (1.0, 1.0, 0.0, 0.0))


if __name__ == "__main__":
    unittest.main()
