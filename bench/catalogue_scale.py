#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes results of runs that never took place, imports them, and times what the catalogue is asked.

    bench/catalogue_scale.py [--runs 100000] [--variants 4] [--like RESULT.json] [--out DIR]

The results are like RESULT.json (of a real run; without one a small one is made up), with figures drawn anew. They are imported in four
steps, so that it shows whether the last one takes longer than the first. Prints one line for each time.
"""
import argparse
import json
import random
import shutil
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "build" / "release" / "bin" / "roomgraph"
STEPS = 4


def pattern(file):
    if file:
        return json.loads(file.read_text())
    figures = ("trajectory.ate_rmse_m", "objects.f1", "map.f1", "run.wall_s", "run.peak_memory_mb")
    return {"format": "roomgraph run result", "format_version": 1, "name": "", "variant": "", "status": "complete", "reason": "",
            "input": {"name": "", "group": "", "seed": 0, "path": "/x.rawlog", "sha256": "", "bytes": 1}, "key": "k", "evaluation_key": "e",
            "version": "0", "revision": "r", "program": "p", "command": ["run"], "exit_code": 0, "started": "2026-01-01T00:00:00Z",
            "wall_s": 1.0, "cpu_s": 1.0, "peak_memory_mb": 1.0, "keep": "all", "figures": {name: 1.0 for name in figures},
            "timings": {"tracking": {"calls": 1, "total_ms": 1.0, "max_ms": 1.0}}, "failures": [], "files": {"map.rgmap": 1},
            "parameters": {f"section.key_{i}": str(i) for i in range(200)}}


def write(folder, result, number, variants, draw):
    """Result `number`: inputs of ten groups, each with every variant."""
    place, variant = divmod(number, variants)
    name = f"group{place % 10}_s{place // 10}"
    result["variant"] = "default" if variant == 0 else f"variant_{variant}"
    result["name"] = f"{name}--{result['variant']}"
    result["input"].update(name=name, group=f"group{place % 10}", seed=place // 10, sha256=f"{place:064x}")
    result["parameters"]["lidar.enabled"] = str(variant)
    base = random.Random(place)
    result["figures"] = {key: base.random() + draw.gauss(0.01 * variant, 0.1) for key in result["figures"]}
    run = folder / result["name"]
    run.mkdir()
    (run / "result.json").write_text(json.dumps(result, indent=1))


def timed(label, *words):
    started = time.monotonic()
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    seconds = time.monotonic() - started
    if done.returncode:
        sys.exit(f"{label}: {done.stderr}")
    print(f"{label}: {seconds:.2f} s", flush=True)
    return seconds


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=100000)
    parser.add_argument("--variants", type=int, default=4)
    parser.add_argument("--like", type=Path)
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "catalogue_scale")
    parser.add_argument("--program", type=Path, default=PROGRAM)
    arguments = parser.parse_args()
    shutil.rmtree(arguments.out, ignore_errors=True)
    runs = arguments.out / "runs"
    runs.mkdir(parents=True)
    result, draw = pattern(arguments.like), random.Random(1)
    for step in range(STEPS):
        first, last = (arguments.runs * part // STEPS for part in (step, step + 1))
        for number in range(first, last):
            write(runs, result, number, arguments.variants, draw)
        timed(f"import of runs {first + 1} to {last}", arguments.program, "batch", "import", arguments.out)
    size = (arguments.out / "catalogue.sqlite").stat().st_size
    print(f"catalogue: {size / 1e6:.0f} MB, {size / arguments.runs:.0f} bytes a run; {len(result['figures'])} figures a run")
    timed("import when nothing is new", arguments.program, "batch", "import", arguments.out)
    timed("status", arguments.program, "batch", "status", arguments.out)
    timed("compare", arguments.program, "batch", "compare", arguments.out)
    timed("report", arguments.program, "batch", "report", arguments.out)
    timed("query of one mean", arguments.program, "batch", "query", arguments.out,
          "SELECT variant, avg(value) FROM figures WHERE figure = 'trajectory.ate_rmse_m' GROUP BY variant")
    return 0


if __name__ == "__main__":
    sys.exit(main())
