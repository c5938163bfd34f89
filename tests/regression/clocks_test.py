#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Sensors whose clocks differ: a run finds it, begins anew with stamps corrected, says so, and goes on from there when killed.

Usage: clocks_test.py PROGRAM SOURCE
"""
import json
import unittest

from small_loop import LARGEST_ERROR_M, SmallLoop, call


class Clocks(SmallLoop):
    def jumped(self, jump):
        return self.damaged("--clock-jump", jump)

    def findings(self, out, place):
        return [finding["what"] for finding in self.summary(out)["findings"] if finding["place"] == place]

    def test_a_late_camera_is_found_and_corrected(self):
        rawlog, out = self.jumped("camera=0:0.12"), self.folder / "late"
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
        rawlog, out = self.jumped("lidar=20:-0.4"), self.folder / "jump"
        done = call(*self.run_words(rawlog, out))
        self.assertIn("too early against those of the others, since they jumped, as", done.stderr)
        self.assertLess(self.error(out), LARGEST_ERROR_M)
        (set_clock,) = self.summary(out)["clocks"]["set"]
        self.assertTrue(set_clock["since_a_jump"])
        self.assertAlmostEqual(set_clock["added_s"], 0.4, delta=1e-3)

    # As a computer does whose time is corrected while it records.
    def test_time_goes_on_where_all_clocks_are_set_back(self):
        rawlog, out = self.jumped("20:-2"), self.folder / "back"
        call(*self.run_words(rawlog, out))
        self.assertLess(self.error(out), LARGEST_ERROR_M)
        (step,) = self.summary(out)["clocks"]["set_back"]
        self.assertAlmostEqual(step["seconds"], 2, delta=0.05)
        self.assertTrue(any(what.startswith("their clock is set back by 2.0") for what in self.findings(out, "all sensors")))

    def test_stamps_stay_where_clocks_agree_or_are_not_to_be_set(self):
        right = self.folder / "right"
        self.assertNotIn("begun anew", call(*self.run_words(self.simulated / "small_loop.rawlog", right)).stderr)
        self.assertEqual(self.summary(right)["clocks"]["set"], [])
        rawlog, out = self.jumped("lidar=0:0.12"), self.folder / "left"
        done = call(*self.run_words(rawlog, out, "--set", "pipeline.set_clocks=false"))
        self.assertNotIn("begun anew", done.stderr)
        self.assertEqual(self.summary(out)["clocks"]["set"], [])
        self.assertTrue(any("too late against those of the others" in what for what in self.findings(out, "LIDAR")))
        self.assertGreater(self.error(out), 2 * self.error(right))

    def test_it_is_the_same_with_more_threads_and_after_kills_before_and_after(self):
        rawlog, whole, killed = self.jumped("camera=0:0.12"), self.folder / "whole", self.folder / "killed"
        call(*self.run_words(rawlog, whole, "--threads", "1"))
        self.assertNotIn("begun anew", self.kill(self.run_words(rawlog, killed, "--threads", "4", "--checkpoint", "0.1"), killed, 1))
        self.assertIn("begun anew", self.kill(("run", "--resume", killed), killed, 2))
        done = call("run", "--resume", killed)
        self.assertNotIn("begun anew", done.stderr)
        self.assertEqual(self.summary(killed)["clocks"], self.summary(whole)["clocks"])
        self.assertIn(str(rawlog), self.summary(killed)["command"])
        self.assertSameResults(killed, whole)

    # Boxes in a file are found by the stamps of their images: the clocks of the others are set.
    def test_stamps_of_images_stay_where_boxes_are_kept_apart(self):
        rawlog, first, second = self.jumped("camera=0:0.12"), self.folder / "first", self.folder / "second"
        boxes = self.folder / "boxes.rawlog"
        call(*self.run_words(rawlog, first, "--save-detections", boxes))
        self.assertEqual({clock["sensor"] for clock in self.summary(first)["clocks"]["set"]}, {"lidar", "wheels"})
        call(*self.run_words(rawlog, second, "--set", f"detection.file={boxes}"))
        for name in ("trajectory.tum", "landmarks.json"):
            self.assertEqual((first / name).read_bytes(), (second / name).read_bytes(), name)
        self.assertTrue(json.loads((first / "landmarks.json").read_text())["landmarks"])


if __name__ == "__main__":
    unittest.main(verbosity=2)
