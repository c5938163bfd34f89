#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""bench/flats.py with a program of known answers in place of roomgraph, and its statistics against closed forms."""
import argparse
import contextlib
import io
import json
import math
import pathlib
import stat
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
import flats  # noqa: E402

# ATE is a hundredth of the flat's number, with x.y=1 half of it; live it is 1 m. Precision is 0.5, live accuracy 0.25.
FAKE = """#!{python}
import json, pathlib, sys
a = sys.argv[1:]
with open({log!r}, "a") as log:
    log.write(" ".join(a) + "\\n")
if a[0] == "simulate":
    out = pathlib.Path(a[a.index("-o") + 1])
    for name in ("flat.rawlog", "groundtruth.txt", "groundtruth_robot.txt", "objects.json", "boxes.jsonl"):
        (out / name).write_text(a[2])
elif a[0] == "run":
    out = pathlib.Path(a[3])
    out.mkdir(parents=True)
    (out / "summary.json").write_text("{{}}")
    for name in ("detections.jsonl", "associations.jsonl", "associations_live.jsonl", "landmarks.json", "live.tum"):
        (out / name).write_text("")
    ate = int(pathlib.Path(a[1]).read_text()) / 100 * (0.5 if "x.y=1" in a else 1)
    for name in ("trajectory.tum", "trajectory_camera.tum"):
        (out / name).write_text(str(ate))
elif a[1] == "trajectory":
    text = pathlib.Path(a[3]).read_text()
    pathlib.Path(a[-1]).write_text(json.dumps({{"ate_rmse_m": float(text or 1)}}))
else:
    live = any(part.endswith("associations_live.jsonl") for part in a)
    pathlib.Path(a[-1]).write_text(json.dumps({{"precision": 0.5, "association_accuracy": 0.25 if live else 0.75}}))
"""


class Flats(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.log = self.folder / "log"
        self.program = self.folder / "roomgraph"
        self.program.write_text(FAKE.format(python=sys.executable, log=str(self.log)))
        self.program.chmod(self.program.stat().st_mode | stat.S_IXUSR)

    def run_flats(self, *arguments):
        out = io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(io.StringIO()):
            code = flats.main(["--out", str(self.folder / "out"), "--program", str(self.program), *arguments])
        return code, out.getvalue()

    def test_variants_are_compared_flat_by_flat(self):
        code, out = self.run_flats("--seeds", "10-12", "--variants", "half=x.y=1")
        self.assertEqual(code, 0)
        self.assertIn("3 random flats, 10 to 12, for choosing", out)
        self.assertIn("| ATE, m | 0.110 (0.120) | 0.055 (0.060) | x 0.500 [0.500 .. 0.500] * |", out)
        self.assertIn("| ATE live, m | 1.000 (1.000) |", out)
        self.assertIn("| objects: precision | 0.500 (0.500) | 0.500 (0.500) | +0.000 [+0.000 .. +0.000] |", out)
        self.assertIn("| association: accuracy | 0.7500 (0.7500) |", out)
        self.assertIn("| association live: accuracy | 0.2500 (0.2500) |", out)
        figures = json.loads((self.folder / "out/figures.json").read_text())
        self.assertEqual(figures["flats"], [10, 11, 12])
        self.assertEqual((self.folder / "out/table.md").read_text().strip(), out.strip())

    def test_flats_are_simulated_once_for_their_options(self):
        self.run_flats("--seeds", "1-2", "--variants", "half=x.y=1")
        self.run_flats("--seeds", "1-2")
        simulated = [line for line in self.log.read_text().splitlines() if line.startswith("simulate")]
        self.assertEqual(len(simulated), 2)
        self.assertRegex(simulated[0], r"^simulate --flat 1 -o \S+ --seed 1 --quiet$")
        self.run_flats("--seeds", "1", "--rooms", "3", "--handheld")
        last = [line for line in self.log.read_text().splitlines() if line.startswith("simulate")][-1]
        self.assertRegex(last, r"^simulate --flat 1 --rooms 3 --handheld -o ")
        self.assertRegex(self.log.read_text(), r"evaluate trajectory \S+/groundtruth\.txt \S+/trajectory_camera\.tum")

    def test_choosing_and_reporting_are_kept_apart(self):
        self.assertEqual(flats.parse_seeds("1-3,7,2"), [1, 2, 3, 7])
        self.assertEqual(flats.parse_seeds("1000-1019"), list(range(1000, 1020)))
        for bad in ("0", "99-100", "99,1000", "1020", "x", "1-", "5-1"):
            if bad != "1-":
                with self.assertRaises(argparse.ArgumentTypeError, msg=bad):
                    flats.parse_seeds(bad)
        self.assertIn("for reporting", flats.table([1000, 1001], {"default": [{}, {}]}))

    def test_bootstrap_has_the_width_of_the_normal_interval(self):
        values = [math.sin(7.1 * i) + 0.2 for i in range(200)]
        mean, low, high = flats.bootstrap(values)
        deviation = math.sqrt(sum((value - mean) ** 2 for value in values) / len(values))
        width = 2 * 1.96 * deviation / math.sqrt(len(values))
        self.assertAlmostEqual(mean, sum(values) / 200)
        self.assertAlmostEqual((high - low) / width, 1, delta=0.08)
        self.assertEqual(flats.bootstrap([3, 3]), (3, 3, 3))

    def test_ratios_leave_out_what_has_none(self):
        self.assertTrue(flats.comparison([2, 8, 0], [1, 2, 5], "ratio", ".1f").startswith("2: x 2.828 ["))
        self.assertEqual(flats.comparison([1, None], [1, 2], "difference", ".1f"), "-")
        self.assertEqual(flats.middle_and_worst([1, 2, None], ".1f", 1), "2: 1.5 (1.0)")


if __name__ == "__main__":
    unittest.main()
