#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Reproducible build: whether a revision, built twice, gives the same bytes.

    bench/reproducible.py                          # HEAD; two builds without ccache, 10 minutes each on one core
    bench/reproducible.py --revision v0.1 --jobs 2
    bench/reproducible.py --compare BUILD BUILD    # two build folders that are there
    bench/reproducible.py --paths BUILD            # absolute paths of one build and its source, in what users run

The revision is cloned into two folders whose names differ in length, and built by the preset `release`: program, libraries
and plug-ins. Time zone, locale, home folder, umask and number of processors of the second build are others. Every file of bin/ and lib/ is
compared, byte by byte, build id included. Where two differ, the section of the file, the first offset and what stands there are
told. Writes OUT/EXPERIMENT.md; the folders stay (build logs, SHA-256) until the next call.

Exit code 0: the same; 1: not the same, or a build failed; 2: wrong usage; 3: a folder cannot be read.
"""
import argparse
import hashlib
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TARGETS = ("roomgraph", "example_associator", "example_decoder", "example_shape_generator")
SECTION = re.compile(r"^\s*\[\s*\d+\]\s+(\S+)\s+(\S+)\s+[0-9a-f]+\s+([0-9a-f]+)\s+([0-9a-f]+)", re.MULTILINE)


def binaries(build):
    """Files of bin/ and lib/ of a build folder by relative path, without links to them."""
    files = {str(file.relative_to(build)): file for folder in ("bin", "lib") for file in sorted((build / folder).glob("*"))
             if file.is_file() and not file.is_symlink()}
    if not files:
        raise OSError(f"{build}: has no file in bin/ or lib/")
    return files


def shipped(build):
    """Program, libraries and plug-ins without the tests, which know their source tree."""
    return {name: file for name, file in binaries(build).items() if name == "bin/roomgraph" or name.startswith("lib/")}


def sections(file):
    """(name, first byte, end) of the parts of an ELF file that are in it."""
    told = subprocess.run(["readelf", "-SW", file], capture_output=True, text=True, check=False).stdout
    return [(name, int(start, 16), int(start, 16) + int(size, 16)) for name, kind, start, size in SECTION.findall(told)
            if kind != "NOBITS"]


def section_at(file, offset):
    """Name of the part that this byte belongs to."""
    return next((name for name, start, end in sections(file) if start <= offset < end), "headers")


def printable(data, offset):
    return "".join(chr(byte) if 32 <= byte < 127 else "." for byte in data[max(0, offset - 24):offset + 40])


def difference(first, second):
    """Where two files differ first, in words; empty when they have the same bytes."""
    one, other = first.read_bytes(), second.read_bytes()
    if one == other:
        return ""
    shorter = min(len(one), len(other))
    # The build id is a checksum of the rest, and stands before it.
    ids = [range(start, end) for name, start, end in sections(first) if name == ".note.gnu.build-id"]
    offset = next((i for i in range(shorter) if one[i] != other[i] and not any(i in part for part in ids)), shorter)
    if offset == len(one) == len(other):
        return "the build id alone"
    sizes = "" if len(one) == len(other) else f"{len(one)} and {len(other)} bytes; "
    return f"{sizes}byte {offset}, {section_at(first, offset)}: \"{printable(one, offset)}\" and \"{printable(other, offset)}\""


def compare(first, second):
    """(rows of name, size, SHA-256, difference) of two build folders."""
    ours, theirs, rows = binaries(first), binaries(second), []
    for name in sorted(ours.keys() | theirs.keys()):
        if name not in ours or name not in theirs:
            rows.append((name, 0, "", f"only in {first if name in ours else second}"))
        else:
            data = ours[name].read_bytes()
            rows.append((name, len(data), hashlib.sha256(data).hexdigest(), difference(ours[name], theirs[name])))
    return rows


def table(rows):
    bad = [row for row in rows if row[3]]
    lines = [f"{len(rows)} files, {sum(row[1] for row in rows)} bytes: {len(bad)} differ.", "",
             "| file | bytes | SHA-256 | difference |", "| --- " * 4 + "|"]
    return "\n".join(lines + ["| " + " | ".join(map(str, row)) + " |" for row in rows]) + "\n"


def source_of(build):
    """The source tree that a build folder says it was made of."""
    cache = (build / "CMakeCache.txt").read_text(errors="replace")
    return re.search(r"^CMAKE_HOME_DIRECTORY:\w+=(.*)$", cache, re.MULTILINE)[1]


def paths_in(build):
    """Lines of what names the build folder or its source tree, debugging information aside; and of empty folders in search paths."""
    found = []
    with tempfile.TemporaryDirectory() as scratch:
        bare = Path(scratch) / "bare"
        for name, file in shipped(build).items():
            if subprocess.run(["objcopy", "--strip-debug", file, bare], capture_output=True, check=False).returncode:
                continue  # no program
            data = bare.read_bytes()
            for path in {source_of(build), str(build.resolve())}:
                for at in re.finditer(re.escape(path.encode()) + rb"[^\0]{0,60}", data):
                    found.append(f"{name}: {section_at(bare, at.start())}: {at[0].decode(errors='replace')}")
            told = subprocess.run(["readelf", "-d", file], capture_output=True, text=True, check=False).stdout
            for search in re.findall(r"(?:RUNPATH|RPATH).*\[(.*)\]", told):
                found += [f"{name}: search path {search}: libraries are looked for in the working directory"
                          for place in search.split(":") if not place.startswith(("/", "$ORIGIN"))]
    return found


def surroundings(number, folder):
    """Environment of a build; the second one has another."""
    home = folder / "home"
    home.mkdir(parents=True)
    words = {"PATH": "/usr/bin:/bin", "CCACHE_DISABLE": "1", "HOME": str(home), "TZ": "UTC", "LC_ALL": "C"}
    return words if number == 0 else words | {"TZ": "Asia/Kathmandu", "LC_ALL": "C.UTF-8", "USER": "somebody", "COLUMNS": "40"}


def build(options, number, folder):
    """Clones and builds the revision into a folder; the build folder."""
    source, log = folder / "source", folder / "build.log"
    environment = surroundings(number, folder)
    affinity = [] if number == 0 else ["taskset", "-c", str(min(os.sched_getaffinity(0)))]
    steps = [["git", "clone", "--quiet", "--shared", "--no-checkout", ROOT, source],
             ["git", "-C", source, "checkout", "--quiet", "--detach", options.revision],
             ["cmake", "--preset", "release", "-DROOMGRAPH_TESTS=OFF"],
             [*affinity, "cmake", "--build", "--preset", "release", "-j", str(options.jobs), "--target", *TARGETS]]
    with open(log, "wb") as out:
        for step in steps:
            where = source if source.exists() and step[0] != "git" else folder
            if subprocess.run(list(map(str, step)), cwd=where, env=environment, stdout=out, stderr=subprocess.STDOUT,
                              umask=0o022 if number == 0 else 0o077, check=False).returncode:
                raise RuntimeError(f"{' '.join(map(str, step))}: failed; see {log}")
    return source / "build" / "release"


def twice(options):
    """Both builds, one after the other."""
    options.revision = subprocess.run(["git", "-C", str(ROOT), "rev-parse", "--verify", "--quiet", options.revision + "^{commit}"],
                                      capture_output=True, text=True, check=True).stdout.strip()
    shutil.rmtree(options.out, ignore_errors=True)
    folders, built = [options.out / "a", options.out / "another" / "folder with a long name"], []
    for number, folder in enumerate(folders):
        started = time.monotonic()
        print(f"build {number + 1} of 2: {folder}", file=sys.stderr, flush=True)
        built.append(build(options, number, folder))
        print(f"  {time.monotonic() - started:.0f} s", file=sys.stderr, flush=True)
    return built


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--revision", default="HEAD", help="what to build (default: HEAD); changes that are not committed are not in it")
    what.add_argument("--compare", nargs=2, type=Path, metavar="BUILD", help="two build folders")
    what.add_argument("--paths", type=Path, metavar="BUILD", help="a build folder")
    parser.add_argument("--jobs", type=int, default=1, help="compilers at a time (default: 1)")
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "reproducible")
    options = parser.parse_args()
    options.out = options.out.resolve()
    try:
        if options.paths:
            found = paths_in(options.paths)
            print("\n".join(found) if found else f"{len(shipped(options.paths))} files: no path of this build")
            sys.exit(1 if found else 0)
        rows = compare(*(options.compare or twice(options)))
        if not options.compare:
            (options.out / "EXPERIMENT.md").write_text(f"revision {options.revision}\n\n{table(rows)}")
        print(table(rows))
        sys.exit(1 if any(row[3] for row in rows) else 0)
    except subprocess.CalledProcessError:
        parser.error(f"--revision {options.revision}: no such revision")
    except RuntimeError as error:
        print(f"reproducible.py: {error}", file=sys.stderr)
        sys.exit(1)
    except OSError as error:
        print(f"reproducible.py: {error}", file=sys.stderr)
        sys.exit(3)


if __name__ == "__main__":
    main()
