#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Sensors whose recorded pose on the robot is turned: a run finds it, begins anew with the pose corrected, and says so.

Usage: poses_test.py PROGRAM SOURCE
"""
import unittest

from small_loop import LARGEST_ERROR_M, SmallLoop, call

ASIDE = ("--wrong-extrinsics", "camera=0,0,0,8,6,0")


class Poses(SmallLoop):
    def ran(self, name, damage, *words):
        """Output folder and stderr of a run on the recording with poses off by so much."""
        rawlog, out = self.damaged(*damage) if damage else self.simulated / "small_loop.rawlog", self.folder / name
        return out, call(*self.run_words(rawlog, out, *words)).stderr

    def test_a_camera_that_looks_aside_and_down_is_turned_back(self):
        out, said = self.ran("aside", ASIDE)
        self.assertRegex(said, r"roomgraph: KINECT: its recorded pose is turned by .* begun anew with its pose corrected\n")
        self.assertEqual([pose["label"] for pose in self.summary(out)["sensor_poses"]["set"]], ["KINECT"])
        findings = [finding["what"] for finding in self.summary(out)["findings"] if finding["what"].endswith("; it was corrected")]
        self.assertEqual(len(findings), 1)
        yaw, pitch, roll = (float(word.split()[0]) for word in findings[0].replace("turned by", ",").split(",")[1:])
        self.assertAlmostEqual(yaw, 8, delta=1)
        self.assertAlmostEqual(pitch, 6, delta=1)
        self.assertAlmostEqual(roll, 0, delta=1)
        self.assertLess(self.error(out), LARGEST_ERROR_M)
        self.assertIn("it was corrected", (out / "report.html").read_text())

    def test_a_lidar_that_looks_aside_is_turned_back(self):
        out, said = self.ran("lidar", ("--wrong-extrinsics", "lidar=0,0,0,-8,0,0"))
        self.assertRegex(said, r"roomgraph: LIDAR: its recorded pose is turned by -[78]\.\d deg \(yaw\)")
        self.assertEqual([pose["sensor"] for pose in self.summary(out)["sensor_poses"]["set"]], ["lidar"])
        self.assertLess(self.error(out), LARGEST_ERROR_M)

    def test_it_is_the_same_with_more_threads_and_after_a_kill(self):
        rawlog, whole, killed = self.damaged(*ASIDE), self.folder / "whole", self.folder / "killed"
        call(*self.run_words(rawlog, whole, "--threads", "1"))
        self.kill(self.run_words(rawlog, killed, "--threads", "4", "--checkpoint", "0.1"), killed, 3)
        self.assertNotIn("begun anew", call("run", "--resume", killed).stderr)
        self.assertEqual(self.summary(killed)["sensor_poses"], self.summary(whole)["sensor_poses"])
        self.assertSameResults(killed, whole)

    def test_poses_stay_where_they_are_right_given_or_not_to_be_set(self):
        out, said = self.ran("right", ())
        self.assertNotIn("begun anew", said)
        self.assertEqual(self.summary(out)["sensor_poses"]["set"], [])
        for name, words in (("left", ("--set", "pipeline.set_poses=false")), ("given", ("--pose", "LIDAR=0,0,0.3,0,0,0"))):
            out, said = self.ran(name, ASIDE, *words)
            self.assertNotIn("begun anew", said)
            self.assertEqual(self.summary(out)["sensor_poses"]["set"], [])


if __name__ == "__main__":
    unittest.main(verbosity=2)
