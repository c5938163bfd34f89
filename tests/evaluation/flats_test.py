#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""bench/flats.py with a program of known answers in place of roomgraph, and its statistics against closed forms."""
import argparse
import configparser
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
from made_up_batch import BEGINNING  # noqa: E402

# ATE is a hundredth of the flat's number, with x.y=1 half of it; live it is 1 m. Precision is 0.5, live accuracy 0.25. Flat 7 fails.
FAKE = BEGINNING + """for job in jobs["inputs"]:
    for seed in map(int, job["simulate"]["flats"].split(",")):
        id = db.execute("INSERT INTO inputs(input_group, seed) VALUES(?, ?)", [job["group"], seed]).lastrowid
        for variant in jobs["variants"]:
            name = f"flat_{{seed}}--{{variant['name']}}"
            failed += seed == 7
            db.execute("INSERT INTO runs VALUES(?, ?, ?, ?, ?, 'rev1')", [name, id, variant["name"], "failed" if seed == 7 else "complete", ""])
            ate = seed / 100 * (0.5 if "x.y=1" in variant["set"] else 1)
            for figure, value in (("trajectory.ate_rmse_m", ate), ("live.ate_rmse_m", 1.0), ("objects.precision", 0.5),
                                  ("objects.association_accuracy", 0.75), ("objects_live.association_accuracy", 0.25)):
                if seed != 7:
                    db.execute("INSERT INTO figures VALUES(?, ?, ?)", [name, figure, value])
db.commit()
sys.exit(1 if failed else 0)
"""


class Flats(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.program = self.folder / "roomgraph"
        self.program.write_text(FAKE.format(python=sys.executable, log=str(self.folder / "log")))
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

    def test_one_batch_does_it_all(self):
        self.run_flats("--seeds", "1-2,5", "--set", "x.always=1", "--variants", "half=x.y=1", "--jobs", "3")
        jobs = json.loads((self.folder / "out/jobs.yaml").read_text())
        self.assertEqual(jobs["inputs"], [{"simulate": {"flats": "1,2,5"}, "group": "flats"}])
        self.assertEqual(jobs["variants"], [{"name": "default", "set": ["x.always=1"]}, {"name": "half", "set": ["x.always=1", "x.y=1"]}])
        self.assertEqual(jobs["limits"], {"jobs": 3, "threads": 1})
        self.run_flats("--seeds", "1", "--rooms", "3", "--handheld", "--meshes", str(self.folder / "models"))
        [job] = json.loads((self.folder / "out/jobs.yaml").read_text())["inputs"]
        self.assertEqual(job, {"simulate": {"flats": "1", "rooms": 3, "handheld": True, "meshes": str((self.folder / "models").resolve())},
                               "group": "flats_handheld_3rooms_models"})

    def test_failed_runs_are_counted_not_hidden(self):
        code, out = self.run_flats("--seeds", "6-8")
        self.assertEqual(code, 1)
        self.assertIn("| runs that failed | 1 |", out)
        self.assertIn("| ATE, m | 2: 0.070 (0.080) |", out)

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


class CuboidsOnly(unittest.TestCase):
    """bench/cuboids_only.ini is an arm that differs in one thing."""

    def test_differs_from_the_shipped_classes_in_the_shape_of_chairs_alone(self):
        def read(path):
            parser = configparser.ConfigParser()
            parser.read(ROOT / path)
            return {(section, key): value for section in parser.sections() for key, value in parser[section].items()}

        shipped, arm = read("objects.ini"), read("bench/cuboids_only.ini")
        self.assertEqual(shipped.keys(), arm.keys())
        differ = {key: (shipped[key], arm[key]) for key in shipped if shipped[key] != arm[key]}
        self.assertEqual(differ, {("swivel_chair", "shape"): ("cylinder", "cuboid"), ("swivel_chair", "symmetry"): ("0", "4")})


if __name__ == "__main__":
    unittest.main()
