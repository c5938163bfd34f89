#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A library includes and links only strictly lower levels; heavy dependencies stay out of public headers, windows in gui/.
The table of libraries in docs/architecture.md has the same levels.

Usage: check_layers.py ROOT
"""
import pathlib
import re
import sys

import source_files

LEVELS = {"core": 0, "models": 1, "geometry": 1, "catalogue": 1, "observations": 2,
          "datasets": 3, "detection": 3, "tracking": 3, "lidar": 3, "proposals": 3, "selection": 3, "association": 3,
          "backend": 3, "mapping": 3, "simulation": 3,
          "estimation": 4, "evaluation": 4, "maptools": 4, "faults": 4, "calibration": 4, "imports": 4, "bags": 5, "pipeline": 5, "report": 5, "rendering": 6, "graphslam": 6, "batch": 6, "viewer": 7}
PRIVATE = re.compile(r"opencv2/(dnn|features2d|xfeatures2d|calib3d|video)\b|ceres/|nanoflann|CLI/|nlohmann/json\.hpp|curl/|openssl/|sqlite3\.h|yaml-cpp/")
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)
LINK = re.compile(r"\broomgraph(?:::|_)(\w+)")
TABLE = pathlib.Path("docs/architecture.md")
ROW = re.compile(r"^\| (\d+) \| (\w+) \|", re.MULTILINE)
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


def check_table(root, libraries):
    """Rows "| level | library | ..." of the document against LEVELS and the folders of libs/."""
    page = root / TABLE
    if not page.exists():
        return
    rows = {name: int(level) for level, name in ROW.findall(page.read_text(encoding="utf-8"))}
    for name in sorted(libraries | rows.keys()):
        if name not in rows:
            yield f"{TABLE}: library '{name}' is missing in the table"
        elif name not in libraries:
            yield f"{TABLE}: there is no library '{name}'"
        elif rows[name] != LEVELS.get(name):
            yield f"{TABLE}: '{name}' has level {rows[name]}, check_layers.py says {LEVELS.get(name)}"


def check(root):
    problems, checked, libraries = [], 0, set()
    for path in source_files.files(root, {".h", ".cpp", "CMakeLists.txt"}):
        if path.parts[0] != "gui" and WINDOWS.search(source_files.read(root, path)):
            problems.append(f"{path}: only gui/ opens windows (mrpt-gui)")
        if path.parts[0] != "libs" or len(path.parts) < 3:
            continue
        checked += 1
        library = path.parts[1]
        libraries.add(library)
        if library not in LEVELS:
            problems.append(f"{path}: library '{library}' has no level; see LEVELS in check_layers.py")
            continue
        look = check_links if path.name == "CMakeLists.txt" else check_includes
        problems += [p for p in look(path, source_files.read(root, path), library) if p]
    problems += check_table(pathlib.Path(root), libraries)
    return problems, checked


if __name__ == "__main__":
    source_files.finish("layers", *check(sys.argv[1]))
