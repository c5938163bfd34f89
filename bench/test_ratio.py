#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Lines of test code for each line of code: per library, and of the whole project.

Usage: test_ratio.py ROOT [--library LEAST] [--overall LEAST]

A line counts when it holds something other than blanks and comments; only C++ is counted. A library libs/X is compared with tests/X;
libs, apps and plugins together with all of tests. Exits with 1 when a ratio is below its limit.
"""
import argparse
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests" / "tooling"))
import cpp_functions  # noqa: E402

CODE = ("libs", "apps", "plugins")


def code_lines(folder):
    """Lines of the C++ files below the folder that hold more than blanks and comments."""
    files = (path for path in sorted(folder.rglob("*")) if path.suffix in {".h", ".cpp"})
    return sum(count(path.read_text(encoding="utf-8")) for path in files)


def count(text):
    return sum(1 for line in cpp_functions.without_comments(text).splitlines() if line.strip())


def table(root):
    """(name, lines of code, lines of tests) of every library, then of the whole project."""
    rows = [(library.name, code_lines(library), code_lines(root / "tests" / library.name))
            for library in sorted((root / "libs").iterdir()) if library.is_dir()]
    return rows + [("overall", sum(code_lines(root / folder) for folder in CODE), code_lines(root / "tests"))]


def too_low(rows, library, overall):
    """Names of the rows below their limit; no code at all is too low, too."""
    limits = [library] * (len(rows) - 1) + [overall]
    return [name for (name, code, tests), least in zip(rows, limits) if code == 0 or tests < least * code]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("root", type=pathlib.Path)
    parser.add_argument("--library", type=float, default=0.5, help="least ratio of every library")
    parser.add_argument("--overall", type=float, default=0.6, help="least ratio of the whole project")
    arguments = parser.parse_args()
    rows = table(arguments.root)
    low = too_low(rows, arguments.library, arguments.overall)
    print(f"{'library':<14}{'code':>7}{'tests':>7}{'ratio':>7}")
    for name, code, tests in rows:
        print(f"{name:<14}{code:>7}{tests:>7}{tests / max(code, 1):>7.2f}{'  too low' if name in low else ''}")
    sys.exit(1 if low else 0)


if __name__ == "__main__":
    main()
