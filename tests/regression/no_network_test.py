#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""`run` in a network namespace of its own, which has no interface: it does the same as with a network.

Usage: no_network_test.py PROGRAM RAWLOG
Skipped where namespaces cannot be made.
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM, RAWLOG = sys.argv[1:3]
del sys.argv[1:3]
ALONE = ["unshare", "--map-root-user", "--net"]
CONNECT = "import socket; socket.create_connection(('127.0.0.1', 9), timeout=1)"


def can_be_alone():
    return shutil.which("unshare") and subprocess.run(ALONE + ["true"], capture_output=True, check=False).returncode == 0


@unittest.skipUnless(can_be_alone(), "no network namespaces here")
class WithoutNetwork(unittest.TestCase):
    def test_there_is_none(self):
        done = subprocess.run(ALONE + [sys.executable, "-c", CONNECT], capture_output=True, text=True, check=False)
        self.assertIn("Network is unreachable", done.stderr)

    def test_a_run_does_the_same(self):
        with tempfile.TemporaryDirectory() as folder:
            results = []
            for name, words in ("usual", []), ("alone", ALONE):
                out = pathlib.Path(folder) / name
                subprocess.run(words + [PROGRAM, "run", RAWLOG, "-o", str(out), "--until", "2", "--no-report"], check=True, capture_output=True)
                results.append([(out / file).read_bytes() for file in ("trajectory.tum", "associations.jsonl", "map.pgm")])
            self.assertEqual(*results)
            self.assertGreater(len(results[0][0]), 1000)


if __name__ == "__main__":
    unittest.main()
