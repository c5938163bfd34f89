#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The window of MRPT's engine on a virtual display: map, path and objects are drawn; it pauses, and closes by itself and on a signal.

Usage: engine_window_test.py PROGRAM [--pictures FOLDER]
"""
import argparse
import pathlib
import signal
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from virtual_display import Display  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
SETTINGS = {"program": "", "pictures": None}
PATIENCE_S = 90


def is_orange(color):
    """A chair in its colour (#e7a25f), lit from wherever."""
    red, green, blue = color
    return red > 90 and 0.55 < green / red < 0.85 and 0.1 < blue / red < 0.6


def is_scan(color):
    """Points of the map are red."""
    return color[0] > 150 and color[1] < 60 and color[2] < 60


def count(picture, condition):
    return sum(condition(picture.at(x, y)) for y in range(0, picture.height, 2) for x in range(0, picture.width, 2))


class EngineWindow(unittest.TestCase):
    def setUp(self):
        self.display = Display(1100, 850)
        self.addCleanup(self.display.close)
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.out = self.folder / "out"

    def start(self, *words):
        process = self.display.start(
            [SETTINGS["program"], "graphslam", ROOT / "rawlogs" / "tiny_room.rawlog", "--ini", ROOT / "share" / "mrpt" / "graphslam.ini",
             "-o", self.out, "--window", "-e", "CScanClosuresERD+CObjectClosuresERD", "--set", "tracking.max_features=900", *words])
        self.addCleanup(lambda: process.poll() is None and process.kill())
        return process

    def until_drawn(self, process):
        begun = time.monotonic()
        while time.monotonic() - begun < PATIENCE_S and process.poll() is None:
            time.sleep(0.5)
            picture = self.display.picture()
            if count(picture, is_orange) > 100 and count(picture, is_scan) > 30:
                break
        if SETTINGS["pictures"]:
            picture.save(pathlib.Path(SETTINGS["pictures"]) / "engine_window.png")
        self.assertGreater(count(picture, is_orange), 100, "chairs")
        self.assertGreater(count(picture, is_scan), 30, "scans")

    def test_shows_map_and_objects_and_ends_on_a_signal(self):
        process = self.start()
        self.until_drawn(process)
        time.sleep(1)
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=PATIENCE_S)
        self.assertIn(process.returncode, (0, 4))
        self.assertTrue((self.out / "summary.json").exists())

    def share(self):
        try:
            return float((self.folder / "progress").read_text())
        except (FileNotFoundError, ValueError):
            return 0

    def until_share(self, process, condition, why):
        begun = time.monotonic()
        while not condition(self.share()) and process.poll() is None and time.monotonic() - begun < PATIENCE_S:
            time.sleep(0.05)
        self.assertTrue(condition(self.share()), why)

    def pause(self, process):
        """The share that was done when the key had been pressed in the first half of the recording."""
        self.until_share(process, lambda share: share > 0.3, "nothing was replayed")
        self.display.xdotool("mousemove", 300, 300)
        self.display.key("p")
        time.sleep(2)  # a step takes less
        return self.share()

    def test_pauses_and_goes_on_by_its_key(self):
        process = self.start("--exit-after", "0", "--progress-file", self.folder / "progress", "--quiet")
        paused_at = self.pause(process)
        drawn = self.display.picture()
        time.sleep(2)
        self.assertLess(paused_at, 0.9)
        self.assertEqual(self.share(), paused_at)
        self.display.key("p")
        out, err = process.communicate(timeout=PATIENCE_S)
        self.assertEqual(process.returncode, 0, err)
        self.assertIn("16 nodes", out)
        self.assertGreater(count(drawn, is_scan), 10, "what was there before the pause")

    def test_ends_on_a_signal_while_it_is_paused(self):
        process = self.start("--progress-file", self.folder / "progress", "--quiet")
        self.assertLess(self.pause(process), 0.9)
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=PATIENCE_S)
        self.assertEqual(process.returncode, 4)
        self.assertTrue((self.out / "summary.json").exists())

    def test_closes_by_itself_and_saves_the_scene(self):
        process = self.start("--exit-after", "0.5", "--quiet")
        out, err = process.communicate(timeout=PATIENCE_S)
        self.assertEqual(process.returncode, 0, err)
        self.assertIn("16 nodes", out)
        self.assertGreater((self.out / "scene.3DScene").stat().st_size, 1000)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--pictures")
    arguments = parser.parse_args()
    SETTINGS.update(program=arguments.program, pictures=arguments.pictures)
    unittest.main(argv=[sys.argv[0]])
