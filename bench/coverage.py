#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Coverage: which lines of the libraries the tests reach.

    bench/coverage.py                                   # builds the preset `coverage`, runs ctest, writes the table
    bench/coverage.py --libraries core,geometry         # builds and runs the tests of these alone, tells of these alone
    bench/coverage.py --no-build --keep                 # with what ran before and the tests that are built: adds up

Needs gcovr (Debian: gcovr). Lines are those that gcc made code of, in libs/; branches are not counted. A line counts as reached when any
test came by, whether or not a test would notice what it does: that is measured by bench/mutations.py. Of all tests those that kill
programs are left out: counters that are not written to their end spoil those of later tests.
Writes OUT/EXPERIMENT.md: lines and share of each library, and each file below the limit with its longest parts that
no test reaches; OUT/lines.json: all counts, as gcovr writes them.

Exit code 0: done, whatever the shares; 1: a build or a test failed (the table is written nevertheless when tests fail);
2: wrong usage, or no gcovr; 3: no counters to read.
"""
import argparse
import json
import os
import shutil
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


# A program that is killed while it writes its counters spoils them, and those of all that come after it are lost.
KILLING_TESTS = "Killed|TwiceCtrlCKills|^SlurmBatch|^SmallQueue|^Vanishing.The"


class Failed(Exception):
    """A step that did not work, in one line, and the exit code."""

    def __init__(self, text, code):
        super().__init__(text)
        self.code = code


def gcovr_counts(root, build, jobs):
    """What gcovr reads out of the counters of a build folder: its JSON."""
    if not any(build.rglob("*.gcda")):
        raise Failed(f"{build}: no counters: no instrumented program has run there", 3)
    done = subprocess.run(["gcovr", "--root", root, "--filter", f"{root}/libs/", "--object-directory", build, "-j", str(jobs),
                           "--gcov-ignore-parse-errors", "--json", "-", build], capture_output=True, text=True, check=False, cwd=root)
    if done.returncode != 0:
        raise Failed(f"gcovr: {done.stderr.strip().splitlines()[-1]}", 1)
    return json.loads(done.stdout)


def lines_of(counts):
    """{path: {line: times}} for the lines that are code."""
    out = defaultdict(dict)
    for file in counts["files"]:
        for line in file["lines"]:
            if not line.get("gcovr/noncode", False):
                lines = out[file["file"]]
                lines[line["line_number"]] = lines.get(line["line_number"], 0) + line["count"]
    return dict(out)


def share(lines):
    return sum(count > 0 for count in lines.values()) / len(lines) if lines else 1.0


def gaps(lines, most=3):
    """The longest rows of neighbouring lines of code that no test reaches, as text: '12-19, 30'."""
    rows, row = [], []
    for number in sorted(lines):
        if lines[number] == 0:
            row.append(number)
        elif row:
            rows.append(row)
            row = []
    rows = sorted(rows + ([row] if row else []), key=len, reverse=True)
    shown = [f"{r[0]}-{r[-1]}" if len(r) > 1 else str(r[0]) for r in sorted(rows[:most])]
    return ", ".join(shown) + (f" and {len(rows) - most} more" if len(rows) > most else "")


def tables(files, limit):
    """Markdown: one row for each library, then each file below the limit."""
    libraries = defaultdict(dict)
    for path, lines in files.items():
        libraries[path.split("/")[1]][path] = lines
    out = ["| library | files | lines | reached | share | files below the limit |", "| --- " * 6 + "|"]
    low, total, hit = [], 0, 0
    for library, parts in sorted(libraries.items()):
        count = sum(map(len, parts.values()))
        reached = sum(times > 0 for lines in parts.values() for times in lines.values())
        below = sorted((share(lines), path) for path, lines in parts.items() if share(lines) < limit)
        low += below
        total, hit = total + count, hit + reached
        out.append(f"| {library} | {len(parts)} | {count} | {reached} | {reached / max(1, count):.1%} | {len(below)} |")
    out.append(f"| all | {len(files)} | {total} | {hit} | {hit / max(1, total):.1%} | {len(low)} |")
    out += ["", f"Files below {limit:.0%}:", "", "| file | lines | share | not reached |", "| --- " * 4 + "|"]
    out += [f"| `{path}` | {len(files[path])} | {part:.0%} | {gaps(files[path])} |" for part, path in sorted(low)]
    return "\n".join(out) + "\n"


def step(words, what, log):
    """A step that takes long: told before it begins, its output in a file; whether it succeeded."""
    print(f"{what} (output: {log})", file=sys.stderr, flush=True)
    with open(log, "wb") as out:
        return subprocess.run([str(word) for word in words], cwd=ROOT, stdout=out, stderr=subprocess.STDOUT, check=False,
                              env=os.environ | {"CCACHE_DISABLE": "1", "GCOV_ERROR_FILE": str(log.parent / "gcov_errors.txt")}).returncode == 0


def build(options):
    targets = ["--target", *(f"{library}_test" for library in options.libraries)] if options.libraries else []
    if not (step(["cmake", "--preset", "coverage", "-B", options.build], "configuring", options.out / "configure.log") and
            step(["cmake", "--build", options.build, "-j", options.jobs, *targets], "building", options.out / "build.log")):
        raise Failed(f"the build failed; see {options.out}", 1)


def run_tests(options):
    """Whether all tests passed."""
    chosen = ["-R", f"^({'|'.join(options.libraries)})$"] if options.libraries else ["-E", KILLING_TESTS]
    if options.tests:
        chosen = ["-R", options.tests]
    if not options.keep:
        for counters in options.build.rglob("*.gcda"):
            counters.unlink()
    return step(["ctest", "--test-dir", options.build, "--timeout", "1800", *chosen], "running tests", options.out / "tests.log")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=ROOT / "build" / "coverage", help="build folder (default: build/coverage)")
    parser.add_argument("--libraries", type=lambda text: text.split(","), default=[], help="names with commas (default: all)")
    parser.add_argument("--tests", help="names of tests for ctest -R instead (a regular expression)")
    parser.add_argument("--no-build", action="store_true", help="the tests are built")
    parser.add_argument("--no-tests", action="store_true", help="the tests have run: only make the table")
    parser.add_argument("--keep", action="store_true", help="add to the counters that are there")
    parser.add_argument("--limit", type=float, default=0.9, help="files below this share are listed (default: 0.9)")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "coverage")
    options = parser.parse_args()
    options.build, options.out = options.build.resolve(), options.out.resolve()
    unknown = [name for name in options.libraries if not (ROOT / "libs" / name).is_dir()]
    if unknown:
        parser.error(f"--libraries: there is no libs/{unknown[0]}")
    if not shutil.which("gcovr"):
        parser.error("gcovr is not there: apt-get install gcovr")
    return options


def main():
    options = arguments()
    options.out.mkdir(parents=True, exist_ok=True)
    try:
        if not options.no_build and not options.no_tests:
            build(options)
        passed = options.no_tests or run_tests(options)
        counts = gcovr_counts(ROOT, options.build, options.jobs)
    except Failed as error:
        print(f"coverage.py: {error}", file=sys.stderr)
        sys.exit(error.code)
    (options.out / "lines.json").write_text(json.dumps(counts))
    files = {path: lines for path, lines in lines_of(counts).items()
             if not options.libraries or path.split("/")[1] in options.libraries}
    text = tables(files, options.limit)
    (options.out / "EXPERIMENT.md").write_text(text)
    print(text)
    if not passed:
        print(f"coverage.py: tests failed; see {options.out / 'tests.log'}", file=sys.stderr)
        sys.exit(1)


if __name__ == "__main__":
    main()
