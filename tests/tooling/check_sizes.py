#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""No file over 400 lines, no function over 60.

Usage: check_sizes.py ROOT
Exceptions stand in size_allowed.txt beside this script: "path lines reason" or "path:function lines reason". One that
is no longer needed is a problem, too.
"""
import pathlib
import re
import sys

import cpp_functions
import source_files

MAX_FILE, MAX_FUNCTION = 400, 60


def read_allowed(file):
    allowed = {}
    if not file.exists():
        return allowed
    for line in file.read_text(encoding="utf-8").splitlines():
        if not line.strip() or line.startswith("#"):
            continue
        match = re.match(r"(\S+)\s+(\d+)\s+(\S.*)$", line)
        if not match:
            raise SystemExit(f"{file.name}: expected 'path[:function] lines reason', got '{line}'")
        allowed[match.group(1)] = int(match.group(2))
    return allowed


def check(root, allowed_file):
    allowed = read_allowed(allowed_file)
    problems, needed, checked = [], set(), 0

    def judge(name, place, lines, limit, what):
        if lines <= limit:
            return
        needed.add(name)
        if lines > allowed.get(name, 0):
            problems.append(f"{place}: {what} of {lines} lines, at most {max(limit, allowed.get(name, 0))}")

    for path in source_files.files(root, {".h", ".cpp", ".py", ".js", ".css", ".html"}):
        checked += 1
        text = source_files.read(root, path)
        judge(str(path), str(path), text.count("\n"), MAX_FILE, "file")
        if path.suffix not in {".h", ".cpp", ".js"}:
            continue
        for function in cpp_functions.find(text):
            judge(f"{path}:{function.name}", f"{path}:{function.line}", function.lines, MAX_FUNCTION,
                  f"function {function.name}")
    problems += [f"size_allowed.txt: '{name}' needs no exception any more" for name in sorted(set(allowed) - needed)]
    return problems, checked


if __name__ == "__main__":
    source_files.finish("sizes", *check(sys.argv[1], pathlib.Path(__file__).parent / "size_allowed.txt"))
