#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What all source checks share: which files there are, and how a check reports."""
import pathlib
import sys

FOLDERS = ("libs", "apps", "gui", "plugins", "tests", "fuzz", "bench", "cmake", "docs", "rawlogs", "worlds")
SKIPPED = {"build", "out", ".git", ".cache", "__pycache__"}


def files(root, suffixes):
    """Files of the project with one of the suffixes (or exact names), sorted, relative to root."""
    root = pathlib.Path(root)
    found = [p for p in root.iterdir() if p.is_file()]
    for folder in FOLDERS:
        found += [p for p in (root / folder).rglob("*") if p.is_file()]
    relative = [p.relative_to(root) for p in found]
    return sorted(p for p in relative
                  if not SKIPPED & set(p.parts) and (p.suffix in suffixes or p.name in suffixes))


def read(root, path):
    return (pathlib.Path(root) / path).read_text(encoding="utf-8")


def finish(name, problems, checked):
    """Prints the problems and exits; a check that looked at nothing has failed, too."""
    for problem in problems:
        print(problem)
    if checked == 0:
        print(f"{name}: found nothing to check")
    print(f"{name}: {checked} files, {len(problems)} problems")
    sys.exit(1 if problems or checked == 0 else 0)
