#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Simulates a world with N seeds, runs and evaluates each (`roomgraph batch`), and prints median and spread of every figure.

    bench/seeds.py WORLD.json ... [--seeds 10] [--set k=v ...] [--variants name=k=v,k=v ...] [--out DIR]

A table of ablations is one command, for instance

    bench/seeds.py worlds/lab.json --variants no_lidar=lidar.enabled=false no_loops=tracking.loop_closing=false,lidar.loop_closing=false

Worlds without simulated detections need --set detection.models=NETWORK.onnx.
The variant `default` (nothing but --set) always comes first. DIR/batch holds recordings, runs and the catalogue: what is complete and
unchanged is used again by every later call. The tables come from the catalogue and name the program's revision; DIR/figures.json has each
seed's figures.
"""
import argparse
import hashlib
import json
import os
import re
import shlex
import shutil
import sqlite3
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "build" / "release" / "bin" / "roomgraph"

# Report, its key, what the table calls it, format.
FIGURES = [
    ("trajectory", "ate_rmse_m", "ATE, m", ".3f"),
    ("trajectory", "rpe_trans_rmse_m", "RPE, m/s", ".3f"),
    ("trajectory", "rpe_rot_rmse_deg", "RPE, deg/s", ".2f"),
    ("trajectory", "coverage", "share of the time with a pose", ".2f"),
    ("objects", "precision", "objects: precision", ".2f"),
    ("objects", "recall", "objects: recall", ".2f"),
    ("objects", "f1", "objects: F1", ".2f"),
    ("objects", "duplicates", "objects: duplicates", ".0f"),
    ("objects", "position_error_mean_m", "objects: centre error, m", ".3f"),
    ("objects", "yaw_error_mean_deg", "objects: yaw error, deg", ".1f"),
    ("objects", "size_error_mean_m", "objects: size error, m", ".3f"),
    ("objects", "iou3d_mean", "objects: 3D IoU", ".2f"),
    ("objects", "association_accuracy", "association: accuracy", ".3f"),
    ("objects", "association_ece", "association: calibration error", ".3f"),
    ("objects", "identity_switches", "association: identity switches", ".0f"),
    ("detections", "precision", "detections: precision", ".2f"),
    ("detections", "recall", "detections: recall", ".2f"),
    ("detections", "ap", "detections: mean AP", ".2f"),
    ("map", "f1", "map: F1 of occupied", ".3f"),
    ("map", "free_agreement", "map: free agreement", ".3f"),
    ("map", "unknown_share", "map: unknown share", ".3f"),
    ("map", "wall_distance_mean_m", "map: wall distance, mean m", ".3f"),
    ("map", "wall_distance_p95_m", "map: wall distance, 95 % m", ".3f"),
    ("run", "seconds", "time of the run, s", ".0f"),
    ("run", "peak_memory_mb", "peak memory, MB", ".0f"),
]


def parse_variant(text):
    """'name=k=v,k=v' -> (name, ['k=v', 'k=v']); a comma inside a value stays where no 'section.key=' follows."""
    name, _, settings = text.partition("=")
    parts = re.split(r",(?=[A-Za-z_]\w*\.[\w.]+=)", settings) if settings else []
    if not name or not re.fullmatch(r"[\w.+-]+", name) or any("=" not in part for part in parts):
        raise argparse.ArgumentTypeError(f"'{text}' is not name=section.key=value,section.key=value")
    return name, parts


def quantile(values, share):
    """Linear between the two nearest of the sorted values."""
    ordered, place = sorted(values), share * (len(values) - 1)
    low = int(place)
    high = min(low + 1, len(ordered) - 1)
    return ordered[low] + (place - low) * (ordered[high] - ordered[low])


def spread(values, pattern):
    """'median (quartile .. quartile) [least .. largest]'."""
    if not values:
        return "-"
    low, first, middle, third, high = (format(quantile(values, q), pattern) for q in (0, 0.25, 0.5, 0.75, 1))
    return f"{middle} ({first} .. {third}) [{low} .. {high}]" if len(values) > 1 else middle


class Program:
    def __init__(self, path):
        self.path = path

    def call(self, *arguments):
        """None when it worked, else one line about what went wrong."""
        command = [str(a) for a in (self.path, *arguments)]
        environment = {**os.environ, "XDG_DATA_HOME": os.devnull}  # no networks that somebody has installed
        done = subprocess.run(command, capture_output=True, text=True, env=environment)
        if done.returncode == 0:
            return None
        reason = done.stderr.strip().splitlines()
        return f"{shlex.join(command)}: exit {done.returncode}: {reason[-1] if reason else 'no message'}"

    def simulator_version(self):
        """Changes with the simulator's code, so that no sequence of an older one is used."""
        libraries = sorted(self.path.resolve().parent.parent.glob("lib*/**/libroomgraph_simulation.so"))
        return libraries[0].read_bytes() if libraries else b""


def simulated(program, name, content, seed, folder, arguments):
    """Folder of a simulated sequence; simulated into a folder beside it first, so that no half of one is ever used. It is used
    again until `content` (bytes that describe what is simulated) or the simulator changes."""
    key = hashlib.sha256(content + program.simulator_version()).hexdigest()[:12]
    target = folder / f"{name}_{key}" / f"seed_{seed}"
    if target.exists():
        return target
    partial = target.with_name(target.name + ".partial")
    shutil.rmtree(partial, ignore_errors=True)
    partial.mkdir(parents=True)
    problem = program.call("simulate", *arguments, "-o", partial, "--seed", seed, "--quiet")
    if problem:
        sys.exit(problem)
    partial.rename(target)
    return target


def sequence(program, world, seed, folder):
    """Folder of the sequence of a world file."""
    return simulated(program, world.stem, world.read_bytes(), seed, folder, [world])


def evaluations(truth, run, handheld):
    """Report, and arguments of the evaluation that makes it, of each whose files are there. Landmarks and map are aligned by
    the trajectories; without a robot these are the camera's."""
    path = truth / ("groundtruth.txt" if handheld else "groundtruth_robot.txt")
    estimate, boxes = run / ("trajectory_camera.tum" if handheld else "trajectory.tum"), truth / "boxes.jsonl"
    aligned = ["--truth-trajectory", path, "--trajectory", estimate]
    yield "trajectory", ["trajectory", path, estimate]
    if (run / "landmarks.json").exists():
        images = ["--truth-boxes", boxes, "--associations", run / "associations.jsonl"] if boxes.exists() else []
        yield "objects", ["objects", truth / "objects.json", run / "landmarks.json", *images, *aligned]
    if boxes.exists() and (run / "detections.jsonl").stat().st_size > 0:
        yield "detections", ["detections", boxes, run / "detections.jsonl"]
    if (truth / "map_truth.yaml").exists() and (run / "map.yaml").exists():
        yield "map", ["map", truth / "map_truth.yaml", run / "map.yaml", *aligned]


def measure(program, truth, run, handheld, settings, threads, reports_of=evaluations, figures_of=FIGURES):
    """The figures of one run by report and key; what failed, and why the run did without something."""
    shutil.rmtree(run, ignore_errors=True)
    rawlog = next(truth.glob("*.rawlog"), None)
    if rawlog is None:
        sys.exit(f"{truth}: holds no rawlog")
    overrides = [part for setting in settings for part in ("--set", setting)]
    started = time.monotonic()
    problem = program.call("run", rawlog, "-o", run, "--quiet", "--no-snapshot", "--threads", threads, *overrides)
    if problem:
        return {}, [problem]
    summary = json.loads((run / "summary.json").read_text())
    reports = {"run": {"seconds": time.monotonic() - started, "peak_memory_mb": summary.get("peak_memory_mb")}}
    problems = [f"{count} x {reason}" for reason, count in summary.get("reasons", {}).items()]
    for name, arguments in reports_of(truth, run, handheld):
        report = run / f"{name}_score.json"
        problem = program.call("evaluate", *arguments, "--json", report)
        if problem:
            problems.append(problem)
        else:
            reports[name] = json.loads(report.read_text())
    figures = {f"{report}.{key}": reports.get(report, {}).get(key) for report, key, *_ in figures_of}
    return {name: value for name, value in figures.items() if value is not None}, problems


def table(world, results, revisions):
    """Markdown; results: variant -> list of the seeds' figures (empty: the run failed)."""
    most = max(len(seeds) for seeds in results.values())
    lines = [f"### {world}", "",
             f"Median (quartiles) [least .. largest] of {most} seeds; with a number in front where fewer have the figure. "
             f"Program {', '.join(revisions) or '-'}.", "",
             "| figure | " + " | ".join(results) + " |", "| --- |" + " --- |" * len(results)]
    rows = [("runs that failed", [str(sum(not figures for figures in seeds)) for seeds in results.values()])]
    for report, key, label, pattern in FIGURES:
        cells = []
        for seeds in results.values():
            values = [figures[f"{report}.{key}"] for figures in seeds if f"{report}.{key}" in figures]
            cells.append((f"{len(values)}: " if 0 < len(values) < len(seeds) else "") + spread(values, pattern))
        if any(cell != "-" for cell in cells):
            rows.append((label, cells))
    return "\n".join(lines + [f"| {label} | " + " | ".join(cells) + " |" for label, cells in rows]) + "\n"


def job_file(arguments, seeds, variants):
    """What `roomgraph batch` is to do, as JSON, which is YAML."""
    return {"inputs": [{"simulate": {"world": str(world.resolve()), "seeds": f"{seeds[0]}-{seeds[-1]}"}} for world in arguments.worlds],
            "variants": [{"name": name, "set": arguments.set + settings} for name, settings in variants.items()],
            "limits": {"jobs": arguments.jobs, "threads": arguments.threads}}


def batch(program, out, jobs):
    """Lets `roomgraph batch` do `jobs` (what a job file says) in OUT/batch; its exit code. No networks that somebody has installed."""
    out.mkdir(parents=True, exist_ok=True)
    (out / "jobs.yaml").write_text(json.dumps(jobs, indent=1) + "\n")
    return subprocess.run([str(part) for part in (program, "batch", out / "jobs.yaml", "-o", out / "batch")],
                          env={**os.environ, "XDG_DATA_HOME": os.devnull}, stdout=subprocess.DEVNULL).returncode


def catalogued(catalogue, group, seeds, variants, figures_of=FIGURES):
    """The figures of the runs of a group of inputs (a world), variant by variant and seed by seed; the program's revisions; what went
    wrong, in lines."""
    results, revisions, problems = {name: [{} for _ in seeds] for name in variants}, set(), []
    for run, seed, variant, status, reason, revision in catalogue.execute(
            "SELECT runs.name, seed, variant, status, reason, revision FROM runs JOIN inputs ON inputs.id = input_id "
            "WHERE input_group = ? ORDER BY runs.name", [group]):
        if variant not in results or seed not in seeds:
            continue  # of an earlier call
        if reason:
            problems.append(f"{run}: {reason}")
        if status == "complete":
            revisions.add(revision)
            figures = dict(catalogue.execute("SELECT figure, value FROM figures WHERE run = ?", [run]))
            figures["run.seconds"] = figures.pop("run.wall_s", None)
            wanted = {f"{report}.{key}" for report, key, *_ in figures_of}
            results[variant][seeds.index(seed)] = {name: value for name, value in figures.items() if name in wanted and value is not None}
    return results, sorted(revisions), problems


def arguments_of(argv):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("worlds", nargs="+", type=Path, metavar="WORLD.json")
    parser.add_argument("--seeds", type=int, default=10, help="how many (default 10)")
    parser.add_argument("--first-seed", type=int, default=1)
    parser.add_argument("--set", nargs="+", action="extend", default=[], metavar="K=V", help="for every variant")
    parser.add_argument("--variants", nargs="+", action="extend", default=[], type=parse_variant, metavar="NAME=K=V,K=V")
    parser.add_argument("--threads", type=int, default=1, help="of each run")
    parser.add_argument("--jobs", type=int, default=0, help="runs at once; 0: cores / threads")
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "seeds")
    parser.add_argument("--program", type=Path, default=PROGRAM)
    arguments = parser.parse_args(argv)
    if arguments.seeds < 1:
        parser.error("--seeds must be at least 1")
    for world in arguments.worlds:
        if not world.is_file():
            parser.error(f"{world}: no such file")
    return arguments


def main(argv=None):
    arguments = arguments_of(argv)
    out = arguments.out.resolve()
    variants = {"default": [], **dict(arguments.variants)}
    seeds = list(range(arguments.first_seed, arguments.first_seed + arguments.seeds))
    ended = batch(arguments.program, out, job_file(arguments, seeds, variants))
    if ended not in (0, 1):
        return ended
    catalogue = sqlite3.connect(out / "batch" / "catalogue.sqlite")
    everything, tables = {}, []
    for world in arguments.worlds:
        results, revisions, problems = catalogued(catalogue, world.stem, seeds, variants)
        print(*problems, sep="\n", file=sys.stderr)
        everything[world.stem] = results
        tables.append(table(world.stem, results, revisions))
    catalogue.close()
    (out / "figures.json").write_text(json.dumps(everything, indent=1) + "\n")
    (out / "table.md").write_text("\n".join(tables))
    print("\n".join(tables))
    return 0 if all(figures for results in everything.values() for seeds in results.values() for figures in seeds) else 1


if __name__ == "__main__":
    sys.exit(main())
