#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""`roomgraph view` on a virtual display: objects in their colours at their places, keys, clicks, replay, ends.

Usage: window_test.py PROGRAM [--pictures FOLDER]
"""
import argparse
import json
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from virtual_display import Display, blobs, center  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
RECORDING = ROOT / "rawlogs" / "tiny_room.rawlog"
SETTINGS = {"program": "", "pictures": None}
QUICK = ("--set", "tracking.max_features=900")
SIZE = (1000, 700)
MAP = (150, 0, 575, 610)  # of the window: the map, without the list of layers
IMAGE, PANEL = (585, 0, 995, 310), (585, 350, 995, 610)
CHAIR, DOOR, MARK = (231, 162, 95), (63, 149, 87), (255, 196, 0)
PATIENCE_S = 40


class Window(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.display = Display(*SIZE)
        cls.addClassCleanup(cls.display.close)
        cls.folder = pathlib.Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        cls.out = cls.folder / "out"
        subprocess.run([SETTINGS["program"], "run", RECORDING, "-o", cls.out, "--quiet", "--no-snapshot", "--no-report", *QUICK],
                       check=True, capture_output=True)

    def open(self, *words):
        process = self.display.start([SETTINGS["program"], "view", *words, "--size", f"{SIZE[0]}x{SIZE[1]}"], cwd=self.folder)
        self.addCleanup(self.end, process)
        return process

    def end(self, process):
        if process.poll() is None:
            process.kill()
        process.communicate()

    def until(self, condition, what):
        """Waits for a picture that meets the condition; what it returns."""
        begun = time.monotonic()
        while time.monotonic() - begun < PATIENCE_S:
            time.sleep(0.15)
            picture = self.display.picture()
            found = condition(picture)
            if found:
                return found
        self.keep(picture, "failed")
        return self.fail(f"did not come: {what}")

    def keep(self, picture, name):
        if SETTINGS["pictures"]:
            picture.save(pathlib.Path(SETTINGS["pictures"]) / f"{self.id().split('.')[-1]}_{name}.png")

    def expect_end(self, process, code=0):
        out, err = process.communicate(timeout=PATIENCE_S)
        self.assertEqual((process.returncode, err), (code, ""), out)

    @staticmethod
    def chairs(picture):
        return blobs(picture.near(CHAIR, area=MAP), 200)

    def two_chairs(self):
        return self.until(lambda picture: len(self.chairs(picture)) == 2 and self.chairs(picture), "two chairs")

    def at_rest(self):
        """The picture when nothing has changed in it for three seconds: a replay is at its end."""
        picture, since = self.display.picture(), time.monotonic()
        while time.monotonic() - since < 3:
            time.sleep(0.25)
            now = self.display.picture()
            if now.rows != picture.rows:
                picture, since = now, time.monotonic()
        return picture

    def test_objects_are_at_their_places(self):
        process = self.open(self.out / "map.rgmap", "--top")
        chairs = [complex(*center(blob)) for blob in self.two_chairs()]
        picture = self.display.picture()
        self.keep(picture, "top")
        door = complex(*center(blobs(picture.near(DOOR, 25, MAP), 60)[0]))
        objects = json.loads((self.out / "landmarks.json").read_text(encoding="utf-8"))["landmarks"]
        world = {name: [complex(o["x"], -o["y"]) for o in objects if o["class"] == name] for name in ("swivel_chair", "door")}
        # From above the picture is the world, moved and scaled: two chairs say how, and then where the door is.
        right_to_left = sorted(chairs, key=lambda at: -at.real)
        east_to_west = sorted(world["swivel_chair"], key=lambda at: -at.real)
        scale = (right_to_left[0] - right_to_left[1]) / (east_to_west[0] - east_to_west[1])
        self.assertLess(abs(scale.imag), 0.08 * scale.real, "x is to the right, y up")
        expected = right_to_left[0] + scale.real * (world["door"][0] - east_to_west[0])
        self.assertLess(abs(door - expected), 20, "px from where the door is in the map")
        self.display.key("q")
        self.expect_end(process)

    def test_a_click_tells_what_is_known(self):
        process = self.open(self.out, "--top")
        chair = self.two_chairs()[0]
        before = self.display.picture()
        empty = len(before.near((220, 220, 220), 40, PANEL))
        self.display.click(*center(chair))
        self.until(lambda now: len(now.near(MARK, 20, MAP)) > 30, "a mark around the chair")
        picture = self.until(lambda now: len(now.near((220, 220, 220), 60, PANEL)) > empty + 200 and now, "text in the panel")
        self.keep(picture, "clicked")
        marked = center(picture.near(MARK, 20, MAP))
        self.assertLess(abs(complex(*marked) - complex(*center(chair))), 12)
        self.display.key("Escape")
        self.until(lambda now: not now.near(MARK, 20, MAP), "nothing selected")
        self.display.drag(300, 500, 360, 420)
        self.until(lambda now: now.part(*MAP) != before.part(*MAP), "another view of the map")
        self.assertFalse(self.display.picture().near(MARK, 20, MAP), "a drag is no click")
        self.display.key("q")
        self.expect_end(process)

    def test_layers_and_saved_pictures(self):
        process = self.open(self.out / "map.rgmap", "--top")
        self.two_chairs()
        whole = self.display.picture()
        self.display.key("5")
        hidden = self.until(lambda now: not self.chairs(now) and now, "no landmarks")
        self.assertNotEqual(hidden.part(*MAP), whole.part(*MAP))
        self.display.click(26, 147)  # the check box of the landmarks
        self.two_chairs()
        self.display.key("1")
        self.until(lambda now: len(now.near((58, 70, 87), 4, MAP)) < len(whole.near((58, 70, 87), 4, MAP)) // 4, "no walls")
        self.display.key("s", "s")
        begun = time.monotonic()
        while not (self.folder / "view_1.png").exists() and time.monotonic() - begun < PATIENCE_S:
            time.sleep(0.1)
        self.assertEqual((self.folder / "view_1.png").read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        process.send_signal(signal.SIGINT)
        self.expect_end(process)

    def test_a_replay_grows_steps_and_goes_back(self):
        process = self.open(RECORDING, "--paused", "--speed", "0", "--top", *QUICK)
        dark = (41, 43, 48)
        self.until(lambda now: len(now.near(dark, 8, IMAGE)) > 50000, "the window, without an image")
        self.display.key("Right", "Right", "Right")
        self.until(lambda now: len(now.near(dark, 8, IMAGE)) < 60000, "an image of the camera")
        early = self.display.picture()
        self.assertFalse(self.chairs(early), "nothing is mapped yet")
        self.display.key("space")
        self.two_chairs()
        late = self.at_rest()
        self.keep(late, "end")
        self.assertNotEqual(early.part(*IMAGE), late.part(*IMAGE))
        self.display.key("Home")
        self.until(lambda now: not self.chairs(now), "the map as it was at the beginning")
        self.display.key("End")
        self.two_chairs()
        self.display.click(455, 640)  # the number of the record
        self.display.xdotool("key", "ctrl+a")
        self.display.xdotool("type", "--delay", "80", "15")
        self.display.key("Return")
        picture = self.until(lambda now: len(self.chairs(now)) == 1 and now, "the map at record 15: one chair")
        self.assertTrue(picture.near((58, 70, 87), 4, MAP), "digits of a number switch no layers")
        self.display.key("q")
        self.expect_end(process)

    def test_scripted_use(self):
        picture = self.folder / "scripted.png"
        process = self.open(RECORDING, "--speed", "0", "--follow", "--save", picture, "--exit-after", "3", *QUICK)
        self.expect_end(process)
        self.assertEqual(picture.read_bytes()[16:24], bytes([0, 0, SIZE[0] >> 8, SIZE[0] & 255, 0, 0, SIZE[1] >> 8, SIZE[1] & 255]))
        process = self.open(self.out / "map.rgmap", "--save", self.folder / "no" / "folder.png", "--exit-after", "1")
        _, err = process.communicate(timeout=PATIENCE_S)
        self.assertEqual((process.returncode, err.count("\n")), (1, 1), err)
        self.assertIn("folder.png", err)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--pictures", help="folder for pictures of the window, to look at")
    arguments, others = parser.parse_known_args()
    SETTINGS.update(program=pathlib.Path(arguments.program).resolve(), pictures=arguments.pictures)
    unittest.main(argv=[sys.argv[0], *others], verbosity=2)
