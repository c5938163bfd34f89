#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Mutation testing: puts one fault at a time into the code and sees whether a test notices.

    bench/mutations.py [--list] [--library X ...] [--only NAME ...] [--tests PROGRAM ...] [--without PROGRAM ...] [--jobs N]
                       [-o report.json]

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

A fault that does not compile behind a switch is found by the lines of the compiler's errors, and built alone as well.

The work happens in copies of the source tree, DIR/1 to DIR/N (default build/mutations), which are kept: the next call
builds only what changed. The tree itself is never touched. In each copy all test programs are run without a fault
first, then, fault by fault, the tests of that library, followed by those of everything that links it, the quickest
first, until one fails. A test program that takes ten times as long as without the fault has failed. A fault that nothing
notices costs as long as all of them: slow ones can be left out (--without), and survivors tried again with them.

The report is rewritten after every fault and stays valid when the program is interrupted (Ctrl-C). Exit code: 0 when
every fault that was built and has no `why` is caught, 1 when one is not, 2 for unusable input, 130 when interrupted.
"""
import argparse
import fcntl
import itertools
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

from mutation_list import (SWITCH, BadInput, blamed, chosen, load_faults, programs_for, switched,
                           test_programs)

ROOT = pathlib.Path(__file__).resolve().parent.parent
LEAST_TIMEOUT_S, SLOWER = 60, 10
FAILED = re.compile(r"^\[  FAILED  \] ([\w/]+\.[\w/]+)", re.MULTILINE)
STARTED = re.compile(r"^\[ RUN      \] (\S+)", re.MULTILINE)


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
        self.alone = set()  # names of the faults that are not behind a switch in this copy

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

    def compile(self, targets, *options):
        code, output = self.call(["cmake", "--build", str(self.build), "--target", *targets, *options])
        return code == 0, output

    def build_switched(self, programs, faults):
        """Builds the test programs with all faults behind switches but those that do not compile there."""
        while True:
            changed = switched(self.root, [f for f in faults if f["name"] not in self.alone])
            sync(self.root, self.folder, changed)
            self.is_switched = bool(changed)
            code, output = self.call(["cmake", "--preset", self.preset, "-DROOMGRAPH_WERROR=OFF"])
            built, output = self.compile(programs, "--", "-k", "0") if code == 0 else (False, output)
            if built:
                return
            culprits = blamed(output, changed)
            if not culprits:
                raise BadInput(f"the tree does not build without a fault:\n{output[-3000:]}")
            print(f"not behind a switch, as it does not compile there: {', '.join(sorted(culprits))}", flush=True)
            self.alone |= culprits

    def prepare(self, programs, faults):
        """Builds the test programs and runs them without a fault."""
        self.folder.mkdir(parents=True, exist_ok=True)
        self.alone = {f["name"] for f in faults if "kind" not in f}
        self.build_switched(programs, faults)
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
        programs = programs[:1] + sorted(programs[1:], key=self.usual_s.get)
        is_alone = fault["name"] in self.alone
        result.update(self.with_text(fault, programs) if is_alone else self.verdict(programs, fault["name"]))
        return {**result, "seconds": round(time.monotonic() - began, 1)}

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


def taken(todo):
    """What is left in the queue, one by one."""
    while True:
        try:
            yield todo.get_nowait()
        except queue.Empty:
            return


def work(copy, needed, faults, programs_of, todo, report, problems, ended):
    """Thread of one copy; puts itself into `ended`. Faults to be built alone come last, as they replace the switches."""
    try:
        copy.prepare(needed, faults)
        alone = []
        for fault in itertools.chain(taken(todo), alone):
            if problems:
                return
            if copy.is_switched and todo.qsize() and fault["name"] in copy.alone:
                alone.append(fault)
            else:
                report.add(copy.attempt(fault, programs_of[fault["library"]]))
    except Stopped:
        pass
    except (BadInput, OSError, subprocess.SubprocessError) as error:
        problems.append(error)
    finally:
        ended.put(copy)


def lock(folder):
    """An open file that keeps others from working in the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    file = open(folder / "lock", "w")
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise BadInput(f"another call works in {folder}") from None
    return file


def run_all(root, faults, options):
    programs = test_programs(root)
    libraries = {f["library"] for f in faults}
    programs_of = {library: programs_for(programs, library, options.tests, options.without) for library in libraries}
    needed = [p for _, p, _ in programs if any(p in names for names in programs_of.values())]
    report, stop, problems = Report(options.output, len(faults)), threading.Event(), []
    todo, ended = queue.Queue(), queue.Queue()
    for fault in sorted(faults, key=lambda f: ("kind" not in f, f["file"])):
        todo.put(fault)
    switched(root, faults)  # faults that overlap end here, before anything is built
    working = {Copy(options.build / str(i + 1), root, options.preset, stop) for i in range(options.jobs)}
    for copy in working:
        shared = (needed, faults, programs_of, todo, report, problems, ended)
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
    parser.add_argument("--without", nargs="+", metavar="PROGRAM", default=(),
                        help="run these for faults of their own library only")
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
        with lock(options.build):
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
    for number in (signal.SIGINT, signal.SIGTERM):  # a shell lets background jobs ignore the first
        signal.signal(number, signal.default_int_handler)
    sys.exit(main(sys.argv[1:]))
