#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""bench/table1.py with the program itself, on simulated folders in the layouts of TUM RGB-D and ICL-NUIM: PROGRAM is the only argument."""
import contextlib
import io
import json
import pathlib
import shutil
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
import seeds  # noqa: E402
import table1  # noqa: E402
import table1_layouts  # noqa: E402

WORLD = ROOT / "rawlogs" / "tiny_handheld.json"
PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve()


class Layouts(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.program = seeds.Program(PROGRAM)

    def call(self, *arguments):
        self.assertIsNone(self.program.call(*arguments))

    def exported(self, name, focal_px):
        """A hand-held recording of 640x480 px, as `export tum` writes it."""
        world = json.loads(WORLD.read_text())
        world["sensors"]["camera"] = {"preset": "kinect", "rate_hz": 5, "width_px": 640, "height_px": 480, "focal_px": focal_px}
        file, made, export = self.folder / f"{name}.json", self.folder / name, self.folder / f"{name}_tum"
        file.write_text(json.dumps(world))
        self.call("simulate", file, "-o", made, "--quiet")
        [rawlog] = made.glob("*.rawlog")
        shutil.copy(made / "groundtruth.txt", rawlog.with_suffix(".groundtruth.txt"))
        self.call("export", "tum", rawlog, "-o", export)
        return export

    def test_both_layouts_are_imported_run_and_evaluated(self):
        try:
            import cv2  # noqa: F401
        except ImportError:
            self.skipTest("Python's OpenCV is not there")
        disk = self.folder / "disk"
        table1_layouts.as_tum(self.exported("tum", 525), disk / "rgbd_dataset_freiburg1_desk")
        # The published camera has 481.2 and 480 px.
        table1_layouts.as_icl(self.exported("icl", 480.6), disk / "living_room_traj1_frei_png")
        with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(io.StringIO()) as err:
            code = table1.main([str(disk), "--out", str(self.folder / "out"), "--program", str(PROGRAM)])
        self.assertEqual(code, 0, err.getvalue())
        self.assertIn("| fr2/desk | 0.014 | 0.019 | 0.013 | not found |", out.getvalue())
        figures = json.loads((self.folder / "out/figures.json").read_text())
        self.assertEqual([entry["sequence"] for entry in figures], ["Living1", "fr1/desk"])
        for entry in figures:
            for arm in table1.ARMS:
                self.assertLess(entry[arm]["trajectory.ate_rmse_m"], 0.02, (entry["sequence"], arm))
                self.assertGreater(entry[arm]["trajectory.coverage"], 0.9)
        self.check_that_the_mirror_matters(disk / "living_room_traj1_frei_png" / "livingRoom1.gt.freiburg",
                                           figures[0]["ours"]["trajectory.ate_rmse_m"])

    def check_that_the_mirror_matters(self, left_handed, error):
        """The same path against the truth as ICL-NUIM has it: no rigid motion takes the one to the other."""
        rows = [line.split() for line in left_handed.read_text().splitlines()]
        truth, score = self.folder / "left_handed.txt", self.folder / "score.json"
        truth.write_text("".join(" ".join([f"{int(row[0]) / 30:.6f}", *row[1:]]) + "\n" for row in rows))
        [path] = (self.folder / "out/batch/runs").glob("Living1*--ours/trajectory_camera.tum")
        self.call("evaluate", "trajectory", truth, path, "--json", score)
        self.assertGreater(json.loads(score.read_text())["ate_rmse_m"], 5 * error)


if __name__ == "__main__":
    unittest.main()
