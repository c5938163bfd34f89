# SPDX-License-Identifier: BSD-3-Clause
"""A simulated drive (worlds/small_loop.json) that tests damage, run and compare with its truth. Takes PROGRAM and SOURCE from the command line."""
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
LARGEST_ERROR_M = 0.008  # of a path that nothing disturbs; 0.004 as it is


def call(*words):
    return subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, check=True)


class SmallLoop(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.simulated = cls.folder / "simulated"
        call("simulate", SOURCE / "worlds" / "small_loop.json", "-o", cls.simulated, "--quiet")

    def damaged(self, *words):
        rawlog = self.folder / "damaged.rawlog"
        call("damage", self.simulated / "small_loop.rawlog", "-o", rawlog, *words)
        return rawlog

    def run_words(self, rawlog, out, *words):
        return ("run", rawlog, "-o", out, "--no-snapshot", *words)

    def error(self, out):
        file = self.folder / "score.json"
        call("evaluate", "trajectory", self.simulated / "groundtruth_robot.txt", out / "trajectory.tum", "--json", file)
        return json.loads(file.read_text())["ate_rmse_m"]

    def summary(self, out):
        return json.loads((out / "summary.json").read_text())

    def kill(self, words, out, begun):
        """Kills a run that has begun so often, some time after its beginning; returns what it said."""
        run = subprocess.Popen([PROGRAM, *map(str, words)], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        checkpoint, live = out / "roomgraph_checkpoint" / "run.json", out / "roomgraph_unfinished" / "live.tum"
        for _ in range(6000):
            if checkpoint.exists() and f'"begun": {begun},' in checkpoint.read_text() and live.exists() and live.stat().st_size > 4000:
                break
            time.sleep(0.005)
        run.send_signal(signal.SIGKILL)
        said = run.communicate()[1]
        self.assertEqual(run.returncode, -signal.SIGKILL, "it had ended before it was killed")
        return said

    def assertSameResults(self, out, other):
        for name in ("trajectory.tum", "live.tum", "landmarks.json", "graph.g2o", "map.rgmap"):
            self.assertEqual((out / name).read_bytes(), (other / name).read_bytes(), name)
