#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What the program does when sensors fail: every fault of `roomgraph damage` with every set of sensors, in a table.

    bench/fault_table.py rawlogs/tiny_room.json [--flats 4,5,6 --rooms 1] [--sensors all lidar+odometry ...]
      [--faults drop-camera kidnap ...] [--seed 1] [--out out/fault_table]

A recording is a world or a flat, which is simulated with its truth, or a RAWLOG, whose errors are then distances to the
undisturbed run. Sensors that a set lacks are taken out of the recording first. Each fault strikes from 35 % of the recording on,
for 10 s or a quarter of it, whichever is shorter. A cell says

* whether `run` finished, and whether what happened is said: in the findings of summary.json, in `info` and in report.html
  (the words that are looked for stand in FAULTS below), or as reasons and skipped records of summary.json and report.html;
* the error of the trajectory (RMSE after alignment) and how many times that of the undisturbed run it is;
* the largest step of the estimated path that the true one does not have, where it is more than 0.3 m;
* the objects of the map, with their F1 where there is truth, undisturbed and with the fault.

OUT/table.md is the table, OUT/cells.json all figures and what was said that an undisturbed run does not say. Cells that are there
are not computed again.
"""
import argparse
import html
import json
import math
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "build" / "release" / "bin" / "roomgraph"
SENSORS = ("camera", "lidar", "odometry")
SETS = ("all", "camera+lidar", "camera+odometry", "lidar+odometry")
BEGIN, SHARE, LONGEST_S = 0.35, 0.25, 10
JUMP_M = 0.3
BOUND = 1.5  # times the undisturbed error, for the loss of one sensor


@dataclass
class Fault:
    name: str
    options: str    # of `damage`; {a} and {b}: the span, s
    strikes: tuple  # a set without these sensors is left out; () for any
    says: str       # pattern of what must be said
    loss: bool = False  # of one sensor: its error is bounded


def lost(kind):
    return Fault(f"drop-{kind}", f"--drop-{kind} {{a}}:{{b}}", (kind,), r"gap of|no record in the (first|last)", True)


FAULTS = [
    lost("camera"), lost("lidar"), lost("odometry"),
    Fault("unplug-odometry", "--unplug-odometry {a}", ("odometry",), "no record in the last", True),
    Fault("freeze-camera", "--freeze-camera {a}:{b}", ("camera",), "images in a row are the same", True),
    Fault("freeze-lidar", "--freeze-lidar {a}:{b}", ("lidar",), "scans in a row are the same", True),
    Fault("freeze-odometry", "--freeze-odometry {a}:{b}", ("odometry",), "stands still|jumps, the largest", True),
    Fault("lift-wheels", "--lift-wheels {a}:{b}", ("odometry",), "stands still|contradict", True),
    Fault("black", "--black {a}:{b}", ("camera",), "pictures show nothing", True),
    Fault("white", "--white {a}:{b}", ("camera",), "pictures show nothing", True),
    Fault("no-depth", "--no-depth {a}:{b}", ("camera",), "depth images are empty", True),
    Fault("nan-camera", "--nan camera={a}:{b}", ("camera",), "rangeUnits", True),
    Fault("nan-lidar", "--nan lidar={a}:{b}", ("lidar",), "NaN or infinite", True),
    Fault("nan-odometry", "--nan odometry={a}:{b}", ("odometry",), "not finite", True),
    Fault("noise-camera", "--noise camera={a}:{b}", ("camera",), "much noisier", True),
    Fault("noise-lidar", "--noise lidar={a}:{b}", ("lidar",), "much noisier", True),
    Fault("noise-odometry", "--noise odometry={a}:{b}", ("odometry",), "jumps, the largest", True),
    Fault("swap-order", "--swap-order {a}:{b}", (), "older than|out of order"),
    Fault("duplicate", "--duplicate {a}:{b}", (), "stamp of the one before"),
    Fault("clock-jump +2 s", "--clock-jump {a}:2", (), "gap of|not come after"),
    Fault("clock-jump -2 s", "--clock-jump {a}:-2", (), "set back"),
    Fault("clock-jump camera +0.5 s", "--clock-jump camera={a}:0.5", ("camera",), "clock jumps"),
    Fault("clock-jump lidar -0.5 s", "--clock-jump lidar={a}:-0.5", ("lidar",), "clock jumps"),
    Fault("wrong-extrinsics camera pitch 8", "--wrong-extrinsics camera=0,0,0,0,8,0", ("camera",), "floor is seen"),
    Fault("wrong-extrinsics camera yaw 8", "--wrong-extrinsics camera=0,0,0,8,0,0", ("camera",), "(is|are) turned by"),
    Fault("wrong-extrinsics lidar yaw 8", "--wrong-extrinsics lidar=0,0,0,8,0,0", ("lidar",), "(is|are) turned by"),
    Fault("kidnap", "--kidnap {a}:{b}", (), "gap of"),
    Fault("moving-furniture", "--moving-furniture {a}:{b}", ("odometry",), "returns_in_free_space|frames_with_movers"),
]


def call(program, *words, check=True):
    done = subprocess.run([str(program), *map(str, words)], capture_output=True, text=True)
    if check and done.returncode:
        raise SystemExit(f"roomgraph {' '.join(map(str, words))}: {done.stderr.strip()}")
    return done


@dataclass
class Recording:
    name: str
    rawlog: Path
    truth: Path = None  # folder of the simulator

    def trajectory(self):
        return self.truth and self.truth / "groundtruth_robot.txt"

    def objects(self):
        return self.truth and self.truth / "objects.json"


def simulated(program, name, folder, words):
    if not (folder / "groundtruth_robot.txt").exists():
        call(program, "simulate", *words, "-o", folder)
    return Recording(name, next(folder.glob("*.rawlog")), folder)


def recordings_of(arguments):
    places = arguments.out / "recordings"
    for given in arguments.recordings:
        if given.suffix == ".json":
            yield simulated(arguments.program, given.stem, places / given.stem, (given, "--seed", arguments.seed))
        else:
            yield Recording(given.name.split(".")[0], given)
    for flat in filter(None, arguments.flats.split(",")):
        words = ("--flat", flat) + (("--rooms", arguments.rooms) if arguments.rooms else ())
        yield simulated(arguments.program, f"flat {flat}", places / f"flat_{flat}", words)


def poses(file):
    rows = [line.split() for line in Path(file).read_text().splitlines() if line and not line.startswith("#")]
    return [tuple(map(float, row[:4])) for row in rows]


def nearest(rows, t, index):
    while index + 1 < len(rows) and abs(rows[index + 1][0] - t) <= abs(rows[index][0] - t):
        index += 1
    return index


def largest_excess(estimate, truth):
    """By how much the longest step of the estimate beyond the true movement exceeds it, m."""
    worst, before, index = 0, None, 0
    for row in estimate:
        index = nearest(truth, row[0], index)
        if abs(truth[index][0] - row[0]) > 0.02:
            continue
        if before:
            step, real = math.dist(row[1:], before[0][1:]), math.dist(truth[index][1:], before[1][1:])
            worst = max(worst, step - real)
        before = row, truth[index]
    return worst


def statements(summary):
    """All that summary.json says about the recording and what went wrong, as (where, text, number)."""
    for finding in summary["findings"] or []:
        yield "findings", f"{finding['place']}: {finding['what']}", 1
    for where in ("reasons", "records_skipped"):
        for text, count in summary[where].items():
            yield where, text, count
    for what in ("returns_in_free_space", "returns_on_people", "frames_with_movers"):
        yield "counts", what, summary["counts"].get(what, 0)
    if summary["input_warning"]:
        yield "input_warning", summary["input_warning"], 1


def news(summary, undisturbed):
    """What is said now and was not, or clearly less often."""
    known = {(where, text): count for where, text, count in statements(undisturbed)}
    return [(where, text, count) for where, text, count in statements(summary)
            if count > 1.5 * known.get((where, text), 0) + (2 if where == "reasons" else 0)]


def unshifted(out, fault, span):
    """The trajectory with the stamps of the recording, where a fault shifted those of all sensors for good."""
    match = re.fullmatch(r"--clock-jump \{a\}:(\S+)", fault.options)
    file = out / "trajectory.tum"
    if not match or json.loads((out / "summary.json").read_text())["clocks"]["set_back"]:
        return file
    shift, rows = float(match[1]), file.read_text().splitlines()
    start, fixed = float(rows[0].split()[0]), out / "trajectory_unshifted.tum"
    first = start + span[0] + max(shift, 0)  # stamps before it are those of records before the jump
    moved = ((float(row.split()[0]), row.split()[1:]) for row in rows)
    fixed.write_text("".join(" ".join([f"{t - shift if t >= first else t:.6f}", *rest]) + "\n" for t, rest in moved))
    return fixed


class Table:
    def __init__(self, arguments):
        self.program, self.out, self.seed = arguments.program, arguments.out, arguments.seed
        self.file = self.out / "cells.json"
        self.cells = json.loads(self.file.read_text()) if self.file.exists() else {}

    def run(self, rawlog, out):
        done = call(self.program, "run", rawlog, "-o", out, "--quiet", "--no-snapshot", check=False)
        return done.returncode, done.stderr.strip()

    def reduced(self, recording, sensors, folder):
        """The recording with nothing but these sensors."""
        missing = [kind for kind in SENSORS if sensors != "all" and kind not in sensors.split("+")]
        if not missing:
            return recording.rawlog
        rawlog = folder / "undisturbed.rawlog"
        if not rawlog.exists():
            call(self.program, "damage", recording.rawlog, "-o", rawlog, *(w for kind in missing for w in (f"--drop-{kind}", "0:")))
        return rawlog

    def errors(self, recording, trajectory, out, undisturbed):
        truth = recording.trajectory() or undisturbed / "trajectory.tum"
        figures = {}
        report = out / "ate.json"
        done = call(self.program, "evaluate", "trajectory", truth, trajectory, "--json", report, check=False)
        if done.returncode == 0:
            figures["ate_m"] = json.loads(report.read_text())["ate_rmse_m"]
        figures["jump_m"] = largest_excess(poses(trajectory), poses(truth))
        figures["objects"] = len(json.loads((out / "landmarks.json").read_text())["landmarks"])
        if recording.objects():
            report = out / "objects_report.json"
            done = call(self.program, "evaluate", "objects", recording.objects(), out / "landmarks.json", "--json", report,
                        "--truth-trajectory", truth, "--trajectory", trajectory, check=False)
            if done.returncode == 0:
                figures["f1"] = json.loads(report.read_text())["f1"]
        return figures

    def undisturbed(self, recording, sensors):
        folder = self.out / "runs" / recording.name.replace(" ", "_") / sensors
        folder.mkdir(parents=True, exist_ok=True)
        rawlog, run = self.reduced(recording, sensors, folder), folder / "undisturbed"
        if not (run / "summary.json").exists():
            code, message = self.run(rawlog, run)
            if code:
                raise SystemExit(f"{recording.name}, {sensors}, undisturbed: {message}")
        call(self.program, "info", rawlog, "--json", folder / "info.json")
        return folder, rawlog, run

    def cell(self, recording, sensors, fault):
        key = f"{recording.name}|{sensors}|{fault.name}"
        if key in self.cells:
            return self.cells[key]
        folder, rawlog, before = self.undisturbed(recording, sensors)
        length = json.loads((folder / "info.json").read_text())["duration_s"]
        begin = round(BEGIN * length, 1)
        span = begin, round(begin + min(LONGEST_S, SHARE * length), 1)
        damaged, out = folder / "damaged.rawlog", folder / "damaged"
        words = fault.options.format(a=span[0], b=span[1]).split()
        call(self.program, "damage", rawlog, "-o", damaged, "--seed", self.seed, *words)
        code, message = self.run(damaged, out)
        result = {"exit": code, "message": message, "span": span, "before": self.errors(recording, before / "trajectory.tum", before, before)}
        if code == 0:
            summary = json.loads((out / "summary.json").read_text())
            said = news(summary, json.loads((before / "summary.json").read_text()))
            result |= self.errors(recording, unshifted(out, fault, span), out, before)
            result["said"] = [f"{where}: {count} x {text}" if where != "findings" else f"{where}: {text}" for where, text, count in said]
            result["where"] = self.places(damaged, out, fault, said)
        self.cells[key] = result
        self.file.write_text(json.dumps(self.cells, indent=1))
        return result

    def places(self, rawlog, out, fault, said):
        """Where the words that were expected stand."""
        expected = [(where, text) for where, text, _ in said if re.search(fault.says, text)]
        info = call(self.program, "info", rawlog, check=False).stdout
        report = html.unescape((out / "report.html").read_text())
        found = {"summary": bool(expected), "info": any(text in info for _, text in expected),
                 "report": any(text.split(": ", 1)[-1] in report for _, text in expected)}
        return [place for place, there in found.items() if there]


def words_for(cell, fault):
    """The columns of a cell: said, error, jump, objects."""
    if cell["exit"]:
        return [f"**exit {cell['exit']}**: {cell['message']}", "-", "-", "-"]
    said = ", ".join(cell["where"]) if cell["where"] else "**nothing**"
    ate, usual = cell.get("ate_m"), cell["before"].get("ate_m")
    error = "-" if ate is None else f"{ate:.3f}"
    if ate is not None and usual:
        ratio = f"x {ate / usual:.2f}"
        error += f" ({f'**{ratio}**' if fault.loss and ate > BOUND * usual else ratio})"
    jump = f"{cell['jump_m']:.2f}" if cell["jump_m"] > max(JUMP_M, 1.5 * cell["before"]["jump_m"]) else ""
    objects = f"{cell['before']['objects']} → {cell['objects']}"
    if "f1" in cell and "f1" in cell["before"]:
        objects += f" ({cell['before']['f1']:.2f} → {cell['f1']:.2f})"
    return [said, error, jump, objects]


def summary_of(rows):
    """Counts over all cells, in lines."""
    finished = sum(cell["exit"] == 0 for _, cell in rows)
    told = sum(bool(cell.get("where")) for _, cell in rows)
    losses = [cell for fault, cell in rows if fault.loss and cell.get("ate_m") is not None and cell["before"].get("ate_m")]
    bounded = sum(cell["ate_m"] <= BOUND * cell["before"]["ate_m"] for cell in losses)
    hidden = sum(cell.get("jump_m", 0) > max(JUMP_M, 1.5 * cell["before"]["jump_m"]) and not cell.get("said") for _, cell in rows)
    return [f"{finished} of {len(rows)} runs finished; {told} said what happened; error at most {BOUND} times the undisturbed one in "
            f"{bounded} of {len(losses)} faults of one sensor; {hidden} jumps of the path without a word.", ""]


def main(argv=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recordings", nargs="*", type=Path, help="WORLD.json or X.rawlog")
    parser.add_argument("--flats", default="", help="numbers of random flats, e.g. 4,5,6")
    parser.add_argument("--rooms", type=int, help="of each flat")
    parser.add_argument("--sensors", nargs="+", default=SETS, choices=SETS, metavar="SET", help=f"default: {' '.join(SETS)}")
    parser.add_argument("--faults", nargs="+", default=[], metavar="FAULT", help="those whose names begin so (default: all)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--program", type=Path, default=PROGRAM)
    parser.add_argument("--out", type=Path, default=Path("out/fault_table"))
    arguments = parser.parse_args(argv)
    if not arguments.recordings and not arguments.flats:
        parser.error("name recordings, or --flats")
    arguments.out.mkdir(parents=True, exist_ok=True)
    table, lines, rows = Table(arguments), [], []
    for recording in recordings_of(arguments):
        for sensors in arguments.sensors:
            present = SENSORS if sensors == "all" else sensors.split("+")
            faults = [fault for fault in FAULTS if all(kind in present for kind in fault.strikes)
                      and (not arguments.faults or any(fault.name.startswith(name) for name in arguments.faults))]
            lines += ["", f"### {recording.name}, {sensors}", "", "| fault | said in | error, m | jump, m | objects (F1) |",
                      "| --- | --- | --- | --- | --- |"]
            for fault in faults:
                print(f"{recording.name}, {sensors}: {fault.name}", file=sys.stderr, flush=True)
                cell = table.cell(recording, sensors, fault)
                rows.append((fault, cell))
                lines.append(f"| {fault.name} | " + " | ".join(words_for(cell, fault)) + " |")
    text = "\n".join(summary_of(rows) + lines).strip() + "\n"
    (arguments.out / "table.md").write_text(text)
    print(text, end="")


if __name__ == "__main__":
    main()
