#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""bench/coverage.py tells the lines of a small program that was run, as counted by hand.

Usage: coverage_test.py BENCH_FOLDER
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, sys.argv.pop(1))
import coverage  # noqa: E402  (the script in that folder)

CODE = """int sign(int x) {
  if (x > 0)
    return 1;
  if (x < 0)
    return -1;
  return 0;
}

int never(int x) {
  x += 2;
  return x;
}
"""
MAIN = "int sign(int);\nint main(int argc, char**) { return sign(argc) - 1; }\n"


class Numbers(unittest.TestCase):
    def test_gaps_are_rows_of_lines_of_code(self):
        lines = {1: 1, 2: 0, 5: 0, 6: 3, 7: 0, 9: 0, 10: 0, 11: 2, 12: 0, 13: 1, 14: 0}
        self.assertEqual(coverage.gaps(lines), "2-5, 7-10, 12 and 1 more")
        self.assertEqual(coverage.gaps({1: 1}), "")
        self.assertEqual(coverage.gaps({4: 0}), "4")

    def test_counts_of_one_line_are_added(self):
        counts = {"files": [{"file": "libs/a/src/x.cpp", "lines": [
            {"line_number": 3, "count": 2}, {"line_number": 3, "count": 5}, {"line_number": 4, "count": 0},
            {"line_number": 5, "count": 0, "gcovr/noncode": True}]}]}
        self.assertEqual(coverage.lines_of(counts), {"libs/a/src/x.cpp": {3: 7, 4: 0}})

    def test_a_library_is_the_sum_of_its_files(self):
        text = coverage.tables({"libs/a/src/x.cpp": {1: 1, 2: 1, 3: 1}, "libs/a/src/y.cpp": {1: 0}, "libs/b/src/z.cpp": {1: 1}}, 0.9)
        self.assertIn("| a | 2 | 4 | 3 | 75.0% | 1 |", text)
        self.assertIn("| b | 1 | 1 | 1 | 100.0% | 0 |", text)
        self.assertIn("| all | 3 | 5 | 4 | 80.0% | 1 |", text)
        self.assertIn("| `libs/a/src/y.cpp` | 1 | 0% | 1 |", text)


@unittest.skipUnless(shutil.which("gcovr"), "gcovr is not there")
class SmallProgram(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.root = pathlib.Path(scratch.name).resolve()
        self.source = self.root / "libs" / "small" / "src" / "small.cpp"
        self.build = self.root / "build"
        self.source.parent.mkdir(parents=True)
        self.build.mkdir()
        self.source.write_text(CODE)
        # Several files compiled as one, as the presets do.
        (self.build / "unity.cpp").write_text(f'#include "{self.source}"\n{MAIN}')
        done = subprocess.run(["c++", "-Og", "-g1", "--coverage", "unity.cpp", "-o", "small"], cwd=self.build, capture_output=True,
                              text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_lines_that_ran(self):
        subprocess.run([self.build / "small"], check=True, cwd=self.build)
        files = coverage.lines_of(coverage.gcovr_counts(self.root, self.build, 1))
        self.assertEqual(list(files), ["libs/small/src/small.cpp"])  # not the file that includes it
        lines = files["libs/small/src/small.cpp"]
        reached = {number for number, count in lines.items() if count}
        self.assertLessEqual({1, 2}, reached)
        self.assertEqual({9, 10, 11} & set(lines) - reached, {9, 10, 11} & set(lines))
        self.assertIn(9, lines)
        self.assertNotIn(8, lines)

    def test_without_counters_it_says_so(self):
        with self.assertRaises(coverage.Failed) as caught:
            coverage.gcovr_counts(self.root, self.build, 1)
        self.assertEqual(caught.exception.code, 3)
        self.assertIn("no instrumented program has run there", str(caught.exception))


if __name__ == "__main__":
    unittest.main()
