# SPDX-License-Identifier: BSD-3-Clause
"""The faults of bench/mutations/*.json, how they are put into the code, and which test programs may notice them."""
import json
import re

KEYS = {"name", "file", "find", "replace"}
SWITCH = "ROOMGRAPH_FAULT"  # environment variable: name of the fault that is switched on
# C++ that is put into files with switched faults; `%s` in the wrappers: name, replacement, original.
HEAD = f"""#include <cstdlib>
#include <cstring>
#define {SWITCH}(name) ([] {{ \\
  static const bool on = std::getenv("{SWITCH}") && !std::strcmp(std::getenv("{SWITCH}"), name); \\
  return on; }}())
"""
WRAPPED = {"expression": "(ROOMGRAPH_FAULT(\"%s\") ? (%s) : (%s))",
           "statement": "{ if (ROOMGRAPH_FAULT(\"%s\")) { %s\n} else { %s\n} }"}  # it may end with a comment
ERROR = re.compile(r"^(?:\S*?/)?((?:libs|apps|plugins|tests)/\S+?):(\d+):\d+: (?:fatal )?error:", re.MULTILINE)
LIBRARY = re.compile(r"\broomgraph::(\w+)")
PROGRAM = re.compile(r"\broomgraph_add_test\(\s*(\w+)")


class BadInput(Exception):
    pass


# --- the list of faults ---

def checked_fault(root, source, library, fault):
    """The fault with its library; BadInput says what is wrong with it."""
    place = f"{source.relative_to(root)}: fault '{fault.get('name', '?')}'"
    missing = KEYS - fault.keys()
    unknown = fault.keys() - KEYS - {"why", "kind"}
    if missing or unknown:
        raise BadInput(f"{place}: missing {sorted(missing)}, unknown {sorted(unknown)}")
    try:
        text = (root / fault["file"]).read_text(encoding="utf-8")
    except OSError:
        raise BadInput(f"{place}: there is no {fault['file']}") from None
    count = text.count(fault["find"]) if fault["find"] else 0
    if count != 1:
        raise BadInput(f"{place}: `find` occurs {count} times in {fault['file']}, not once: {fault['find']!r}")
    if fault["find"] == fault["replace"]:
        raise BadInput(f"{place}: it changes nothing")
    if fault.get("kind", "statement") not in WRAPPED:
        raise BadInput(f"{place}: `kind` is neither {' nor '.join(sorted(WRAPPED))}")
    if set(fault["name"]) & set('"\\\n'):
        raise BadInput(f"{place}: a name must do inside a C++ string")
    return {"library": library, **fault}


def load_faults(root):
    """All faults of bench/mutations/*.json. Every fault that is not usable is named in one BadInput."""
    faults, names, problems = [], {}, []
    for source in sorted((root / "bench" / "mutations").glob("*.json")):
        try:
            content = json.loads(source.read_text(encoding="utf-8"))
            library, entries = content["library"], content["faults"]
        except (ValueError, KeyError, TypeError) as error:
            raise BadInput(f"{source.relative_to(root)}: {error!r}") from None
        if not (root / "libs" / library).is_dir():
            problems.append(f"{source.relative_to(root)}: there is no library '{library}'")
        for entry in entries:
            try:
                faults.append(checked_fault(root, source, library, entry))
            except BadInput as error:
                problems.append(str(error))
                continue
            if entry["name"] in names:
                problems.append(f"{source.relative_to(root)}: '{entry['name']}' is in {names[entry['name']]} already")
            names[entry["name"]] = source.relative_to(root)
    if problems:
        raise BadInput("\n".join(problems))
    if not faults:
        raise BadInput("bench/mutations holds no faults")
    return faults


def chosen(faults, libraries, names):
    for wanted, known in ((libraries, {f["library"] for f in faults}), (names, {f["name"] for f in faults})):
        for unknown in set(wanted or []) - known:
            raise BadInput(f"no such library or fault: {unknown}")
    return [f for f in faults if f["library"] in (libraries or [f["library"]]) and f["name"] in (names or [f["name"]])]


def switched(root, faults):
    """{path: text} of the files in which all faults with a `kind` stand behind switches."""
    files = {}
    for path in sorted({f["file"] for f in faults if "kind" in f}):
        text, end = (root / path).read_text(encoding="utf-8"), None
        places = sorted(((text.index(f["find"]), f) for f in faults if f["file"] == path and "kind" in f),
                        key=lambda place: place[0], reverse=True)
        for begin, fault in places:
            if end is not None and begin + len(fault["find"]) > end:
                raise BadInput(f"{path}: fault '{fault['name']}' overlaps the next one; leave out the `kind` of one")
            wrapped = WRAPPED[fault["kind"]] % (fault["name"], fault["replace"], fault["find"])
            text, end = text[:begin] + wrapped + text[begin + len(fault["find"]):], begin
        files[path] = HEAD + text
    return files


def blamed(output, files):
    """Names of the switched faults in whose text, or just after it, the compiler found errors; `files`: see switched()."""
    names = set()
    for path, line in ERROR.findall(output):
        before = "\n".join(files.get(path, "").split("\n")[:int(line)])
        switches = re.findall(SWITCH + r'\("([^"]+)"\) ?[?)]', before)
        names.update(switches[-1:])
    return names


# --- which tests see a library ---

def text_of(root, *parts):
    path = root.joinpath(*parts, "CMakeLists.txt")
    return path.read_text(encoding="utf-8") if path.exists() else ""


def links(root, text):
    """Libraries that a CMakeLists.txt links, directly or not; with the program, when it needs that."""
    if "roomgraph_app" in text:
        text += text_of(root, "apps", "roomgraph")
    found, open_names = set(), set(LIBRARY.findall(text))
    while open_names:
        name = open_names.pop()
        found.add(name)
        open_names |= set(LIBRARY.findall(text_of(root, "libs", name))) - found
    return found


def test_programs(root):
    """[(folder, program, libraries)], lowest level first: the order of tests/CMakeLists.txt."""
    order = re.findall(r"[\w]+", re.search(r"foreach\(folder ([^)]*)\)", text_of(root, "tests")).group(1))
    programs = []
    for folder in order:
        text = text_of(root, "tests", folder)
        programs += [(folder, program, links(root, text)) for program in PROGRAM.findall(text)]
    return programs


def programs_for(programs, library, only, without=()):
    """Names of the test programs that can notice a fault in the library: its own first, which is there even when it is in
    `without`."""
    own = [p for folder, p, _ in programs if folder == library]
    above = [p for folder, p, used in programs if folder != library and library in used and p not in without]
    names = [p for p in own + above if not only or p in only]
    if not names:
        raise BadInput(f"no test program for library '{library}'")
    return names
