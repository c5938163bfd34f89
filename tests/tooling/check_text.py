#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# Part of roomgraph, object-level semantic SLAM.
"""No notes to self, no paths of one machine, and the licence line in every source file.

Usage: check_text.py ROOT
"""
import re
import sys

import source_files

# Split, so that this file does not contain what it looks for.
FORBIDDEN = re.compile("|".join((r"\bTO" + r"DO\b", r"\bFIX" + r"ME\b", r"\bX" + r"XX\b",
                                 r"(?<![\w.])/" + r"work\b", r"(?<![\w.])/ho" + r"me/")))
LICENCE = "SPDX-License-Identifier: BSD-3-Clause"
TEXTS = {".h", ".cpp", ".py", ".cmake", ".in", ".md", ".ini", ".json", ".sh", "CMakeLists.txt"}
SOURCES = {".h", ".cpp", ".py"}


def check(root):
    problems, checked = [], 0
    for path in source_files.files(root, TEXTS):
        checked += 1
        lines = source_files.read(root, path).splitlines()
        problems += [f"{path}:{number}: '{match.group(0)}'"
                     for number, line in enumerate(lines, 1) for match in FORBIDDEN.finditer(line)]
        if path.suffix in SOURCES and not any(LICENCE in line for line in lines[:2]):
            problems.append(f"{path}:1: no licence line ({LICENCE})")
    return problems, checked


if __name__ == "__main__":
    source_files.finish("text", *check(sys.argv[1]))
