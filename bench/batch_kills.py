#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Kills a batch at random moments, goes on with the same command, and compares what comes out with an undisturbed batch.

    bench/batch_kills.py JOBS.yaml|RAWLOG... [--kills 30] [--longest 3] [--seed 1] [--jobs 2] [--out DIR]

Each kill is SIGKILL to the batch, to one of its runs, or to all its processes at once, in turn, after a random time of at most
--longest seconds. A batch that ends before its kill is compared and begun anew in an empty folder. Trajectories, maps, landmarks, graphs,
associations and figures (but those of time and memory) have to be the same bits, and no process may be left.
"""
import argparse
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "build" / "release" / "bin" / "roomgraph"
SAME = ("trajectory.tum", "landmarks.json", "map.pgm", "graph.g2o", "associations.jsonl")
KINDS = ("the batch", "a run", "all")


def processes(folder, word=None):
    """Ids of those whose command line names the folder (and has the word)."""
    found = []
    for entry in Path("/proc").iterdir():
        try:
            words = (entry / "cmdline").read_bytes().decode(errors="replace").split("\0") if entry.name.isdigit() else []
        except OSError:
            continue
        if len(words) > 1 and words[0].endswith("roomgraph") and any(str(folder) in part for part in words) and (not word or words[1] == word):
            found.append(int(entry.name))
    return found


def kill(pids):
    for pid in pids:
        try:
            os.kill(pid, signal.SIGKILL)
        except ProcessLookupError:
            pass


def outcome(program, folder):
    """What must not depend on what happened on the way."""
    files = {f"{run.name}/{name}": (run / name).read_bytes() for run in sorted((folder / "runs").iterdir()) for name in SAME if (run / name).exists()}
    sql = ("SELECT run, figure, value FROM figures WHERE figure NOT LIKE 'run.%' ORDER BY run, figure")
    tables = subprocess.run([program, "batch", "query", folder, sql, "--csv"], capture_output=True, text=True, check=True).stdout
    states = subprocess.run([program, "batch", "query", folder, "SELECT name, status, key FROM runs ORDER BY name", "--csv"],
                            capture_output=True, text=True, check=True).stdout
    return files, tables, states


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("inputs", nargs="+")
    parser.add_argument("--kills", type=int, default=30)
    parser.add_argument("--longest", type=float, default=3.0, help="seconds before a kill")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "batch_kills")
    parser.add_argument("--program", type=Path, default=PROGRAM)
    arguments = parser.parse_args()
    out, chance = arguments.out.resolve(), random.Random(arguments.seed)
    shutil.rmtree(out, ignore_errors=True)

    def command(folder):
        return [str(part) for part in (arguments.program, "batch", *arguments.inputs, "-o", folder, "--quiet", "--retries", 3, "--jobs", arguments.jobs)]

    started = time.monotonic()
    subprocess.run(command(out / "whole"), check=True, stdout=subprocess.DEVNULL)
    whole_s = time.monotonic() - started
    whole = outcome(arguments.program, out / "whole")
    folder, kills, ends, left, wrong = out / "killed", 0, 0, 0, 0
    while True:
        last = kills >= arguments.kills
        batch = subprocess.Popen(command(folder), stdout=subprocess.DEVNULL)
        if not last:
            try:
                batch.wait(chance.uniform(0.05, arguments.longest))
            except subprocess.TimeoutExpired:
                kind = KINDS[kills % len(KINDS)]
                if kind == "a run":
                    kill(processes(folder, "run")[:1] or [batch.pid])
                else:
                    kill([batch.pid] if kind == "the batch" else processes(folder))
                kills += 1
                if kind != "a run":  # the batch goes on without that one, and tries it again
                    batch.wait()
                    time.sleep(0.3)
                    left += len(processes(folder))
        if batch.wait() == 0:
            ends += 1
            wrong += outcome(arguments.program, folder) != whole
            if last:
                break
            shutil.rmtree(folder)
    print(json.dumps({"runs": len(list((out / "whole" / "runs").iterdir())), "undisturbed_s": round(whole_s, 1), "kills": kills,
                      "batches_ended": ends, "that_differ": wrong, "processes_left": left}))
    return 1 if wrong or left else 0


if __name__ == "__main__":
    sys.exit(main())
