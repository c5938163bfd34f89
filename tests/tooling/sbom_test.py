#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The bill of materials of the program: every library of Debian that the loader finds is in it, with the version of dpkg.

Usage: sbom_test.py PROGRAM SBOM.py
"""
import json
import pathlib
import subprocess
import sys
import unittest

PROGRAM, SBOM = sys.argv[1:3]
del sys.argv[1:3]


def run(*words):
    return subprocess.run(words, capture_output=True, text=True, check=False)


class BillOfMaterials(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.text = run(sys.executable, SBOM, PROGRAM).stdout
        cls.packages = {entry["name"]: entry for entry in json.loads(cls.text)["packages"]}

    def test_has_the_version_that_dpkg_tells(self):
        for name in "libmrpt-obs2.5", "zlib1g", "libopencv-dnn406":
            told = run("dpkg-query", "-W", "-f", "${Version}", name).stdout
            self.assertEqual(self.packages[name]["versionInfo"], told)

    def test_names_what_the_loader_maps(self):
        # Another source than ldd's list: the files that the running program has in memory.
        script = f'import ctypes; ctypes.CDLL("{pathlib.Path(PROGRAM).parent.parent}/lib/libroomgraph_datasets.so")\n'
        script += 'print(*{line.split()[-1] for line in open("/proc/self/maps") if ".so" in line})'
        mapped = [file for file in run(sys.executable, "-c", script).stdout.split() if "mrpt" in file]
        self.assertGreater(len(mapped), 5)
        for file in mapped:
            owner = run("dpkg", "-S", pathlib.Path(file).name).stdout.split(":")[0]
            self.assertIn(owner, self.packages, file)

    def test_is_the_same_each_time(self):
        self.assertEqual(run(sys.executable, SBOM, PROGRAM).stdout, self.text)

    def test_what_is_no_program_is_told(self):
        for wrong in SBOM, "/nowhere/roomgraph":
            done = run(sys.executable, SBOM, wrong)
            self.assertEqual(done.returncode, 3)
            self.assertIn(wrong, done.stderr)
            self.assertEqual(done.stderr.count("\n"), 1)


if __name__ == "__main__":
    unittest.main()
