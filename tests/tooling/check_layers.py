#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A library includes and links only strictly lower levels; heavy dependencies stay out of public headers, windows in gui/.

Usage: check_layers.py ROOT
"""
import re
import sys

import source_files

LEVELS = {"core": 0, "geometry": 1, "observations": 2,
          "datasets": 3, "detection": 3, "tracking": 3, "lidar": 3, "proposals": 3, "selection": 3, "association": 3,
          "backend": 3, "mapping": 3, "simulation": 3, "calibration": 3,
          "estimation": 4, "evaluation": 4, "pipeline": 5, "rendering": 6, "graphslam": 6}
PRIVATE = re.compile(r"opencv2/(dnn|features2d|xfeatures2d|calib3d|video)\b|ceres/|nanoflann|CLI/|nlohmann/json\.hpp")
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)
LINK = re.compile(r"\broomgraph(?:::|_)(\w+)")
WINDOWS = re.compile(r"\bmrpt(?:/|::|-)gui\b")


def used_library(include):
    parts = include.split("/")
    return parts[1] if parts[0] == "roomgraph" and len(parts) > 2 else None


def check_use(library, used, place):
    """A sentence about what is wrong with `library` using `used`, or None."""
    if used == library:
        return None
    if used not in LEVELS:
        return f"{place}: unknown library '{used}'"
    if LEVELS[used] < LEVELS[library]:
        return None
    direction = "sideways" if LEVELS[used] == LEVELS[library] else "upwards"
    return f"{place}: {library} (level {LEVELS[library]}) reaches {direction} to {used} (level {LEVELS[used]})"


def check_includes(path, text, library):
    for match in INCLUDE.finditer(text):
        include, line = match.group(1), text[:match.start(1)].count("\n") + 1
        place = f"{path}:{line}"
        if ".." in include.split("/"):
            yield f"{place}: include path leaves its folder: {include}"
        used = used_library(include)
        if used is not None:
            yield check_use(library, used, place)
        if "include" in path.parts and PRIVATE.match(include):
            yield f"{place}: {include} belongs into src/, not into a public header"


def check_links(path, text, library):
    for match in LINK.finditer(text):
        if match.group(1) in LEVELS:
            yield check_use(library, match.group(1), f"{path}:{text[:match.start()].count(chr(10)) + 1}")


def check(root):
    problems, checked = [], 0
    for path in source_files.files(root, {".h", ".cpp", "CMakeLists.txt"}):
        if path.parts[0] != "gui" and WINDOWS.search(source_files.read(root, path)):
            problems.append(f"{path}: only gui/ opens windows (mrpt-gui)")
        if path.parts[0] != "libs" or len(path.parts) < 3:
            continue
        checked += 1
        library = path.parts[1]
        if library not in LEVELS:
            problems.append(f"{path}: library '{library}' has no level; see LEVELS in check_layers.py")
            continue
        look = check_links if path.name == "CMakeLists.txt" else check_includes
        problems += [p for p in look(path, source_files.read(root, path), library) if p]
    return problems, checked


if __name__ == "__main__":
    source_files.finish("layers", *check(sys.argv[1]))
