#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""No notes to self, no paths of one machine, the licence line in every source file, and in C++ files below it a line of
their own that says what the file holds.

Usage: check_text.py ROOT
"""
import re
import sys

import source_files

# Split, so that this file does not contain what it looks for.
FORBIDDEN = re.compile("|".join((r"\bTO" + r"DO\b", r"\bFIX" + r"ME\b", r"\bX" + r"XX\b",
                                 r"(?<![\w.])/" + r"work\b", r"(?<![\w.])/ho" + r"me/")))
LICENCE = "SPDX-License-Identifier: BSD-3-Clause"
TEXTS = {".h", ".cpp", ".py", ".cmake", ".in", ".md", ".ini", ".json", ".sh", ".js", ".css", ".html", "CMakeLists.txt"}
SOURCES = {".h", ".cpp", ".py", ".js", ".css"}
CAPTIONED = {"libs", "apps", "plugins", "tests"}  # folders whose C++ files begin with licence and caption
BANNER = "Part of roomgraph"
LEAST_WORDS = 4
MOST_SHARED = 2  # a header and its source may have one caption


def caption(lines):
    """The second line of a C++ file behind its comment sign, and what is wrong with the first two (or None)."""
    if not lines or lines[0] != f"// {LICENCE}":
        return "", "the first line is not the licence"
    text = lines[1][3:].strip() if len(lines) > 1 and lines[1].startswith("// ") else ""
    if len(text.split()) < LEAST_WORDS or text.startswith(BANNER):
        return "", f"the second line does not say what the file holds (a comment of at least {LEAST_WORDS} words)"
    return text, None


def check(root):
    problems, checked, captions = [], 0, {}
    for path in source_files.files(root, TEXTS):
        checked += 1
        lines = source_files.read(root, path).splitlines()
        problems += [f"{path}:{number}: '{match.group(0)}'"
                     for number, line in enumerate(lines, 1) for match in FORBIDDEN.finditer(line)]
        if path.suffix in SOURCES and not any(LICENCE in line for line in lines[:2]):
            problems.append(f"{path}:1: no licence line ({LICENCE})")
        elif path.suffix in {".h", ".cpp"} and path.parts[0] in CAPTIONED:
            text, problem = caption(lines)
            if problem:
                problems.append(f"{path}:2: {problem}")
            else:
                captions.setdefault(text, []).append(path)
    for text, paths in captions.items():
        problems += [f"{path}:2: '{text}' is said of {paths[0]} already" for path in paths[MOST_SHARED:]]
    return problems, checked


if __name__ == "__main__":
    source_files.finish("text", *check(sys.argv[1]))
