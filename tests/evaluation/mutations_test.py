#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""bench/mutations.py on a tiny project, with a script in place of cmake."""
import contextlib
import importlib.util
import io
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
TOOL = ROOT / "bench" / "mutations.py"
sys.path.insert(0, str(TOOL.parent))
SPEC = importlib.util.spec_from_file_location("mutations", TOOL)
mutations = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(mutations)

# Makes a program of each target: tests/*/TARGET.cpp and all sources of the libraries.
CMAKE = """#!{python}
import pathlib, subprocess, sys
a = sys.argv[1:]
if a[0] == "--preset":
    sys.exit(0)
folder = pathlib.Path(a[1]) / "bin"
folder.mkdir(parents=True, exist_ok=True)
for target in a[3:a.index("--") if "--" in a else None]:
    sources = [*pathlib.Path("libs").rglob("*.cpp"), *pathlib.Path("tests").rglob(target + ".cpp")]
    code = subprocess.run([{compiler!r}, "-std=c++17", "-o", folder / target, *sources]).returncode
    if code != 0:
        sys.exit(1)
"""
COMPILER = os.environ.get("CXX", "c++")
TEST = """#include <cstdio>
{declared}
int check(const char* name, int value, int expected) {{
  std::printf("[ RUN      ] {suite}.%s\\n", name);
  std::fflush(stdout);
  if (value == expected) return 0;
  std::printf("[  FAILED  ] {suite}.%s (0 ms)\\n", name);
  return 1;
}}
int main() {{ return {checks}; }}
"""
FILES = {
    "tests/CMakeLists.txt": "foreach(folder low high)\n  add_subdirectory(${folder})\nendforeach()\n",
    "tests/low/CMakeLists.txt": "roomgraph_add_test(low_test SOURCES x LINK roomgraph::low)\n",
    "tests/high/CMakeLists.txt": "roomgraph_add_test(high_test SOURCES x LINK roomgraph::high)\n",
    "libs/low/CMakeLists.txt": "roomgraph_add_library(low)\n",
    "libs/high/CMakeLists.txt": "roomgraph_add_library(high PUBLIC roomgraph::low)\n",
    "libs/low/src/low.cpp": "int one() {\n  volatile int i = 1;\n  while (i < 0) {\n  }\n  return i + 0;\n}\n"
                            "int two() { return 2; }\n"
                            "int spare() {\n  int s = 3;\n  s = s + 1;\n  return s;  // unseen\n}\n",
    "libs/high/src/high.cpp": "int one();\nint two();\nint sum() { return one() + two(); }\n",
    "tests/low/low_test.cpp": TEST.format(declared="int one();", checks='check("one", one(), 1)', suite="Low"),
    "tests/high/high_test.cpp": TEST.format(declared="int one();\nint sum();", suite="High",
                                            checks='check("one", one(), 1) || check("sum", sum(), 3)'),
    ".gitignore": "build/\n",
}
SOURCE = "libs/low/src/low.cpp"
OWN = {"name": "own", "file": SOURCE, "find": "volatile int i = 1", "replace": "volatile int i = 5"}
ABOVE = {"name": "above", "file": SOURCE, "find": "{ return 2; }", "replace": "{ return 7; }"}
UNSEEN = {"name": "unseen", "file": SOURCE, "find": "int s = 3", "replace": "int s = 4"}
BROKEN = {"name": "broken", "file": SOURCE, "find": "s + 1", "replace": "s +"}
ENDLESS = {"name": "endless", "file": SOURCE, "find": "i < 0", "replace": "i > 0"}
TERM = {"name": "term", "file": SOURCE, "kind": "expression", "find": "i + 0", "replace": "i + 4"}
STEP = {"name": "step", "file": SOURCE, "kind": "statement", "find": "return s;  // unseen", "replace": "return -s;"}
# A declaration is no expression: behind a switch it does not compile.
DECLARED = {"name": "declared", "file": SOURCE, "kind": "expression", "find": "volatile int i = 1;",
            "replace": "volatile int i = 5;"}
SUM = {"name": "sum", "file": "libs/high/src/high.cpp", "kind": "expression", "find": "one() + two()",
       "replace": "one() - two()"}
LOW, HIGH = [OWN, ABOVE, UNSEEN, BROKEN, TERM, STEP], [SUM]


@unittest.skipUnless(shutil.which("git"), "needs git")
class Mutations(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name) / "project"
        for path, text in FILES.items():
            self.write(path, text)
        self.write("bin/cmake", CMAKE.format(python=sys.executable, compiler=COMPILER)).chmod(0o755)
        subprocess.run(["git", "init", "-q", self.root], check=True)
        self.path = f"{self.root / 'bin'}:{os.environ['PATH']}"
        self.addCleanup(os.environ.__setitem__, "PATH", os.environ["PATH"])
        os.environ["PATH"] = self.path
        self.list("low", LOW)
        self.list("high", HIGH)
        self.report = self.root / "build" / "report.json"

    def write(self, path, text):
        file = self.root / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
        return file

    def list(self, library, faults):
        self.write(f"bench/mutations/{library}.json", json.dumps({"library": library, "faults": faults}))

    def call(self, *more):
        self.report.parent.mkdir(exist_ok=True)
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = mutations.main(["--root", str(self.root), "-o", str(self.report), *more])
        return code, out.getvalue(), err.getvalue()

    def results(self):
        return {r["name"]: r for r in json.loads(self.report.read_text())["results"]}

    def assertTreeIsSound(self):
        for path, text in FILES.items():
            self.assertEqual((self.root / path).read_text(), text, path)

    def assertCopyIsSound(self):
        for path, text in FILES.items():
            self.assertEqual((self.root / "build" / "mutations" / "1" / path).read_text(), text, path)

    def verdicts(self):
        return {name: result["verdict"] for name, result in self.results().items()}

    def test_verdicts_and_the_test_that_noticed(self):
        code, out, _ = self.call()
        self.assertEqual(code, 1)
        results = self.results()
        self.assertEqual(self.verdicts(), {"own": "caught", "above": "caught", "term": "caught", "sum": "caught",
                                           "unseen": "survived", "step": "survived", "broken": "not built"})
        self.assertEqual(results["own"]["test"], "Low.one")
        self.assertEqual(results["term"]["test"], "Low.one")
        self.assertEqual((results["above"]["program"], results["above"]["test"]), ("high_test", "High.sum"))
        self.assertEqual(results["sum"]["test"], "High.sum")
        self.assertEqual(results["unseen"]["programs"], ["low_test", "high_test"])
        self.assertIn("error", results["broken"]["output"])
        summary = json.loads(self.report.read_text())["summary"]
        self.assertEqual([summary[k] for k in ("caught", "survived", "not_built", "not_tried")], [4, 2, 1, 0])
        self.assertAlmostEqual(summary["ratio"], 2 / 3)
        self.assertIn("caught 4 of 6 (67%), 0 survivors explained, 1 did not build", out)
        self.assertTreeIsSound()
        self.assertCopyIsSound()

    def test_a_chosen_part(self):
        self.assertEqual(self.call("--library", "high")[0], 0)
        self.assertEqual(list(self.results()), ["sum"])
        self.assertEqual(self.call("--only", "above", "--tests", "low_test")[0], 1)
        self.assertEqual(self.verdicts(), {"above": "survived"})
        self.assertIn("no such library or fault: middle", self.call("--library", "middle")[2])

    def test_an_explained_survivor_is_no_failure(self):
        self.list("low", [{**STEP, "why": "nobody uses it"}])
        code, out, _ = self.call()
        self.assertEqual(code, 0)
        self.assertIn("1 survivors explained", out)
        self.assertIn("nobody uses it", out)

    def test_a_fault_that_does_not_compile_behind_a_switch_is_built_alone(self):
        self.list("low", [DECLARED, STEP, UNSEEN])
        self.list("high", [SUM])
        code, out, err = self.call()
        self.assertEqual(code, 1, err)
        self.assertIn("not behind a switch, as it does not compile there: declared", out)
        self.assertEqual(self.verdicts(), {"declared": "caught", "sum": "caught", "step": "survived", "unseen": "survived"})
        self.assertTreeIsSound()

    def test_several_copies_find_the_same(self):
        self.assertEqual(self.call("--jobs", "2")[0], 1)
        self.assertEqual(list(self.verdicts().values()).count("caught"), 4)
        self.assertTreeIsSound()

    def test_a_fault_that_never_ends_is_caught(self):
        self.addCleanup(setattr, mutations, "LEAST_TIMEOUT_S", mutations.LEAST_TIMEOUT_S)
        mutations.LEAST_TIMEOUT_S = 1
        self.list("low", [{**ENDLESS, "kind": "expression"}])
        self.assertEqual(self.call()[0], 0)
        self.assertEqual(self.results()["endless"]["test"], "before any test (time ran out)")

    def test_a_copy_left_with_a_fault_is_mended(self):
        self.list("low", [OWN])
        self.call("--only", "own")
        (self.root / "build/mutations/1" / SOURCE).write_text("int one() { return 8; }\n")
        (self.root / "build/mutations/1/libs/low/src/more.cpp").write_text("no C++")
        self.assertEqual(self.call("--only", "own")[0], 0)
        self.assertCopyIsSound()

    def test_a_tree_that_fails_by_itself_is_no_measure(self):
        self.write(SOURCE, FILES[SOURCE].replace("return 2", "return 9"))
        self.list("low", [OWN])
        code, _, err = self.call()
        self.assertEqual(code, 2)
        self.assertIn("high_test fails without a fault: High.sum", err)

    def test_lists_that_do_not_fit_are_named(self):
        cases = {"occurs 0 times": {**OWN, "find": "ten = 10"}, "occurs 3 times": {**OWN, "find": "return"},
                 "there is no": {**OWN, "file": "libs/low/src/gone.cpp"}, "unknown ['fnid']": {**OWN, "fnid": ""},
                 "changes nothing": {**OWN, "replace": OWN["find"]}, "occurs 0 times in": {**OWN, "find": ""},
                 "neither expression nor statement": {**OWN, "kind": "word"}}
        for message, fault in cases.items():
            self.list("low", [fault])
            code, _, err = self.call("--list")
            self.assertEqual(code, 2, message)
            self.assertIn("bench/mutations/low.json: fault 'own'", err)
            self.assertIn(message, err)
        self.list("low", [OWN, {**ABOVE, "name": "sum"}])
        self.assertIn("'sum' is in bench/mutations/", self.call("--list")[2])
        self.list("low", [TERM, {**TERM, "name": "wider", "find": "return i + 0;", "kind": "statement"}])
        self.assertIn("overlaps the next one", self.call()[2])
        self.write("bench/mutations/low.json", "{")
        self.assertIn("bench/mutations/low.json: JSONDecodeError", self.call("--list")[2])

    def test_two_calls_do_not_share_a_copy(self):
        with mutations.lock(self.root / "build" / "mutations"):
            code, _, err = self.call("--only", "own")
        self.assertEqual(code, 2)
        self.assertIn("another call works in", err)

    def test_an_interrupted_run_leaves_a_valid_report_and_a_clean_tree(self):
        self.list("low", [ENDLESS, TERM])
        self.report.parent.mkdir(exist_ok=True)
        with subprocess.Popen([sys.executable, TOOL, "--root", self.root, "-o", self.report, "--library", "low"],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as program:
            copy = self.root / "build/mutations/1/libs/low/src/low.cpp"
            for _ in range(600):
                time.sleep(0.05)
                if copy.exists() and "i > 0" in copy.read_text():
                    break
            program.send_signal(signal.SIGINT)
            out, err = program.communicate(timeout=30)
        self.assertEqual(program.returncode, 130, err)
        self.assertIn("1 not tried", out)
        self.assertEqual(list(self.results()), ["term"])
        self.assertTrue(json.loads(self.report.read_text())["summary"]["interrupted"])
        self.assertTreeIsSound()
        self.assertCopyIsSound()


if __name__ == "__main__":
    unittest.main()
