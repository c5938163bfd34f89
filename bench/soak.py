#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Hours of a patrol in which chairs and a sofa are moved: what each hour costs, and whether the map follows.

    bench/soak.py [--hours 8] [--seed 1] [--set key=value ...] [--out out/soak]

The lab (worlds/lab.json) is driven round slowly, with few small images (1 a second, 320 by 240), so that hours are made and run in
minutes: 8 hours are some 1.3 GB of recording, kept in OUT/sequences and used again. Objects are moved at fractions of the time, so
that less hours do the same. Everything is simulated, boxes too. By the recorded hour: memory (resident, highest of the hour), processor
time per record, error of the live pose; then each place at which a moved object stood or stands, and whether the map has one there.
"""
import argparse
import collections
import csv
import json
import math
import os
import subprocess
import sys
import threading
import time
from pathlib import Path

import long_run
import seeds

# Model and place in the world; then (share of the time, place, yaw).
MOVES = [
    ("swivel_chair", [8.45, 0.9], [(0.25, [7.6, 5.2], 200), (0.75, [8.45, 0.9], 175)]),  # away and back
    ("swivel_chair", [3.2, 2.2], [(0.375, [0.8, 5.3], -30)]),
    ("sofa", [2.2, 6.52], [(0.5, [3.0, 6.52], -90)]),  # pushed along its wall
    ("swivel_chair", [10.25, 3.85], [(0.625, [12.55, 1.0], 90)]),
]
CAMERA = {"rate_hz": 1, "width_px": 320, "height_px": 240}
LIDAR_HZ, ODOMETRY_HZ, SPEED_M_S, TURN_DEG_S = 2.5, 5, 0.3, 20
GATE_M = 0.4
END = 0.9999  # share of the replay: hindsight follows
HOUR_S = 3600


def patrol(world, hours):
    """The world with a long slow path, seldom records, and what is moved."""
    world = json.loads(json.dumps(world))
    world["robot"].update(max_speed_m_s=SPEED_M_S, max_turn_deg_s=TURN_DEG_S)
    world = long_run.long_world(world, 60 * hours, CAMERA)
    world["sensors"]["lidar"]["rate_hz"] = LIDAR_HZ
    world["sensors"]["odometry"]["rate_hz"] = ODOMETRY_HZ
    for model, place, moves in MOVES:
        item = next(i for i in world["furniture"] if i["model"] == model and i["at_m"] == place)
        item["moves"] = [{"at_s": share * hours * HOUR_S, "at_m": at, "yaw_deg": yaw} for share, at, yaw in moves]
    return world


def resident_mb(process):
    """None once it has ended."""
    try:
        lines = Path(f"/proc/{process}/status").read_text().splitlines()
    except OSError:
        return None
    return next((int(line.split()[1]) / 1024 for line in lines if line.startswith("VmRSS:")), None)


def watched_run(program, rawlog, run, settings):
    """Runs; [(share of the replay that is done, resident MB)], the reason of a failure or None."""
    progress, samples = run.parent / f"{run.name}_progress", []
    overrides = [part for setting in settings for part in ("--set", setting)]
    command = [str(a) for a in (program.path, "run", rawlog, "-o", run, "--quiet", "--no-snapshot", "--progress-file", progress, *overrides)]
    environment = {**os.environ, "XDG_DATA_HOME": os.devnull}
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment)

    def watch():
        while (memory := resident_mb(process.pid)) is not None:
            try:
                samples.append((float(progress.read_text()), memory))
            except (OSError, ValueError):
                pass  # not begun yet
            time.sleep(1)

    watcher = threading.Thread(target=watch, daemon=True)
    watcher.start()
    _, errors = process.communicate()
    watcher.join()
    return samples, errors.strip() if process.returncode else None


def poses_of(file):
    """Stamp -> (x, y) of a TUM file."""
    lines = (line.split() for line in file.read_text().splitlines() if not line.startswith("#"))
    return {round(float(f[0]), 3): (float(f[1]), float(f[2])) for f in lines}


def live_errors(truth, live):
    """Hour -> squared errors of places; both are in the frame of the first pose."""
    true, errors = poses_of(truth), collections.defaultdict(list)
    start = min(true)
    for t, (x, y) in poses_of(live).items():
        if t in true:
            errors[int((t - start) // HOUR_S)].append((x - true[t][0]) ** 2 + (y - true[t][1]) ** 2)
    return errors


def times(file):
    """Hour -> (processor ms of all stages but the last ones, records)."""
    spent, records, start = collections.Counter(), collections.defaultdict(set), None
    with open(file, newline="") as lines:
        for row in csv.DictReader(lines):
            t = float(row["timestamp"])
            start = t if start is None else start
            if row["stage"] in ("hindsight", "occupancy map"):
                continue
            hour = int((t - start) // HOUR_S)
            spent[hour] += float(row["cpu_ms"])
            records[hour].add(t)
    return {hour: (spent[hour], len(records[hour])) for hour in spent}


def hour_table(samples, run, truth, hours):
    """One row per recorded hour."""
    cost, errors = times(run / "timings.csv"), live_errors(truth / "groundtruth_robot.txt", run / "live.tum")
    lines = ["| hour | memory, MB | processor time, ms per record | error of the live pose, m: rms / largest |", "| --- | --- | --- | --- |"]
    for hour in range(math.ceil(hours)):
        low, high = hour / hours, (hour + 1) / hours
        memory = [mb for share, mb in samples if low <= share < min(high, END)]
        ms, records = cost.get(hour, (0, 1))
        squares = errors.get(hour, [math.nan])
        lines.append(f"| {hour + 1} | {max(memory, default=math.nan):.0f} | {ms / records:.2f} | "
                     f"{math.sqrt(sum(squares) / len(squares)):.4f} / {math.sqrt(max(squares)):.3f} |")
    at_end = max((mb for share, mb in samples if share >= END), default=math.nan)
    return "\n".join([*lines, f"| end | {at_end:.0f} | | |"])


def moved_table(truth, run):
    """Where moved objects stood, and whether the map has one of the class there."""
    objects = json.loads((truth / "objects.json").read_text())["objects"]
    landmarks = json.loads((run / "landmarks.json").read_text())["landmarks"]
    lines = ["| moved | stood at | since, h | now | nearest of the map, m |", "| --- | --- | --- | --- | --- |"]
    for thing in objects:
        places = thing.get("places", [])
        for i, place in enumerate(places):
            last = i + 1 == len(places)
            there = math.dist((place["x"], place["y"]), (thing["x"], thing["y"])) < 0.01
            near = min((math.dist((place["x"], place["y"]), (mark["x"], mark["y"])) for mark in landmarks
                        if mark["class"] == thing["kind"]), default=math.inf)
            state = "there" if last else "there again" if there else "gone"
            right = (near <= GATE_M) == (last or there)
            lines.append(f"| {thing['kind']} {thing['id']} | {place['x']:.2f}, {place['y']:.2f} | {place['since_s'] / HOUR_S:.2f} | {state} | "
                         f"{near:.2f}{'' if right else ' **wrong**'} |")
    return "\n".join(lines)


def main(argv=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--hours", type=float, default=8)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--set", nargs="+", action="extend", default=["detection.class=RecordedDetector"], metavar="K=V")
    parser.add_argument("--name", default="run", help="of the folder for this run's results in OUT")
    parser.add_argument("--out", type=Path, default=seeds.ROOT / "out" / "soak")
    parser.add_argument("--program", type=Path, default=seeds.PROGRAM)
    arguments = parser.parse_args(argv)
    program, out = seeds.Program(arguments.program), arguments.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    world = out / f"patrol_{arguments.hours:g}_hours.json"
    world.write_text(json.dumps(patrol(json.loads((seeds.ROOT / "worlds" / "lab.json").read_text()), arguments.hours)))
    truth, run = seeds.sequence(program, world, arguments.seed, out / "sequences"), out / arguments.name
    rawlog = next(truth.glob("*.rawlog"))
    samples, failure = watched_run(program, rawlog, run, arguments.set)
    if failure:
        sys.exit(failure)
    reports = []
    for name, of in seeds.evaluations(truth, run, False):
        if name == "detections":
            continue
        report = run / f"{name}_score.json"
        problem = program.call("evaluate", *of, "--json", report)
        reports.append(f"{name}: {problem or report.read_text()}")
    text = "\n\n".join([hour_table(samples, run, truth, arguments.hours), moved_table(truth, run)])
    (run / "table.md").write_text(text + "\n")
    print(text, *reports, sep="\n\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
