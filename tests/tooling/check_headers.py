#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The public headers are those on a list, and somebody outside their library needs each of them.

Usage: check_headers.py ROOT

A header in libs/X/include is needed when another library, an app, a plug-in or the consumer of the installed package
includes it, or a public header of its own library that is needed. Any other belongs into libs/X/src. The list is
public_headers.txt beside this script, one "X/name.h" a line; with a reason behind it the header may be without a user
here: it is for programs outside of the project.
"""
import collections
import pathlib
import re
import sys

import source_files

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*[<"]roomgraph/([^>"]+)[>"]', re.MULTILINE)
USERS = {"libs", "apps", "gui", "plugins"}
CONSUMER = ("tests", "tooling", "consumer")


def read_list(file):
    """The header's name -> reason to be public without a user ("" if none)."""
    if not file.exists():
        return {}
    lines = (line.strip() for line in file.read_text(encoding="utf-8").splitlines())
    return dict((line.split(None, 1) + [""])[:2] for line in lines if line and not line.startswith("#"))


def public_name(path):
    """"X/name.h" of a public header of library X, or None."""
    parts = path.parts
    public = parts[0] == "libs" and parts[2:4] == ("include", "roomgraph") and path.suffix == ".h"
    return "/".join(parts[4:]) if public else None


def inclusions(root, paths):
    """(names of the headers included from outside their library, own public header -> those it includes)."""
    outside, own = set(), collections.defaultdict(set)
    for path in paths:
        if path.parts[0] not in USERS and path.parts[:3] != CONSUMER:
            continue
        library = path.parts[1] if path.parts[0] == "libs" else None
        for name in INCLUDE.findall(source_files.read(root, path)):
            if name.split("/")[0] != library:
                outside.add(name)
            elif public_name(path):
                own[public_name(path)].add(name)
    return outside, own


def reached(start, edges):
    found, new = set(), set(start)
    while new:
        found |= new
        new = {name for known in new for name in edges.get(known, ())} - found
    return found


def check(root, list_file):
    paths = source_files.files(root, {".h", ".cpp"})
    public = {public_name(path): path for path in paths if public_name(path)}
    listed = read_list(list_file)
    outside, own = inclusions(root, paths)
    needed = reached(outside | {name for name, reason in listed.items() if reason}, own)
    problems = [f"{path}: no other library, app or plug-in includes it: it belongs into src/"
                for name, path in public.items() if name not in needed]
    problems += [f"{path}: is not in {list_file.name}" for name, path in public.items() if name not in listed]
    problems += [f"{list_file.name}: there is no public header '{name}'" for name in listed if name not in public]
    problems += [f"{list_file.name}: '{name}' has users: it needs no reason"
                 for name, reason in listed.items() if reason and name in reached(outside, own)]
    return problems, len(public)


if __name__ == "__main__":
    source_files.finish("headers", *check(sys.argv[1], pathlib.Path(__file__).parent / "public_headers.txt"))
