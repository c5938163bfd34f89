#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""The detector's training from end to end on a few small views: the loss falls, a stopped training goes on, its curves are drawn,
and the exported network says what the trained one says.

    training_test.py ROOMGRAPH FOLDER_OF_TRAINING
"""
import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM, TRAINING = Path(sys.argv[1]), Path(sys.argv[2])
sys.path.insert(0, str(TRAINING))


def call(*command):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    if done.returncode:
        raise AssertionError(f"{command}: {done.stderr}")
    return done.stdout


class Training(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.at = Path(cls.folder.name)
        for name, flats in (("views", "10000-10002"), ("check", "10003-10003")):
            call(PROGRAM, "training-set", "-o", cls.at / name, "--flats", flats, "--views", 24, "--size", "128x96", "--quiet")
        cls.train(10)
        cls.train(100)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def train(cls, steps):
        cls.said = call(sys.executable, TRAINING / "train.py", "--views", cls.at / "views", "--check", cls.at / "check", "--out", cls.at / "out",
                        "--steps", steps, "--batch", 8, "--threads", 1, "--textures", 0.3, "--floors", 0.1)

    def test_the_loss_falls_and_a_stopped_training_goes_on(self):
        first, last = (json.loads(line) for line in (self.at / "out" / "log.jsonl").read_text().splitlines())
        self.assertIn(f"goes on from {first['steps']} steps", self.said)
        self.assertEqual([first["steps"], last["steps"]], [10, 100])
        self.assertLess(last["places"], 0.9 * first["places"])
        self.assertLess(last["kinds"] + last["places"], 0.95 * (first["kinds"] + first["places"]))

    def test_views_in_one_array_are_those_of_the_folders(self):
        import data
        import numpy
        apart = data.Views([self.at / "views", self.at / "check"])
        joined = data.Views([self.at / "views"], joined=True)
        joined.patterns.append(str(self.at / "check"))
        self.assertEqual(joined.refresh(), 1)
        self.assertEqual([len(apart.arrays), len(joined.arrays)], [2, 1])
        numbers = numpy.arange(len(apart))
        order = sorted(numbers, key=lambda i: apart.array[i] == 0)  # "check" comes first in a sorted list, and last where it is added
        for one, other in zip(apart.batch(order), joined.batch(numbers)):
            self.assertTrue((one.nan_to_num(9) == other.nan_to_num(9)).all())

    def test_other_textures_keep_the_edges_and_other_floors_the_holes(self):
        import augment
        import data
        import numpy
        import torch
        views = data.Views([self.at / "views"])
        pictures, boxes = views.batch(range(12))
        random = numpy.random.default_rng(1)
        textured = augment.textured(pictures[:, data.COLOR], random)
        self.assertGreater(float((textured - pictures[:, data.COLOR]).abs().mean()), 0.02)
        step = torch.zeros(1, 3, 40, 40)
        step[..., 20:] = 0.8
        seen = augment.textured(step.expand(20, -1, -1, -1), random)
        self.assertLess(float((seen[..., 2:17] - seen[..., 1:16]).abs().max()), 1e-4)  # level on both sides of the edge, whatever the filter
        self.assertLess(float((seen[..., 24:38] - seen[..., 23:37]).abs().max()), 1e-4)
        self.assertGreater(float((seen[..., 10] - seen[..., 30]).abs().mean()), 0.1)
        every = numpy.ones(12, bool)
        lowered = augment.lowered(pictures, every, random)
        others = [k for k in range(6) if k != data.HEIGHT]
        self.assertTrue((lowered[:, others] == pictures[:, others]).all())
        before, after = pictures[:, data.HEIGHT], lowered[:, data.HEIGHT]
        self.assertTrue(((before == 0) == (after == 0)).all())
        high = before > 100 / 255
        shift = ((before - after) * 255 / data.HEIGHT_STEPS_PER_M)[high]  # m
        self.assertGreater(float(shift.min()), 0.19)
        self.assertLess(float(shift.max()), 0.91)
        self.assertTrue((augment.lowered(pictures, ~every, random) == pictures).all())

    def test_the_mean_of_weights(self):
        import export
        import torch
        a, b = {"w": torch.tensor([1.0, 4.0]), "n": torch.tensor(3)}, {"w": torch.tensor([2.0, 0.0]), "n": torch.tensor(5)}
        mean = export.mean_weights([a, b])
        self.assertEqual(mean["w"].tolist(), [1.5, 2.0])
        self.assertEqual(int(mean["n"]), 5)
        self.assertEqual(export.mean_weights([a])["w"].tolist(), [1.0, 4.0])

    def test_curves_are_drawn(self):
        call(sys.executable, TRAINING / "curves.py", self.at / "out" / "log.jsonl", "-o", self.at / "curves.png")
        self.assertEqual((self.at / "curves.png").read_bytes()[:4], b"\x89PNG")

    def test_the_exported_network_says_what_the_trained_one_says(self):
        import cv2
        import numpy
        import torch

        import network
        call(sys.executable, TRAINING / "export.py", "--checkpoint", self.at / "out" / "checkpoint.pt", "--check", self.at / "check",
             "--out", self.at / "model")
        labels = (self.at / "model" / "labels.txt").read_text().split("\n")[:-1]
        model = network.RoomDetector(len(labels))
        model.load_state_dict(torch.load(self.at / "out" / "checkpoint.pt")["mean"])
        model.eval()
        picture = torch.rand(1, 6, 96, 128, generator=torch.Generator().manual_seed(1))
        with torch.no_grad():
            wanted = model(picture).numpy()
        exported = cv2.dnn.readNetFromONNX(str(self.at / "model" / "room_detector.onnx"))
        exported.setInput(picture.numpy())
        got = exported.forward()
        # The boxes; the logits of classes are stretched by the calibration.
        self.assertLess(numpy.abs(got[..., len(labels):] - wanted[..., len(labels):]).max(), 1e-3)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
