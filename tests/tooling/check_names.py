#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""No type name is defined twice in libs/: the libraries are shared, so two definitions of one name in the same namespace
are one and the same to the linker, whatever they hold (One Definition Rule). Anonymous namespaces of different libraries
are free; those of one library are not, because a unity build compiles several of its files as one. The same holds for
constants (kName) and other names of types (using) at the beginning of a line, wherever they are defined.

Usage: check_names.py ROOT
"""
import re
import sys

import cpp_functions
import source_files

SCOPE = re.compile(r"\b(?P<kind>namespace|class|struct|union|enum(?:\s+class|\s+struct)?)\b"
                   r"(?:\s*\[\[[^\]]*\]\])*\s*(?P<name>[A-Za-z_][\w:]*)?\s*(?:final\b)?[^;{}()=]*\{|[{}]")
TEMPLATE = re.compile(r"\btemplate\s*<[^<>]*(?:<[^<>]*>[^<>]*)*>")  # its "class T" is no class


CONSTANTS = re.compile(r"^(?:inline |static )?const(?:expr)? (?P<defined>[^;]*);", re.MULTILINE)
CONSTANT = re.compile(r"\b(?P<name>k[A-Z]\w*)\s*[={\[(]")

ALIAS = re.compile(r"^using (?P<name>\w+) =(?P<meaning>[^;]*);", re.MULTILINE)

ANONYMOUS = "(anonymous)"


def types_of(text):
    """(namespace, name, line) of every type defined at namespace level; anonymous ones are called ANONYMOUS."""
    scopes = []  # name of the namespace, None for everything that is none
    text = TEMPLATE.sub(lambda m: "\n" * m.group(0).count("\n"), cpp_functions.blanked(text))
    for match in SCOPE.finditer(text):
        if match.group(0) == "}":
            if scopes:
                scopes.pop()
        elif match.group(0) == "{":
            scopes.append(None)
        elif match.group("kind") == "namespace":
            scopes.append(match.group("name") or ANONYMOUS)
        else:
            name = match.group("name")
            if name and "::" not in name and None not in scopes:
                yield "::".join(scopes), name, text.count("\n", 0, match.start("name")) + 1
            scopes.append(None)


def without_values(definition):
    """Of what stands in brackets, and behind an equals sign, nothing is defined here. Places stay."""
    out, depth = [], 0
    for c in definition:
        depth -= c in ")]}"
        out.append(" " if depth > 0 and c != "\n" else c)
        depth += c in "([{"
    return re.sub(r"=[^,;]*", lambda m: "=" + " " * (len(m.group(0)) - 1), "".join(out))


def constants_of(text):
    """(name, line) of every constant of a file that is not local to something."""
    text = cpp_functions.blanked(text)
    for many in CONSTANTS.finditer(text):
        begin = many.start("defined")
        names = without_values(many.group("defined"))
        for one in CONSTANT.finditer(names):
            yield one.group("name"), text.count("\n", 0, begin + one.start("name")) + 1


def aliases_of(text):
    """(name, meaning, line) of every other name for a type."""
    text = cpp_functions.blanked(text)
    for match in ALIAS.finditer(text):
        yield match.group("name"), match.group("meaning"), text.count("\n", 0, match.start()) + 1


def check(root):
    first, in_library, problems, checked = {}, {}, [], 0

    def only_here(name, path, line, meaning=None):
        """What a unity build would see twice. Within one file the preprocessor may choose; an alias may be repeated as it is."""
        there, at, meant = in_library.setdefault((name, path.parts[1]), (path, line, meaning))
        if there != path and (meaning is None or meaning != meant):
            problems.append(f"{path}:{line}: {name} is defined at {there}:{at} already")

    for path in source_files.files(root, {".h", ".cpp"}):
        if path.parts[0] != "libs":
            continue
        checked += 1
        text = source_files.read(root, path)
        for scope, name, line in types_of(text):
            place = f"{path}:{line}"
            # An anonymous type is a rival to the other anonymous types of its library only.
            key = (scope, name, path.parts[1] if ANONYMOUS in scope else None)
            if key in first:
                problems.append(f"{place}: {scope}::{name} is defined at {first[key]} already")
            elif ANONYMOUS in scope:
                only_here(name, path, line)
            first.setdefault(key, place)
        for name, line in constants_of(text):
            only_here(name, path, line)
        for name, meaning, line in aliases_of(text):
            only_here(name, path, line, meaning)
    return problems, checked


if __name__ == "__main__":
    source_files.finish("names", *check(sys.argv[1]))
