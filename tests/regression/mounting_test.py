#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Where cameras are: low over the floor, on a robot and by hand, and in a place that nobody measured.

Usage: mounting_test.py PROGRAM SOURCE
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

PROGRAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
del sys.argv[1:3]
FARTHEST_M = 0.1  # of a landmark's middle from that of its object


class Mounting(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def call(self, *words):
        done = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stderr

    def simulated(self, name, change):
        """Folder with a changed world's recording."""
        world = json.loads((SOURCE / "rawlogs" / f"{name}.json").read_text())
        change(world)
        file, out = self.folder / f"{name}.json", self.folder / "simulated"
        file.write_text(json.dumps(world))
        self.call("simulate", file, "-o", out, "--quiet")
        return out

    def mapped(self, rawlog, *words):
        """The warnings of a run into self.folder / "run"."""
        return self.call("run", rawlog, "-o", self.folder / "run", "--quiet", "--no-snapshot", "--threads", "1", *words)

    def expect_map(self, simulated, objects):
        self.mapped(next(simulated.glob("*.rawlog")))
        file = self.folder / "score.json"
        self.call("evaluate", "objects", simulated / "objects.json", self.folder / "run" / "landmarks.json", "--json", file)
        score = json.loads(file.read_text())
        self.assertEqual((score["correct"], score["false_alarms"]), (objects, 0))
        self.assertLess(score["position_error_max_m"], FARTHEST_M)

    def test_a_camera_near_the_floor_on_a_robot(self):
        def lower(world):
            world["sensors"]["camera"].update(at_m=[0.05, 0, 0.6], pitch_down_deg=5)

        self.expect_map(self.simulated("tiny_room", lower), 3)

    # The world is levelled by a floor that is half a metre below the camera.
    def test_a_camera_held_half_a_metre_above_the_floor(self):
        def lower(world):
            for view in world["handheld"]["views"]:
                view["at_m"][2] -= 0.9
                view["look_at_m"][2] = 0.45

        self.expect_map(self.simulated("tiny_handheld", lower), 1)

    # As recordings are whose cameras nobody measured: in the middle of the robot, on the floor.
    def test_without_extrinsics_a_run_says_where_the_camera_is(self):
        rawlog = SOURCE / "rawlogs" / "tiny_room.rawlog"
        warnings = self.mapped(rawlog, "--pose", "KINECT=0,0,0,0,0,0")
        self.assertIn("floor is seen 0.80 m below the sensor and tilted by 12.0 deg", warnings)
        pose = re.search(r"--pose KINECT=([-0-9.,]+)", warnings).group(1)
        z, _, pitch, roll = map(float, pose.split(",")[2:])
        self.assertAlmostEqual(z, 0.8, delta=0.01)
        self.assertAlmostEqual(pitch, 12, delta=0.1)
        self.assertAlmostEqual(roll, 0, delta=0.1)
        self.assertEqual(self.mapped(rawlog, "--pose", f"KINECT={pose}"), "", "and with it there is nothing to say")


if __name__ == "__main__":
    unittest.main()
