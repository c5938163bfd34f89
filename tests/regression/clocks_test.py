#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Sensors whose clocks differ: a run finds it, begins anew with stamps corrected, says so, and goes on from there when killed.

Usage: clocks_test.py PROGRAM SOURCE
"""
import json
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
del sys.argv[1:3]
LARGEST_ERROR_M = 0.008  # of a path whose stamps are right; 0.004 as it is


def call(*words):
    return subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, check=True)


class Clocks(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.simulated = cls.folder / "simulated"
        call("simulate", SOURCE / "worlds" / "small_loop.json", "-o", cls.simulated, "--quiet")

    def damaged(self, jump):
        rawlog = self.folder / "damaged.rawlog"
        call("damage", self.simulated / "small_loop.rawlog", "-o", rawlog, "--clock-jump", jump)
        return rawlog

    def run_words(self, rawlog, out, *words):
        return ("run", rawlog, "-o", out, "--no-snapshot", *words)

    def error(self, out):
        file = self.folder / "score.json"
        call("evaluate", "trajectory", self.simulated / "groundtruth_robot.txt", out / "trajectory.tum", "--json", file)
        return json.loads(file.read_text())["ate_rmse_m"]

    def summary(self, out):
        return json.loads((out / "summary.json").read_text())

    def findings(self, out, place):
        return [finding["what"] for finding in self.summary(out)["findings"] if finding["place"] == place]

    def test_a_late_camera_is_found_and_corrected(self):
        rawlog, out = self.damaged("camera=0:0.12"), self.folder / "late"
        done = call(*self.run_words(rawlog, out))
        self.assertRegex(done.stderr, r"roomgraph: KINECT: its stamps are 0\.1\d\d s \(\+- 0\.00\d\) too late .*; begun anew with stamps corrected\n")
        self.assertLess(self.error(out), LARGEST_ERROR_M)
        (set_clock,) = self.summary(out)["clocks"]["set"]
        self.assertEqual((set_clock["sensor"], set_clock["label"], set_clock["since_a_jump"]), ("camera", "KINECT", False))
        self.assertAlmostEqual(set_clock["added_s"], -0.12, delta=0.012)
        self.assertAlmostEqual(self.summary(out)["clocks"]["left"]["camera"]["offset_s"], 0, delta=0.01)
        self.assertTrue(any(what.endswith("; they were corrected") for what in self.findings(out, "KINECT")))
        self.assertIn("they were corrected", (out / "report.html").read_text())

    def test_a_clock_that_jumps_is_corrected_from_there_on(self):
        rawlog, out = self.damaged("lidar=20:-0.4"), self.folder / "jump"
        done = call(*self.run_words(rawlog, out))
        self.assertIn("too early against those of the others, since they jumped, as", done.stderr)
        self.assertLess(self.error(out), LARGEST_ERROR_M)
        (set_clock,) = self.summary(out)["clocks"]["set"]
        self.assertTrue(set_clock["since_a_jump"])
        self.assertAlmostEqual(set_clock["added_s"], 0.4, delta=1e-3)

    def test_stamps_stay_where_clocks_agree_or_are_not_to_be_set(self):
        right = self.folder / "right"
        self.assertNotIn("begun anew", call(*self.run_words(self.simulated / "small_loop.rawlog", right)).stderr)
        self.assertEqual(self.summary(right)["clocks"]["set"], [])
        rawlog, out = self.damaged("lidar=0:0.12"), self.folder / "left"
        done = call(*self.run_words(rawlog, out, "--set", "pipeline.set_clocks=false"))
        self.assertNotIn("begun anew", done.stderr)
        self.assertEqual(self.summary(out)["clocks"]["set"], [])
        self.assertTrue(any("too late against those of the others" in what for what in self.findings(out, "LIDAR")))
        self.assertGreater(self.error(out), 2 * self.error(right))

    def kill(self, words, out, clocks):
        """Kills a run whose checkpoint names so many clocks, some time after its beginning; returns what it said."""
        run = subprocess.Popen([PROGRAM, *map(str, words)], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        checkpoint, live = out / "roomgraph_checkpoint" / "run.json", out / "roomgraph_unfinished" / "live.tum"
        for _ in range(6000):
            if checkpoint.exists() and f'"begun": {clocks + 1},' in checkpoint.read_text() and live.exists() and live.stat().st_size > 4000:
                break
            time.sleep(0.005)
        run.send_signal(signal.SIGKILL)
        said = run.communicate()[1]
        self.assertEqual(run.returncode, -signal.SIGKILL, "it had ended before it was killed")
        return said

    def test_it_is_the_same_with_more_threads_and_after_kills_before_and_after(self):
        rawlog, whole, killed = self.damaged("camera=0:0.12"), self.folder / "whole", self.folder / "killed"
        call(*self.run_words(rawlog, whole, "--threads", "1"))
        self.assertNotIn("begun anew", self.kill(self.run_words(rawlog, killed, "--threads", "4", "--checkpoint", "0.1"), killed, 0))
        self.assertIn("begun anew", self.kill(("run", "--resume", killed), killed, 1))
        done = call("run", "--resume", killed)
        self.assertNotIn("begun anew", done.stderr)
        self.assertEqual(self.summary(killed)["clocks"], self.summary(whole)["clocks"])
        self.assertIn(str(rawlog), self.summary(killed)["command"])
        for name in ("trajectory.tum", "live.tum", "landmarks.json", "graph.g2o", "map.rgmap"):
            self.assertEqual((killed / name).read_bytes(), (whole / name).read_bytes(), name)

    # Boxes in a file are found by the stamps of their images: the clocks of the others are set.
    def test_stamps_of_images_stay_where_boxes_are_kept_apart(self):
        rawlog, first, second = self.damaged("camera=0:0.12"), self.folder / "first", self.folder / "second"
        boxes = self.folder / "boxes.rawlog"
        call(*self.run_words(rawlog, first, "--save-detections", boxes))
        self.assertEqual({clock["sensor"] for clock in self.summary(first)["clocks"]["set"]}, {"lidar", "wheels"})
        call(*self.run_words(rawlog, second, "--set", f"detection.file={boxes}"))
        for name in ("trajectory.tum", "landmarks.json"):
            self.assertEqual((first / name).read_bytes(), (second / name).read_bytes(), name)
        self.assertTrue(json.loads((first / "landmarks.json").read_text())["landmarks"])


if __name__ == "__main__":
    unittest.main(verbosity=2)
