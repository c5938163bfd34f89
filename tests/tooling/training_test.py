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
                        "--steps", steps, "--batch", 8, "--threads", 1)

    def test_the_loss_falls_and_a_stopped_training_goes_on(self):
        first, last = (json.loads(line) for line in (self.at / "out" / "log.jsonl").read_text().splitlines())
        self.assertIn(f"goes on from {first['steps']} steps", self.said)
        self.assertEqual([first["steps"], last["steps"]], [10, 100])
        self.assertLess(last["places"], 0.9 * first["places"])
        self.assertLess(last["kinds"] + last["places"], 0.95 * (first["kinds"] + first["places"]))

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
