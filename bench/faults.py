#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Faults: what the program does with damaged input, full disks and signals.

    bench/faults.py poison   [--cases 1000]   NaN or 1e12 over one field of one record of a short recording, then `run`
    bench/faults.py mutate   [--cases 3100]   flipped, deleted, doubled bytes, sizes and numbers in every kind of file

    bench/faults.py full-disk                 every command that writes, on disks that are too small (needs root)
    bench/faults.py signals  [--cases 60]     runs over former results, ended by signals at random moments
    bench/faults.py batch-signals [--cases 60]  batches of two runs, ended by signals at random moments and gone on with

    bench/faults.py poison mutate --program build/release/bin/roomgraph --out out/faults

Every call of the program gets 4 GB of addresses and 20 s. A fault is answered well when the call uses what is left (exit
code 0) or refuses the file with one line (2 or 3). Writes OUT/EXPERIMENT.md, a table with crashes, exit codes and the
largest memory; inputs that were not answered well stay in OUT/kept with the command and what it said. The damage depends
on --first-seed alone: two builds get the same files. Recording and other files come from rawlogs/tiny_room.rawlog.
"""
import argparse
import concurrent.futures
import gzip
import math
import os
import random
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import threading
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

import faults_files

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "build" / "release" / "bin" / "roomgraph"
RECORDING = ROOT / "rawlogs" / "tiny_room.rawlog"
RECORDED = ("--set", "detection.class=RecordedDetector")
QUIET = ("--quiet", "--no-snapshot")
LIMIT_KB = 4 << 20
TIMEOUT_S = 20


@dataclass
class Outcome:
    code: int  # negative: the signal that ended it
    timed_out: bool
    rss_mb: float
    stderr: str

    def kind(self):
        if self.timed_out:
            return "time-out"
        if self.code < 0:
            return "crash"
        return {0: "0", 2: "2 or 3", 3: "2 or 3"}.get(self.code, "other")


@dataclass
class Row:
    """A line of a table: what became of a number of calls."""
    name: str
    kinds: Counter = field(default_factory=Counter)
    rss_mb: float = 0
    notes: Counter = field(default_factory=Counter)

    def add(self, outcome, note=""):
        self.kinds[outcome.kind()] += 1
        self.rss_mb = max(self.rss_mb, outcome.rss_mb)
        if note:
            self.notes[note] += 1


def call(program, arguments, folder):
    """The program under its limits, its own memory measured."""
    command = [str(a) for a in (program, *arguments)]
    with open(folder / "stderr.txt", "wb") as err:
        child = subprocess.Popen(["sh", "-c", f'ulimit -v {LIMIT_KB}; ulimit -c 0; exec "$@"', "sh", *command],
                                 stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=err, cwd=folder)
    late = threading.Event()
    timer = threading.Timer(TIMEOUT_S, lambda: (late.set(), child.kill()))
    timer.start()
    _, status, usage = os.wait4(child.pid, 0)
    timer.cancel()
    child.returncode = os.waitstatus_to_exitcode(status)  # it is waited for
    text = (folder / "stderr.txt").read_text(errors="replace")
    return Outcome(child.returncode, late.is_set(), usage.ru_maxrss / 1024, text)


def finite_poses(file):
    """Whether every number of a trajectory is finite; True where there is none."""
    if not file.exists():
        return True
    return all(math.isfinite(float(word)) for line in file.read_text().splitlines() for word in line.split())


def keep(options, name, folder, arguments, outcome):
    """The files of a case that went wrong, for whoever looks into it."""
    place = options.out / "kept" / name
    shutil.rmtree(place, ignore_errors=True)
    shutil.copytree(folder, place, ignore=shutil.ignore_patterns("out"))
    (place / "command.txt").write_text(f"{' '.join(map(str, arguments))}\n{outcome.kind()} {outcome.code}\n{outcome.stderr}")


@dataclass
class Case:
    row: str
    name: str
    write: object      # folder -> None: puts the damaged files there
    arguments: list    # of the program, in that folder


def run_case(options, case):
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        case.write(folder)
        outcome = call(options.program, case.arguments, folder)
        note = "" if finite_poses(folder / "out" / "trajectory.tum") else "pose not finite"
        if "internal error" in outcome.stderr:
            note = "internal error"
        if note or outcome.kind() not in ("0", "2 or 3"):
            keep(options, case.name, folder, case.arguments, outcome)
        return case, outcome, note


def run_cases(options, cases):
    rows = {}
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for done, (case, outcome, note) in enumerate(pool.map(lambda c: run_case(options, c), cases), 1):
            rows.setdefault(case.row, Row(case.row)).add(outcome, note)
            if sys.stderr.isatty():
                print(f"\r{done} of {len(cases)}", end="", file=sys.stderr, flush=True)
    return list(rows.values())


def table(rows, first):
    """Markdown, with a line of sums."""
    kinds = ["0", "2 or 3", "crash", "time-out", "other"]
    lines = [f"| {first} | n | exit 0 | 2 or 3 | crash | time-out | other | largest RSS, MB | notes |",
             "| --- " * 9 + "|"]
    total = Row("all")
    for row in rows:
        total.kinds += row.kinds
        total.notes += row.notes
        total.rss_mb = max(total.rss_mb, row.rss_mb)
    for row in [*rows, total]:
        notes = ", ".join(f"{count} x {note}" for note, count in row.notes.items())
        cells = [row.name, sum(row.kinds.values()), *(row.kinds[k] for k in kinds), f"{row.rss_mb:.0f}", notes]
        lines.append("| " + " | ".join(map(str, cells)) + " |")
    return "\n".join(lines) + "\n"


# The recording, as bytes.

HEADER = re.compile(rb"(?:\A|(?<=\x88))([\x84-\xff])((?:mrpt::obs|roomgraph)::CObservation\w+)", re.S)


def records_of(rawlog):
    """(class name, bytes) of every record."""
    data = gzip.open(rawlog).read()
    heads = [m for m in HEADER.finditer(data) if m[1][0] == 0x80 | len(m[2])]
    ends = [m.start() for m in heads[1:]] + [len(data)]
    return [(m[2].decode().split("::")[-1], data[m.start():end]) for m, end in zip(heads, ends)]


def frames_of(records, count):
    """The beginning of a recording, with so many images."""
    out, images = [], 0
    for name, data in records:
        images += name == "CObservation3DRangeScan"
        if images > count:
            break
        out.append((name, data))
    return out


# poison

def fields(name, size):
    """Where a record's numbers are: rows of (name, offsets)."""
    start = 1 + len(name)
    if name == "CObservation3DRangeScan":  # the sensor's pose, then images, then intrinsics
        return [("RGB-D header", range(start, start + 100)), ("intrinsics", range(size - 420, size - 8, 4))]
    title = {"CObservationOdometry": "odometry", "CObservation2DRangeScan": "2D scan",
             "CObservationDetections": "detections", "CObservationComment": "detections"}[name]
    return [(title, range(start, min(start + 140, size - 8)))]


def poison(options):
    """NaN and 1e12 written over eight bytes of one record of the middle of three frames."""
    records = frames_of(records_of(RECORDING), 3)
    cases = []
    for name in dict.fromkeys(n for n, _ in records):
        victim = [i for i, (n, _) in enumerate(records) if n == name][1]
        for title, offsets in fields(name, len(records[victim][1])):
            for value in (math.nan, 1e12):
                for offset in offsets:
                    cases.append((f"{title}, {'NaN' if math.isnan(value) else '1e12'}", victim, offset, value))
    count = min(len(cases), options.cases["poison"])
    cases = [cases[i * len(cases) // count] for i in range(count)]  # spread evenly

    def case(number, row, victim, offset, value):
        def write(folder):
            data = [bytearray(d) for _, d in records]
            struct.pack_into("<d", data[victim], offset, value)
            (folder / "x.rawlog").write_bytes(b"".join(data))
        return Case(row, f"poison_{number:04}", write, ["run", "x.rawlog", "-o", "out", *QUIET, *RECORDED])
    return table(run_cases(options, [case(i, *c) for i, c in enumerate(cases)]), "record and value")


# mutate

SIZES = [0xFFFFFFFF, 0x80000000, 0x7FFFFFFF, 0x00FFFFFF, 0]
DOUBLES = [math.nan, math.inf, 1e12, -1e300, 1e-300]
NUMBERS = ["1e999", "-1e999", "nan", "inf", "1e300", "1e12", "-1", "0", "", "4294967295", "null", "\"x\"", "[]", "1e-320"]


def damage_bytes(data, rng):
    data = bytearray(data)
    for _ in range(rng.randint(1, 4)):
        at = rng.randrange(max(1, len(data) - 12))
        edit = rng.randrange(6)
        if edit == 0:
            data[at] ^= 1 << rng.randrange(8)
        elif edit == 1:
            del data[at:at + rng.randint(1, 8)]
        elif edit == 2:
            data[at:at] = data[at:at + rng.randint(1, 64)]
        elif edit in (3, 4):
            data[at:at + 4] = struct.pack("<I", rng.choice([*SIZES, rng.getrandbits(32)]))
        else:
            data[at:at + 8] = struct.pack("<d", rng.choice(DOUBLES))
    return bytes(data)


def damage_text(data, rng):
    for _ in range(rng.randint(1, 3)):
        numbers = list(re.finditer(rb"-?\d+\.?\d*(?:[eE][-+]?\d+)?", data[:200000]))
        if not numbers or rng.randrange(3) == 0:
            data = damage_bytes(data, rng)
            continue
        number = rng.choice(numbers)
        data = data[:number.start()] + rng.choice(NUMBERS).encode() + data[number.end():]
    return data


def good_files(options):
    """Files of every kind, made by the program itself."""
    folder = options.out / "good"
    shutil.rmtree(folder, ignore_errors=True)
    (folder / "out").mkdir(parents=True)
    done = call(options.program, ["run", RECORDING, "-o", "out", *QUIET, *RECORDED], folder)
    if done.code:
        sys.exit(f"{options.program} run {RECORDING}: {done.stderr}")
    files = {f.name: f.read_bytes() for f in (folder / "out").iterdir() if f.is_file()}
    short = frames_of(records_of(RECORDING), 6)
    files["x.rawlog"] = b"".join(data for _, data in short)
    # Images are most of the bytes and the least of the fields.
    slim = frames_of(records_of(RECORDING), 40)
    files["slim.rawlog"] = b"".join(data for name, data in slim if "3DRangeScan" not in name)
    files["map.raw"] = gzip.decompress(files["map.rgmap"])
    files["world.json"] = (ROOT / "rawlogs" / "tiny_room.json").read_bytes()
    files["shipped.ini"] = (ROOT / "config.ini").read_bytes()
    files["objects.ini"] = (ROOT / "objects.ini").read_bytes()
    return files


# Name of the row, share of the cases, file that is damaged, the files beside it, arguments, text or bytes.
RUN = ["run", "slim.rawlog", "-o", "out", *QUIET]
READERS = [
    ("info", 225, "x.rawlog", [], ["info", "x.rawlog"], damage_bytes),
    ("info, no images", 225, "slim.rawlog", [], ["info", "slim.rawlog"], damage_bytes),
    ("run", 325, "x.rawlog", [], ["run", "x.rawlog", "-o", "out", *QUIET, *RECORDED], damage_bytes),
    ("run, no images", 325, "slim.rawlog", [], RUN, damage_bytes),
    ("run --map", 125, "map.rgmap", ["slim.rawlog"], [*RUN, "--map", "map.rgmap"], damage_bytes),
    ("run --map, inflated", 125, "map.raw", ["slim.rawlog"], [*RUN, "--map", "map.raw"], damage_bytes),
    ("snapshot", 300, "map.raw", [], ["snapshot", "map.raw", "-o", "x.png", "--size", "64x64"], damage_bytes),
    ("optimize", 400, "graph.g2o", [], ["optimize", "graph.g2o", "-o", "again.g2o", "--quiet"], damage_text),
    ("simulate", 250, "world.json", [], ["simulate", "world.json", "-o", "out"], damage_text),
    ("config", 150, "shipped.ini", ["slim.rawlog", "objects.ini"], [*RUN, "--config", "shipped.ini"], damage_text),
    ("objects.ini", 150, "objects.ini", ["slim.rawlog", "shipped.ini"], [*RUN, "--config", "shipped.ini"], damage_text),
    ("evaluate objects", 100, "landmarks.json", [], ["evaluate", "objects", "landmarks.json", "landmarks.json"], damage_text),
    ("evaluate trajectory", 100, "trajectory.tum", [], ["evaluate", "trajectory", "trajectory.tum", "trajectory.tum"],
     damage_text),
    ("evaluate map", 150, "map.yaml", ["map.pgm"], ["evaluate", "map", "map.yaml", "map.yaml"], damage_text),
    ("detections.jsonl", 150, "detections.jsonl", ["slim.rawlog"],
     [*RUN, *RECORDED, "--set", "detection.file=detections.jsonl"], damage_text),
]


def mutate(options):
    """Every reader gets its share of damaged files."""
    good = good_files(options)
    whole = sum(row[1] for row in READERS)
    cases = []
    for name, share, victim, others, arguments, damage in READERS:
        count = max(1, round(share * options.cases["mutate"] / whole))
        for seed in range(options.first_seed, options.first_seed + count):
            def write(folder, seed=seed, victim=victim, others=others, damage=damage):
                for other in others:
                    (folder / other).write_bytes(good[other])
                (folder / victim).write_bytes(damage(good[victim], random.Random(seed)))
            cases.append(Case(name, f"{re.sub('[^a-z]+', '_', name)}_{seed:04}", write, arguments))
    return table(run_cases(options, cases), "reader")


EXPERIMENTS = {"poison": (poison, 1000), "mutate": (mutate, 3100),
               "full-disk": (lambda options: faults_files.full_disk(options.program), 20),
               "batch-signals": (lambda options: faults_files.batch_signals(options.program, options.cases["batch-signals"]), 60),
               "signals": (lambda options: faults_files.signals(options.program, options.cases["signals"]), 60)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("experiments", nargs="+", choices=EXPERIMENTS, metavar="EXPERIMENT", help=", ".join(EXPERIMENTS))
    parser.add_argument("--cases", type=int, help="how many (default: " +
                        ", ".join(f"{count} {name}" for name, (_, count) in EXPERIMENTS.items()) + ")")
    parser.add_argument("--first-seed", type=int, default=1)
    parser.add_argument("--program", type=Path, default=PROGRAM)
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "faults")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="calls at a time (default: one for each core)")
    options = parser.parse_args()
    options.cases = {name: options.cases or count for name, (_, count) in EXPERIMENTS.items()}
    options.program, options.out = options.program.resolve(), options.out.resolve()
    options.out.mkdir(parents=True, exist_ok=True)
    for name in options.experiments:
        text = EXPERIMENTS[name][0](options)
        (options.out / f"{name}.md").write_text(text)
        print(f"\n{name}\n\n{text}")


if __name__ == "__main__":
    main()
