#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""bench/table1.py with a program of known answers in place of roomgraph, on made-up folders."""
import contextlib
import io
import json
import pathlib
import random
import stat
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
import table1  # noqa: E402
from made_up_batch import BEGINNING  # noqa: E402

# An import writes rawlog and truth (none for a folder whose name has "blind"). A run's ATE is 0.1 m for the seed it is of; cuboids
# only has twice, no landmarks four times that. fr1/floor fails.
IMPORT = """if a[:2] == ["import", "tum"]:
    rawlog = pathlib.Path(a[4])
    rawlog.write_text("rawlog")
    if list(pathlib.Path(a[2]).glob("groundtruth.txt")) + list(pathlib.Path(a[2]).glob("*.gt.freiburg")):
        rawlog.with_suffix(".groundtruth.txt").write_text("truth")
    sys.exit(0)
if a[0] != "batch\""""
FAKE = BEGINNING.replace('if a[0] != "batch"', IMPORT, 1) + """db.execute("ALTER TABLE inputs ADD COLUMN path")
for job in jobs["inputs"]:
    seed = int(job["files"].split("seed")[1][0])
    id = db.execute("INSERT INTO inputs(input_group, path) VALUES(?, ?)", [job["group"], job["files"]]).lastrowid
    for variant in jobs["variants"]:
        name, floor = f"{{pathlib.Path(job['files']).stem}}--{{variant['name']}}", job["group"] == "fr1/floor"
        failed += floor
        db.execute("INSERT INTO runs VALUES(?, ?, ?, ?, ?, 'rev1')", [name, id, variant["name"], "failed" if floor else "complete", "lost" if floor else ""])
        ate = 0.1 * seed * {{"ours": 1, "cuboids_only": 2, "no_landmarks": 4}}[variant["name"]]
        for figure, value in (("trajectory.ate_rmse_m", ate), ("trajectory.coverage", 0.5 if variant["name"] == "ours" else 1), ("run.wall_s", 3)):
            if not floor:
                db.execute("INSERT INTO figures VALUES(?, ?, ?)", [name, figure, value])
db.commit()
sys.exit(1 if failed else 0)
"""


class Table1(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.disk = self.folder / "disk"
        self.disk.mkdir()
        self.program = self.folder / "roomgraph"
        self.program.write_text(FAKE.format(python=sys.executable, log=str(self.folder / "log")))
        self.program.chmod(self.program.stat().st_mode | stat.S_IXUSR)

    def tum(self, name, truth=True, camera=False):
        place = self.disk / name
        place.mkdir(parents=True)
        (place / "rgb.txt").write_text("# colour\n" + "".join(f"{i}.5 rgb/{i}.png\n" for i in range(200)))
        (place / "depth.txt").write_text("0.5 depth/0.png\n")
        if truth:
            (place / "groundtruth.txt").write_text("0.5 0 0 0 0 0 0 1\n")
        if camera:
            (place / "camera.json").write_text("{}")
        return place

    def icl(self, name, truth_in=None):
        place = self.disk / name
        place.mkdir(parents=True)
        (place / "associations.txt").write_text("".join(f"{i} depth/{i}.png {i} rgb/{i}.png\n" for i in range(200)))
        if truth_in is not None:
            (truth_in / "livingRoom1.gt.freiburg").write_text("0 0 0 0 0 0 0 1\n")
        return place

    def run_table(self, *arguments):
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = table1.main([str(self.disk), "--out", str(self.folder / "out"), "--program", str(self.program), *arguments])
        return code, out.getvalue(), err.getvalue()

    def imports(self):
        return [line.split() for line in (self.folder / "log").read_text().splitlines() if line.startswith("import")]

    def row(self, out, name):
        return next(line for line in out.splitlines() if line.startswith(f"| {name} |"))

    def test_rows_stand_beside_the_papers(self):
        self.tum("tum/rgbd_dataset_freiburg1_desk")
        code, out, err = self.run_table()
        self.assertEqual(code, 0)
        self.assertEqual(self.row(out, "fr1/desk"), "| fr1/desk | 0.021 | 0.028 | 0.022 | 0.400 | 0.200 | 0.100, 0.50 of the time |")
        self.assertEqual(self.row(out, "fr2/desk"), "| fr2/desk | 0.014 | 0.019 | 0.013 | not found | not found | not found |")
        self.assertIn("not found below", err)
        self.assertEqual((self.folder / "out/table.md").read_text().strip(), out.strip())
        [figures] = json.loads((self.folder / "out/figures.json").read_text())
        self.assertEqual(figures["ours"]["run.seconds"], 3)

    def test_one_batch_has_all_arms_without_loops(self):
        self.tum("rgbd_dataset_freiburg2_desk")
        self.run_table("--set", "x.y=1", "--jobs", "3")
        jobs = json.loads((self.folder / "out/jobs.yaml").read_text())
        rawlog = str((self.folder / "out/recordings/fr2_desk.seed1.rawlog").resolve())
        self.assertEqual(jobs["inputs"], [{"files": rawlog, "group": "fr2/desk",
                                           "truth": {"camera_trajectory": rawlog.replace(".rawlog", ".groundtruth.txt")}}])
        sets = {variant["name"]: variant["set"] for variant in jobs["variants"]}
        for settings in sets.values():
            self.assertEqual(settings[:4], ["tracking.loop_closing=false", "lidar.loop_closing=false", "object_loop_closing.enabled=false", "x.y=1"])
        self.assertEqual(sets["ours"][4:], [])
        self.assertEqual(sets["no_landmarks"][4:], ["landmarks.enabled=false"])
        [objects] = sets["cuboids_only"][4:]
        self.assertTrue(pathlib.Path(objects.partition("=")[2]).is_file())
        self.assertEqual(jobs["limits"], {"jobs": 3, "threads": 1})

    def test_every_sequence_is_known_by_its_published_name(self):
        names = ["living_room_traj1_frei_png", "living_room_traj2_frei_png", "traj1_frei_png", "traj2_frei_png", "rgbd_dataset_freiburg1_360",
                 "rgbd_dataset_freiburg1_floor", "rgbd_dataset_freiburg1_desk", "rgbd_dataset_freiburg2_desk",
                 "rgbd_dataset_freiburg3_long_office_household"]
        for name in names:
            self.tum(f"a/b/{name}")
        self.tum("rgbd_dataset_freiburg1_desk2")
        self.tum("a/rgbd_dataset_freiburg3_long_office_household_validation_of_ours")
        found, problems = table1.find(self.disk)
        self.assertEqual({name: folder.name for name, folder in found.items()}, dict(zip([s.name for s in table1.SEQUENCES], names)))
        self.assertEqual(problems, [])

    def test_archives_in_folders_of_their_name_and_doubles(self):
        self.tum("x/rgbd_dataset_freiburg1_desk/data")
        self.tum("y/freiburg1_desk")
        self.tum("1/2/3/4/5/rgbd_dataset_freiburg1_360")
        found, [problem] = table1.find(self.disk)
        self.assertEqual(found, {"fr1/desk": self.disk / "x/rgbd_dataset_freiburg1_desk/data"})
        self.assertIn("y/freiburg1_desk is left out", problem)

    def test_cameras_and_stamps(self):
        self.tum("rgbd_dataset_freiburg1_desk")
        self.tum("rgbd_dataset_freiburg1_360", camera=True)
        self.icl("living_room_traj1_frei_png", truth_in=self.disk)
        code, out, _ = self.run_table()
        self.assertEqual(code, 0)
        words = {pathlib.Path(line[4]).name.split(".")[0]: line for line in self.imports()}
        self.assertEqual(words["fr1_desk"][5:], ["--external-images", "--camera", "freiburg1"])
        self.assertEqual(words["fr1_360"][5:], ["--external-images"])
        self.assertEqual(words["Living1"][5:], ["--external-images", "--camera", "icl", "--frame-rate", "30"])
        self.assertTrue((pathlib.Path(words["Living1"][2]) / "livingRoom1.gt.freiburg").exists(), "the truth from beside the folder")
        self.assertIn("| Living1 | 0.041 | 0.039 | 0.043 | 0.400 |", out)

    def test_a_folder_without_truth_is_told(self):
        self.icl("living_room_traj1_frei_png")
        code, _, err = self.run_table()
        self.assertEqual(code, 1)
        self.assertIn("has no ground truth (groundtruth.txt, or livingRoom1*.gt.freiburg in or beside it)", err)

    def test_seeds_thin_the_lists_and_show_the_spread(self):
        place = self.tum("rgbd_dataset_freiburg1_desk")
        code, out, _ = self.run_table("--seeds", "3")
        self.assertEqual(code, 0)
        self.assertIn("0.800 (0.400 .. 1.200)", self.row(out, "fr1/desk"))
        folders = [pathlib.Path(line[2]) for line in self.imports()]
        self.assertEqual(folders[0], place)
        lists = [(folder / "rgb.txt").read_text() for folder in folders]
        self.assertEqual(len(set(lists)), 3)
        for text in lists[1:]:
            self.assertTrue(text.startswith("# colour\n"))
            self.assertTrue(set(text.splitlines()) < set(lists[0].splitlines()))
        self.assertEqual((folders[1] / "depth.txt").read_text(), "0.5 depth/0.png\n")

    def test_a_twentieth_is_left_out(self):
        text = "".join(f"{i} x.png\n" for i in range(20000))
        left = table1.thinned(text, random.randrange(1, 1000)).count("\n")
        self.assertAlmostEqual(left / 20000, 0.95, delta=0.01)  # six standard deviations of the binomial
        self.assertEqual(table1.thinned(text, 7), table1.thinned(text, 7))

    def test_imports_are_used_again_until_the_folder_changes(self):
        place = self.tum("rgbd_dataset_freiburg1_desk")
        self.run_table()
        self.run_table()
        self.assertEqual(len(self.imports()), 1)
        (place / "groundtruth.txt").write_text("0.5 1 0 0 0 0 0 1\n")
        self.run_table()
        self.assertEqual(len(self.imports()), 2)

    def test_failed_runs_are_told_not_hidden(self):
        self.tum("rgbd_dataset_freiburg1_floor")
        self.tum("rgbd_dataset_freiburg1_desk")
        code, out, err = self.run_table()
        self.assertEqual(code, 1)
        self.assertEqual(self.row(out, "fr1/floor"), "| fr1/floor | 0.068 | 1.157 | 2.128 | - | - | - |")
        self.assertIn("fr1_floor.seed1--ours: lost", err)

    def test_nothing_found_and_lists(self):
        code, _, err = self.run_table()
        self.assertEqual(code, 3)
        self.assertIn("Living1, Living2, Office1", err)
        place = self.tum("rgbd_dataset_freiburg1_desk")
        code, out, err = self.run_table("--list", "--only", "fr1/desk")
        self.assertEqual((code, out, err), (0, f"fr1/desk: {place}\n", ""))
        self.assertFalse((self.folder / "log").exists())


if __name__ == "__main__":
    unittest.main()
