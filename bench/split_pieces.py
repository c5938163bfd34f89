#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Recordings run whole and in pieces that are joined: what that costs in accuracy, and what it saves in time.

    bench/split_pieces.py RAWLOG... [--split '30 s'] [--overlap '10 s'] [--set K=V ...] [--jobs 2] [--out out/split_pieces]
    bench/split_pieces.py --world worlds/lab.json --minutes 4 [--light]...

A world is driven again and again for so many minutes (see long_run.py); --light: with a camera of 320 x 240 px at 5 Hz. Their truth lies beside them. `longest`: the piece that took longest and the join, which is what the result has to be waited for where
there are cores for all pieces.
"""
import argparse
import csv
import io
import json
import subprocess
import sys
from pathlib import Path

import long_run

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "build" / "release" / "bin" / "roomgraph"
FIGURES = {"trajectory.ate_rmse_m": "ATE m", "trajectory.rpe_translation_rmse_m": "RPE m", "objects.recall": "recall", "objects.precision": "precision",
           "objects.centre_error_mean_m": "centre m", "map.wall_distance_mean_m": "walls m"}


def query(program, folder, sql):
    text = subprocess.run([program, "batch", "query", folder, sql, "--csv"], capture_output=True, text=True, check=True).stdout
    return list(csv.DictReader(io.StringIO(text)))


def batch(arguments, folder, more):
    command = [arguments.program, "batch", *arguments.recordings, "-o", folder, "--jobs", str(arguments.jobs), "--quiet", *more]
    for setting in arguments.set:
        command += ["--set", setting]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode not in (0, 1):
        sys.exit(done.stderr)
    return query(arguments.program, folder, "SELECT name, variant, status, reason, wall_s, cpu_s, peak_memory_mb FROM runs ORDER BY name"), {
        (row["run"], row["figure"]): float(row["value"]) for row in query(arguments.program, folder, "SELECT run, figure, value FROM figures")}


def simulated(arguments, folder):
    """The recording of a world that is driven for many minutes, made once."""
    world = long_run.long_world(json.loads(arguments.world.read_text()), arguments.minutes)
    if arguments.light:
        world["sensors"]["camera"] |= {"rate_hz": 5, "width_px": 320, "height_px": 240}
    name = f"{arguments.world.stem}_{arguments.minutes:g}_minutes{'_light' if arguments.light else ''}"
    folder.mkdir(parents=True, exist_ok=True)
    file, sequence = folder / f"{name}.json", folder / f"{name}_s{arguments.seed}"
    file.write_text(json.dumps(world))
    if not list(sequence.glob("*.rawlog")):
        subprocess.run([arguments.program, "simulate", file, "-o", sequence, "--seed", str(arguments.seed), "--quiet"], check=True)
    return next(sequence.glob("*.rawlog"))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recordings", nargs="*")
    parser.add_argument("--world", type=Path)
    parser.add_argument("--minutes", type=float, default=4)
    parser.add_argument("--light", action="store_true")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--split", default="30 s")
    parser.add_argument("--overlap", default="10 s")
    parser.add_argument("--set", nargs="+", action="extend", default=[], metavar="K=V")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "split_pieces")
    parser.add_argument("--program", type=Path, default=PROGRAM)
    arguments = parser.parse_args()
    out = arguments.out.resolve()
    if arguments.world:
        arguments.recordings.append(simulated(arguments, out / "sequences"))
    if not arguments.recordings:
        parser.error("name recordings or a world")
    whole = batch(arguments, out / "whole", [])
    split = batch(arguments, out / "split", ["--split", arguments.split, "--overlap", arguments.overlap])
    names = sorted({figure for _, figure in whole[1] if figure in FIGURES}, key=list(FIGURES).index)
    print("| run | " + " | ".join(FIGURES[name] for name in names) + " | s | longest s | processor s | MB |")
    print("| --- |" + " --- |" * (len(names) + 4))
    for kind, (runs, figures) in (("whole", whole), ("pieces", split)):
        for run in runs:
            if run["variant"].endswith(".piece"):
                continue
            parts = [other for other in runs if other["name"].startswith(run["name"] + ".p")]
            pieces = [float(part["wall_s"]) for part in parts]
            all_of = [run, *parts]
            cells = [f"{figures[run['name'], name]:.3f}" if (run["name"], name) in figures else "-" for name in names]
            print(f"| {run['name'].split('--')[0]}, {kind if not parts else f'{len(parts)} pieces'} | " + " | ".join(cells)
                  + f" | {sum(float(one['wall_s']) for one in all_of):.1f} | {max(pieces, default=0) + float(run['wall_s']):.1f}"
                  + f" | {sum(float(one['cpu_s']) for one in all_of):.1f} | {max(float(one['peak_memory_mb']) for one in all_of):.0f} |")
            if run["status"] != "complete":
                print(f"\n{run['name']}: {run['reason']}\n")
            summary = out / "split" / "runs" / run["name"] / "summary.json"
            if parts and summary.exists():
                by = [piece.get("by", "first") for piece in json.loads(summary.read_text())["pieces"]]
                print(f"<!-- {run['name']}: pieces placed by {', '.join(by)} -->")
    return 0


if __name__ == "__main__":
    sys.exit(main())
