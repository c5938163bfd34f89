#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A run of many minutes: what the stages cost in each minute of it, so that whatever grows is seen.

    bench/long_run.py [WORLD.json] [--minutes 10] [--seed 1] [--camera k=v ...] [--set k=v ...] [--out out/long_run]

The world's path (worlds/lab.json) is driven again and again: up to where it comes back to its start, as often as the minutes
need. --camera changes the world's camera: fewer and smaller images (rate_hz=4 width_px=320 height_px=240) of an hour are rendered
in minutes. The simulated sequence is kept in OUT/sequences and used again. Times are processor time of all threads, which other
programs on the machine disturb little. `back end`: optimisation per key pose, of the window, and what the run itself does for
the whole graph, which a thread beside it optimises.
"""
import argparse
import collections
import csv
import json
import math
import sys
from pathlib import Path

import seeds

BACK_END = ("window of poses", "whole graph")
FRAMES = ("selection", "association")
NEAR_START_M = 0.5


def lap_of(path, closed):
    """The points of one lap, none twice."""
    for i in range(3, len(path)):
        if not closed and math.dist(path[0], path[i]) < NEAR_START_M:
            return path[:i]
    if not closed:
        sys.exit("the world's path never comes back to its start")
    return path


def number_setting(text):
    """'rate_hz=4' -> ('rate_hz', 4)"""
    key, _, value = text.partition("=")
    number = float(value)
    return key, int(number) if number.is_integer() else number


def long_world(world, minutes, camera):
    """The world with a path of so many minutes, and these settings of its camera."""
    world = json.loads(json.dumps(world))
    robot = world["robot"]
    lap = lap_of(robot["path_m"], robot.pop("closed", False))
    length = sum(math.dist(a, b) for a, b in zip(lap, lap[1:] + lap[:1]))
    laps = math.ceil(60 * minutes * robot.get("max_speed_m_s", 0.45) / length)
    robot["path_m"] = lap * laps + lap[:1]
    world["sensors"]["camera"].update(camera)
    return {**world, "name": f"{world['name']}_long", "duration_s": 60 * minutes}


def calls_by_minute(file, stages, last_minute):
    """Minute -> processor ms of each record on which one of the stages ran (summed over them)."""
    spent = collections.defaultdict(float)
    start = None
    with open(file, newline="") as lines:
        for row in csv.DictReader(lines):
            t = float(row["timestamp"])
            start = t if start is None else start
            if row["stage"] in stages:
                spent[t] += float(row["cpu_ms"])
    minutes = collections.defaultdict(list)
    for t, ms in spent.items():
        minutes[min(int((t - start) // 60), last_minute)].append(ms)
    return minutes


def describe(values):
    """'mean / 95 % / largest'."""
    if not values:
        return "-"
    return f"{sum(values) / len(values):.1f} / {seeds.quantile(values, 0.95):.1f} / {max(values):.1f}"


def table(file, last_minute):
    stages = {"back end": BACK_END, "selection and association": FRAMES, **{name: (name,) for name in (*BACK_END, "whole graph beside the run", "object loop closing",
              "scan loop closing", "scan matching", "RGB-D odometry", "proposals")}}
    minutes = {name: calls_by_minute(file, of, last_minute) for name, of in stages.items()}
    lines = ["Processor ms per call: mean / 95 % / largest.", "",
             "| minute | key poses | " + " | ".join(stages) + " |", "| --- |" + " --- |" * (len(stages) + 1)]
    for minute in [*range(last_minute + 1), "all"]:
        values = [[ms for m in (each if minute == "all" else [minute]) for ms in each.get(m, [])] for each in minutes.values()]
        lines.append(" | ".join([f"| {minute if minute == 'all' else minute + 1}", str(len(values[0])), *map(describe, values)]) + " |")
    return "\n".join(lines) + "\n"


def main(argv=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("world", nargs="?", type=Path, default=seeds.ROOT / "worlds" / "lab.json")
    parser.add_argument("--minutes", type=float, default=10)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--camera", nargs="+", type=number_setting, default=[], metavar="K=V", help="of worlds/README.md, sensors.camera")
    parser.add_argument("--set", nargs="+", action="extend", default=["detection.class=RecordedDetector"], metavar="K=V")
    parser.add_argument("--name", default="run", help="of the folder for this run's results in OUT")
    parser.add_argument("--out", type=Path, default=seeds.ROOT / "out" / "long_run")
    parser.add_argument("--program", type=Path, default=seeds.PROGRAM)
    arguments = parser.parse_args(argv)
    if not arguments.world.is_file():
        parser.error(f"{arguments.world}: no such file")
    program, out = seeds.Program(arguments.program), arguments.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    world = out / f"{arguments.world.stem}_{arguments.minutes:g}_minutes.json"
    world.write_text(json.dumps(long_world(json.loads(arguments.world.read_text()), arguments.minutes, dict(arguments.camera))))
    truth, run = seeds.sequence(program, world, arguments.seed, out / "sequences"), out / arguments.name
    figures, problems = seeds.measure(program, truth, run, False, arguments.set, 0)
    if "trajectory.ate_rmse_m" not in figures:
        sys.exit("\n".join(problems))
    live = run / "live_score.json"
    problem = program.call("evaluate", "trajectory", truth / "groundtruth_robot.txt", run / "live.tum", "--json", live)
    if problem:
        sys.exit(problem)
    text = table(run / "timings.csv", math.ceil(arguments.minutes) - 1)
    text += f"\nATE {figures['trajectory.ate_rmse_m']:.4f} m, live {json.loads(live.read_text())['ate_rmse_m']:.4f} m; " \
            f"run of {figures['run.seconds']:.0f} s; {figures['run.peak_memory_mb']:.0f} MB\n"
    (run / "table.md").write_text(text)
    print(text, *problems, sep="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
