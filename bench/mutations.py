#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Mutation testing: puts one fault at a time into the code and sees whether a test notices.

    bench/mutations.py [--list] [--library X ...] [--only NAME ...] [--tests PROGRAM ...] [--jobs N] [-o report.json]

The faults are in bench/mutations/LIBRARY.json:

    {"library": "selection", "faults": [
      {"name": "crf_energy_sign", "file": "libs/selection/src/crf.cpp", "kind": "expression",
       "find": "a + b", "replace": "a - b", "why": "optional: why no test can notice"}]}

`find` occurs exactly once in its file. With `kind` "expression" (both texts are whole expressions of one type) or
"statement" (whole statements, no declarations) the fault is compiled together with all others of that sort, each
behind a switch that the environment variable ROOMGRAPH_FAULT throws ("mutant schemata", Untch et al., ISSTA 1993): one
build for all of them. Without `kind` the text is replaced and the library is built once more for that fault alone,
which takes half a minute: one file 5.3 s of CPU with -O0, 6.6 with -O3, the unity group of eight that it is in 11.6,
most of it for headers. The default preset is `release`, because with ccache its libraries are compiled already.

The work happens in copies of the source tree, DIR/1 to DIR/N (default build/mutations), which are kept: the next call
builds only what changed. The tree itself is never touched. In each copy all test programs are run without a fault
first, then, fault by fault, the tests of that library, followed by those of everything that links it, until one
fails. A test program that takes ten times as long as without the fault has failed.

The report is rewritten after every fault and stays valid when the program is interrupted (Ctrl-C). Exit code: 0 when
every fault that was built and has no `why` is caught, 1 when one is not, 2 for unusable input, 130 when interrupted.
"""
import argparse
import json
import os
import pathlib
import queue
import re
import shutil
import signal
import subprocess
import sys
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
KEYS = {"name", "file", "find", "replace"}
SWITCH = "ROOMGRAPH_FAULT"
# C++ that is put into files with switched faults; `%s` in the wrappers: name, replacement, original.
HEAD = f"""#include <cstdlib>
#include <cstring>
#define {SWITCH}(name) ([] {{ \\
  static const bool on = std::getenv("{SWITCH}") && !std::strcmp(std::getenv("{SWITCH}"), name); \\
  return on; }}())
"""
WRAPPED = {"expression": "(ROOMGRAPH_FAULT(\"%s\") ? (%s) : (%s))",
           "statement": "{ if (ROOMGRAPH_FAULT(\"%s\")) { %s } else { %s } }"}
LEAST_TIMEOUT_S, SLOWER = 60, 10
FAILED = re.compile(r"^\[  FAILED  \] ([\w/]+\.[\w/]+)", re.MULTILINE)
STARTED = re.compile(r"^\[ RUN      \] (\S+)", re.MULTILINE)
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


def programs_for(programs, library, only):
    """Names of the test programs that can notice a fault in the library: its own first."""
    own = [p for folder, p, _ in programs if folder == library]
    above = [p for folder, p, used in programs if folder != library and library in used]
    names = [p for p in own + above if not only or p in only]
    if not names:
        raise BadInput(f"no test program for library '{library}'")
    return names


# --- copies of the tree ---

def sync(root, copy, changed):
    """Makes the copy equal to the tree (what git tracks or would add) but for the texts in `changed`; files that are
    equal stay untouched."""
    listed = subprocess.run(["git", "-C", str(root), "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                            check=True, capture_output=True, text=True).stdout.split("\0")
    wanted = {p for p in listed if p and (root / p).is_file()}
    for path in wanted:
        source, target = root / path, copy / path
        content = changed[path].encode() if path in changed else source.read_bytes()
        if target.is_file() and target.read_bytes() == content:
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(content)
        shutil.copymode(source, target)
    for folder, folders, names in os.walk(copy):
        if pathlib.Path(folder) == copy:
            folders[:] = [f for f in folders if f != "build"]
        for name in names:
            path = pathlib.Path(folder, name)
            if str(path.relative_to(copy)) not in wanted:
                path.unlink()


class Stopped(Exception):
    pass


class Copy:
    """One copy of the tree with its build folder; `stop` ends what runs in it."""

    def __init__(self, folder, root, preset, stop):
        self.folder, self.root, self.preset, self.stop = folder, root, preset, stop
        self.build = folder / "build" / preset
        self.process = None
        self.usual_s = {}

    def call(self, command, timeout=None, fault=""):
        """(exit code or None after the timeout, output)."""
        if self.stop.is_set():
            raise Stopped
        # A session of its own: the whole process group can be ended, and Ctrl-C reaches this program alone.
        with subprocess.Popen(command, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True, errors="replace", env={**os.environ, SWITCH: fault},
                              start_new_session=True) as self.process:
            try:
                output, _ = self.process.communicate(timeout=timeout)
                code = self.process.returncode
            except subprocess.TimeoutExpired:
                self.end()
                output, code = self.process.communicate()[0], None
        if self.stop.is_set():
            raise Stopped
        return code, output

    def end(self):
        if self.process and self.process.poll() is None:
            os.killpg(self.process.pid, signal.SIGKILL)

    def compile(self, targets):
        code, output = self.call(["cmake", "--build", str(self.build), "--target", *targets])
        return code == 0, output

    def prepare(self, programs, changed):
        """Builds the test programs and runs them without a fault; `changed`: see switched()."""
        self.folder.mkdir(parents=True, exist_ok=True)
        sync(self.root, self.folder, changed)
        self.is_switched = bool(changed)
        code, output = self.call(["cmake", "--preset", self.preset, "-DROOMGRAPH_WERROR=OFF"])
        built, output = self.compile(programs) if code == 0 else (False, output)
        if not built:
            raise BadInput(f"the tree does not build without a fault:\n{output[-3000:]}")
        for program in programs:
            began = time.monotonic()
            code, output = self.call([str(self.build / "bin" / program)])
            self.usual_s[program] = time.monotonic() - began
            if code != 0:
                raise BadInput(f"{program} fails without a fault: {failed_test(code, output)}\n{output[-3000:]}")

    def attempt(self, fault, programs):
        """The fault's result."""
        began = time.monotonic()
        result = {key: fault[key] for key in ("name", "library", "file", "why") if key in fault}
        result.update(self.with_switch(fault, programs) if "kind" in fault else self.with_text(fault, programs))
        return {**result, "seconds": round(time.monotonic() - began, 1)}

    def with_switch(self, fault, programs):
        return self.verdict(programs, fault["name"])

    def with_text(self, fault, programs):
        if self.is_switched:
            sync(self.root, self.folder, {})
            self.is_switched = False
        path = self.folder / fault["file"]
        sound = path.read_text(encoding="utf-8")
        try:
            path.write_text(sound.replace(fault["find"], fault["replace"]), encoding="utf-8")
            return self.verdict(programs)
        finally:
            path.write_text(sound, encoding="utf-8")

    def verdict(self, programs, switch=""):
        for program in programs:
            built, output = (True, "") if switch else self.compile([program])
            if not built:
                return {"verdict": "not built", "output": output[-2000:]}
            timeout = max(LEAST_TIMEOUT_S, SLOWER * self.usual_s[program])
            code, output = self.call([str(self.build / "bin" / program), "--gtest_fail_fast"], timeout, switch)
            if code != 0:
                return {"verdict": "caught", "program": program, "test": failed_test(code, output)}
        return {"verdict": "survived", "programs": programs}


def failed_test(code, output):
    """The test after which a program failed: the first one reported, else the one it died in."""
    reported, started = FAILED.search(output), STARTED.findall(output)
    if reported:
        return reported.group(1)
    name = started[-1] if started else "before any test"
    return f"{name} (time ran out)" if code is None else f"{name} (exit code {code})"


# --- the run ---

class Report:
    """Results so far, on disk after each; shared by all copies."""

    def __init__(self, path, total):
        self.path, self.total, self.results, self.lock = path, total, [], threading.Lock()
        self.interrupted = False
        self.write()

    def add(self, result):
        with self.lock:
            self.results.append(result)
            print(f"{len(self.results):3}/{self.total} {line_of(result)}", flush=True)
            self.write()

    def summary(self):
        count = {v: sum(r["verdict"] == v for r in self.results) for v in ("caught", "survived", "not built")}
        explained = sum(r["verdict"] == "survived" and "why" in r for r in self.results)
        judged = count["caught"] + count["survived"]
        return {"faults": self.total, "caught": count["caught"], "survived": count["survived"],
                "survived_explained": explained, "not_built": count["not built"],
                "not_tried": self.total - len(self.results), "ratio": count["caught"] / judged if judged else None,
                "interrupted": self.interrupted}

    def write(self):
        if not self.path:
            return
        unfinished = self.path.with_suffix(".part")
        unfinished.write_text(json.dumps({"summary": self.summary(), "results": self.results}, indent=1) + "\n")
        unfinished.replace(self.path)


def line_of(result):
    by = {"caught": lambda: f"{result['program']}: {result['test']}",
          "survived": lambda: result.get("why", "no test noticed"),
          "not built": lambda: next((li for li in result["output"].splitlines() if "error" in li), "")[:100]}
    return (f"{result['library']:13} {result['name']:36} {result['verdict']:9} {result['seconds']:6.0f} s  "
            f"{by[result['verdict']]()}")


def work(copy, needed, changed, programs_of, todo, report, problems, ended):
    """Thread of one copy; puts itself into `ended`."""
    try:
        copy.prepare(needed, changed)
        while not problems:
            fault = todo.get_nowait()
            report.add(copy.attempt(fault, programs_of[fault["library"]]))
    except (queue.Empty, Stopped):
        pass
    except (BadInput, OSError, subprocess.SubprocessError) as error:
        problems.append(error)
    finally:
        ended.put(copy)


def run_all(root, faults, options):
    programs = test_programs(root)
    libraries = {f["library"] for f in faults}
    programs_of = {library: programs_for(programs, library, options.tests) for library in libraries}
    needed = [p for _, p, _ in programs if any(p in names for names in programs_of.values())]
    report, stop, problems = Report(options.output, len(faults)), threading.Event(), []
    todo, ended = queue.Queue(), queue.Queue()
    for fault in sorted(faults, key=lambda f: ("kind" not in f, f["file"])):  # those to be built alone come last
        todo.put(fault)
    changed = switched(root, faults)
    working = {Copy(options.build / str(i + 1), root, options.preset, stop) for i in range(options.jobs)}
    for copy in working:
        shared = (needed, changed, programs_of, todo, report, problems, ended)
        threading.Thread(target=work, args=(copy, *shared)).start()
    while working:
        try:
            if stop.is_set():
                for copy in working:
                    copy.end()
            working.discard(ended.get(timeout=0.2))
        except queue.Empty:
            pass
        except KeyboardInterrupt:
            stop.set()
            report.interrupted = True
    report.write()
    if problems:
        raise BadInput(str(problems[0]))
    return report


def arguments(argv):
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--list", action="store_true", help="check and print the faults; nothing is built")
    parser.add_argument("--library", nargs="+", help="faults in these libraries only")
    parser.add_argument("--only", nargs="+", metavar="NAME", help="these faults only")
    parser.add_argument("--tests", nargs="+", metavar="PROGRAM", help="run these test programs only")
    parser.add_argument("--jobs", type=int, default=1, help="copies that work at a time")
    parser.add_argument("--build", type=pathlib.Path, help="folder of the copies (build/mutations)")
    parser.add_argument("--preset", default="release", help="CMake preset of their builds")
    parser.add_argument("--root", type=pathlib.Path, default=ROOT, help="the source tree")
    parser.add_argument("-o", "--output", type=pathlib.Path, help="report as JSON")
    options = parser.parse_args(argv)
    options.root = options.root.resolve()
    options.build = (options.build or options.root / "build" / "mutations").resolve()
    return options


def main(argv):
    options = arguments(argv)
    try:
        faults = chosen(load_faults(options.root), options.library, options.only)
        if options.list:
            for fault in faults:
                note = "  (explained)" if "why" in fault else ""
                print(f"{fault['library']:13} {fault['name']:36} {fault['file']}{note}")
            print(f"{len(faults)} faults")
            return 0
        report = run_all(options.root, faults, options)
    except BadInput as error:
        print(f"mutations.py: {error}", file=sys.stderr)
        return 2
    figures = report.summary()
    ratio = "-" if figures["ratio"] is None else f"{figures['ratio']:.0%}"
    print(f"caught {figures['caught']} of {figures['caught'] + figures['survived']} ({ratio}), "
          f"{figures['survived_explained']} survivors explained, {figures['not_built']} did not build, "
          f"{figures['not_tried']} not tried")
    if report.interrupted:
        return 130
    return 0 if figures["survived"] == figures["survived_explained"] and not figures["not_built"] else 1


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    sys.exit(main(sys.argv[1:]))
