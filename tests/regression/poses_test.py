#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Sensors whose recorded pose on the robot is turned: a run finds it, begins anew with the pose corrected, and says so.

Usage: poses_test.py PROGRAM SOURCE
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
LARGEST_ERROR_M = 0.012  # of a path with right poses; 0.009 as it is


def call(*words):
    return subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, check=True)


class Poses(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.simulated = cls.folder / "simulated"
        call("simulate", SOURCE / "worlds" / "small_loop.json", "-o", cls.simulated, "--quiet")

    def ran(self, name, damage, *words):
        """Output folder and stderr of a run on the recording with poses off by so much."""
        rawlog, out = self.simulated / "small_loop.rawlog", self.folder / name
        if damage:
            rawlog = self.folder / (name + ".rawlog")
            call("damage", self.simulated / "small_loop.rawlog", "-o", rawlog, *damage)
        return out, call("run", rawlog, "-o", out, "--no-snapshot", *words).stderr

    def error(self, out):
        file = self.folder / "score.json"
        call("evaluate", "trajectory", self.simulated / "groundtruth_robot.txt", out / "trajectory.tum", "--json", file)
        return json.loads(file.read_text())["ate_rmse_m"]

    def summary(self, out):
        return json.loads((out / "summary.json").read_text())

    def test_a_camera_that_looks_aside_and_down_is_turned_back(self):
        out, said = self.ran("aside", ("--wrong-extrinsics", "camera=0,0,0,8,6,0"))
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
        rawlog, whole, killed = self.folder / "killed.rawlog", self.folder / "whole", self.folder / "killed"
        call("damage", self.simulated / "small_loop.rawlog", "-o", rawlog, "--wrong-extrinsics", "camera=0,0,0,8,6,0")
        call("run", rawlog, "-o", whole, "--no-snapshot", "--threads", "1")
        words = ("run", rawlog, "-o", killed, "--no-snapshot", "--threads", "4", "--checkpoint", "0.1")
        run = subprocess.Popen([PROGRAM, *map(str, words)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        checkpoint, live = killed / "roomgraph_checkpoint" / "run.json", killed / "roomgraph_unfinished" / "live.tum"
        for _ in range(6000):
            if checkpoint.exists() and '"begun": 3,' in checkpoint.read_text() and live.exists() and live.stat().st_size > 4000:
                break
            time.sleep(0.005)
        run.send_signal(signal.SIGKILL)
        self.assertEqual(run.wait(), -signal.SIGKILL, "it had ended before it was killed")
        self.assertNotIn("begun anew", call("run", "--resume", killed).stderr)
        self.assertEqual(self.summary(killed)["sensor_poses"], self.summary(whole)["sensor_poses"])
        for name in ("trajectory.tum", "live.tum", "landmarks.json", "graph.g2o", "map.rgmap"):
            self.assertEqual((killed / name).read_bytes(), (whole / name).read_bytes(), name)

    def test_poses_stay_where_they_are_right_given_or_not_to_be_set(self):
        out, said = self.ran("right", ())
        self.assertNotIn("begun anew", said)
        self.assertEqual(self.summary(out)["sensor_poses"]["set"], [])
        wrong = ("--wrong-extrinsics", "camera=0,0,0,8,6,0")
        for name, words in (("left", ("--set", "pipeline.set_poses=false")), ("given", ("--pose", "LIDAR=0,0,0.3,0,0,0"))):
            out, said = self.ran(name, wrong, *words)
            self.assertNotIn("begun anew", said)
            self.assertEqual(self.summary(out)["sensor_poses"]["set"], [])


if __name__ == "__main__":
    unittest.main(verbosity=2)
