#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""bench/seeds.py with a program of known answers in place of roomgraph."""
import argparse
import contextlib
import importlib.util
import io
import json
import pathlib
import stat
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SPEC = importlib.util.spec_from_file_location("seeds", ROOT / "bench" / "seeds.py")
seeds = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(seeds)
sys.path.insert(0, str(pathlib.Path(__file__).parent))
from made_up_batch import BEGINNING  # noqa: E402

# ATE is a tenth of the seed, twice that without lidar; seed 3 fails in the variant `broken`. The catalogue also holds a run of an earlier call.
FAKE = BEGINNING + """for job in jobs["inputs"]:
    world = pathlib.Path(job["simulate"]["world"]).stem
    first, last = job["simulate"]["seeds"].split("-")
    for seed in range(int(first), int(last) + 1):
        id = db.execute("INSERT INTO inputs(input_group, seed) VALUES(?, ?)", [world, seed]).lastrowid
        for variant in jobs["variants"]:
            name = f"{{world}}_s{{seed}}--{{variant['name']}}"
            bad = seed == 3 and "x.broken=1" in variant["set"]
            failed += bad
            db.execute("INSERT INTO runs VALUES(?, ?, ?, ?, ?, 'rev1')",
                       [name, id, variant["name"], "failed" if bad else "complete", "no luck" if bad else ""])
            for figure, value in (("trajectory.ate_rmse_m", seed / 10 * (2 if "lidar.enabled=false" in variant["set"] else 1)),
                                  ("run.wall_s", 7.0), ("counts.frames", 3.0)):
                if not bad:
                    db.execute("INSERT INTO figures VALUES(?, ?, ?)", [name, figure, value])
    other = db.execute("INSERT INTO inputs(input_group, seed) VALUES(?, 99)", [world]).lastrowid
    db.execute("INSERT INTO runs VALUES('old', ?, 'default', 'complete', '', 'rev0')", [other])
    db.execute("INSERT INTO figures VALUES('old', 'trajectory.ate_rmse_m', 1000)")
db.commit()
sys.exit(1 if failed else 0)
"""


class Seeds(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.log = self.folder / "log"
        self.program = self.folder / "roomgraph"
        self.program.write_text(FAKE.format(python=sys.executable, log=str(self.log)))
        self.program.chmod(self.program.stat().st_mode | stat.S_IXUSR)
        self.world = self.folder / "lab.json"
        self.world.write_text('{"robot": {}}')

    def run_seeds(self, *arguments):
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = seeds.main([str(self.world), "--out", str(self.folder / "out"), "--program", str(self.program), *arguments])
        return code, out.getvalue(), err.getvalue()

    def calls(self, command):
        return [line for line in self.log.read_text().splitlines() if line.startswith(command)]

    def test_median_and_spread_of_each_variant(self):
        code, out, err = self.run_seeds("--seeds", "5", "--variants", "no_lidar=lidar.enabled=false")
        self.assertEqual(code, 0)
        self.assertIn("| figure | default | no_lidar |", out)
        self.assertIn("| ATE, m | 0.300 (0.200 .. 0.400) [0.100 .. 0.500] | 0.600 (0.400 .. 0.800) [0.200 .. 1.000] |", out)
        self.assertIn("| time of the run, s | 7 (7 .. 7) [7 .. 7] |", out)
        self.assertIn("Program rev1.", out, "and not that of the earlier call")
        self.assertNotIn("share of the time", out, "nobody has it")
        self.assertEqual((self.folder / "out/table.md").read_text().strip(), out.strip())
        figures = json.loads((self.folder / "out/figures.json").read_text())
        self.assertEqual([f["trajectory.ate_rmse_m"] for f in figures["lab"]["default"]], [0.1, 0.2, 0.3, 0.4, 0.5])

    def test_one_batch_does_it_all(self):
        self.run_seeds("--seeds", "2", "--first-seed", "4", "--set", "x.always=1", "--variants", "a=x.a=1", "b=x.b=1,x.c=2", "--jobs", "3")
        self.assertEqual(len(self.calls("batch")), 1)
        jobs = json.loads((self.folder / "out/jobs.yaml").read_text())
        self.assertEqual(jobs["inputs"], [{"simulate": {"world": str(self.world.resolve()), "seeds": "4-5"}}])
        self.assertEqual(jobs["variants"][0], {"name": "default", "set": ["x.always=1"]})
        self.assertEqual(jobs["variants"][2], {"name": "b", "set": ["x.always=1", "x.b=1", "x.c=2"]})
        self.assertEqual(jobs["limits"], {"jobs": 3, "threads": 1})

    def test_failed_runs_are_counted_not_hidden(self):
        code, out, err = self.run_seeds("--seeds", "4", "--variants", "broken=x.broken=1")
        self.assertEqual(code, 1)
        self.assertIn("| runs that failed | 0 | 1 |", out)
        self.assertIn("| 3: 0.200 (0.150 .. 0.300) [0.100 .. 0.400] |", out)
        self.assertIn("lab_s3--broken: no luck", err)

    def test_parts(self):
        self.assertEqual(seeds.parse_variant("n=a.b=1,c.d=x,y"), ("n", ["a.b=1", "c.d=x,y"]))
        self.assertEqual(seeds.parse_variant("plain="), ("plain", []))
        for bad in ("=a.b=1", "n=a.b", "a/b=a.b=1"):
            with self.assertRaises(argparse.ArgumentTypeError):
                seeds.parse_variant(bad)
        self.assertEqual(seeds.quantile([3, 1, 2, 10], 0.5), 2.5)
        self.assertEqual(seeds.quantile([7], 0.25), 7)
        self.assertEqual(seeds.spread([], ".1f"), "-")
        self.assertEqual(seeds.spread([2], ".1f"), "2.0")


if __name__ == "__main__":
    unittest.main()
