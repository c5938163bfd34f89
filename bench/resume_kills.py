#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Kills runs at random moments, resumes them, and compares what comes out with an undisturbed run, byte by byte.

    bench/resume_kills.py RAWLOG [--kills 30] [--per-run 3] [--seed 1] [--until S] [--set KEY=VALUE]... [--out DIR]

A run is killed (SIGKILL) after a random share of the time that the undisturbed run takes, and resumed until it was killed --per-run
times; then it goes on to its end, with one thread or with all in turn. A run without checkpoints says what they cost. All files have
to be the same bits but timings.csv, report.html, and of summary.json the times, the memory, the command line and `resumed`.
Prints a table in Markdown: where a run was killed, what the journal held, how long it took to come to that place again, and what that is of
the time lost; then JSON with the sums.
"""
import argparse
import json
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "build" / "release" / "bin" / "roomgraph"
TIMED = {"timings.csv", "report.html"}
TIMED_KEYS = {"timings", "peak_memory_mb", "wall_s", "command", "resumed"}


def results(folder):
    files = {file.name: file.read_bytes() for file in folder.iterdir() if file.is_file() and file.name not in TIMED}
    summary = json.loads(files["summary.json"])
    files["summary.json"] = json.dumps({key: value for key, value in summary.items() if key not in TIMED_KEYS}).encode()
    return files


def share_of(progress):
    try:
        return float(progress.read_text())
    except (OSError, ValueError):
        return 0.0


class Killing:
    """One run that is killed and resumed until it may come to its end."""

    def __init__(self, arguments, folder, whole_s):
        self.arguments, self.folder, self.whole_s = arguments, folder, whole_s
        self.progress = folder.parent / "progress"
        self.share = 0.0  # at which the last attempt was killed
        self.rows = []

    def command(self, threads):
        begun = (self.folder / "roomgraph_checkpoint" / "run.json").exists()
        words = ["--resume", self.folder] if begun else [*self.arguments, "-o", self.folder, "--no-snapshot"]
        return [str(word) for word in ("run", *words, "--quiet", "--progress-file", self.progress, "--threads", threads)]

    def attempt(self, program, seconds, threads):
        """Runs for so many seconds (None: to its end); whether it is complete."""
        journal = self.folder / "roomgraph_checkpoint" / "results.journal"
        kept = journal.stat().st_size if journal.exists() else 0
        self.progress.unlink(missing_ok=True)
        started, again = time.monotonic(), None
        run = subprocess.Popen([program, *self.command(threads)], stdout=subprocess.DEVNULL)
        while run.poll() is None and (seconds is None or time.monotonic() - started < seconds):
            if again is None and share_of(self.progress) >= self.share:
                again = time.monotonic() - started
            time.sleep(0.01)
        if run.poll() is None:
            os.kill(run.pid, signal.SIGKILL)
        code = run.wait()
        if code not in (0, -signal.SIGKILL):
            sys.exit(f"exit code {code}")
        before = self.share
        self.share = max(self.share, share_of(self.progress))
        self.rows.append({"from": before, "journal_mb": kept / 1e6, "again_s": again, "killed_at": self.share if code else None})
        return code == 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recording")
    parser.add_argument("--kills", type=int, default=30)
    parser.add_argument("--per-run", type=int, default=3)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--until", type=float, default=0)
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "resume_kills")
    parser.add_argument("--program", type=Path, default=PROGRAM)
    arguments = parser.parse_args()
    out, chance = arguments.out.resolve(), random.Random(arguments.seed)
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    words = [arguments.recording, "--until", arguments.until] + [word for one in arguments.set for word in ("--set", one)]

    def undisturbed(name, *more):
        """Seconds by the clock, and of the processor."""
        started, before = time.monotonic(), resource.getrusage(resource.RUSAGE_CHILDREN)
        command = [arguments.program, "run", *words, "-o", out / name, "--no-snapshot", "--quiet", *more]
        subprocess.run([str(word) for word in command], check=True, stdout=subprocess.DEVNULL)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return time.monotonic() - started, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    (bare_s, bare_cpu_s), (whole_s, whole_cpu_s) = undisturbed("bare", "--checkpoint", 0), undisturbed("whole")
    whole = results(out / "whole")
    wrong = 0 if results(out / "bare") == whole else 1
    print("| run | from | journal MB | there again s | of the time to there | killed at |\n| --- | --- | --- | --- | --- | --- |")
    kills, runs, again, first = 0, 0, 0.0, 0.0
    while kills < arguments.kills:
        runs += 1
        killing = Killing(words, out / "killed", whole_s)
        done = False
        for _ in range(min(arguments.per_run, arguments.kills - kills)):
            done = killing.attempt(arguments.program, chance.uniform(0.02, 0.98) * whole_s, 1 if runs % 2 else 0)
            kills += not done
            if done:
                break
        if not done:
            killing.attempt(arguments.program, None, 0)
        for row in killing.rows:
            share = f"{row['again_s'] / (row['from'] * whole_s):.2f}" if row["from"] > 0.05 and row["again_s"] else "-"
            if share != "-":
                again, first = again + row["again_s"], first + row["from"] * whole_s
            reached = "-" if row["again_s"] is None else f"{row['again_s']:.1f}"
            end = "end" if row["killed_at"] is None else f"{row['killed_at']:.2f}"
            print(f"| {runs} | {row['from']:.2f} | {row['journal_mb']:.2f} | {reached} | {share} | {end} |")
        same = results(out / "killed") == whole
        wrong += not same
        print(f"run {runs}: {'the same bits' if same else 'DIFFERS'}", file=sys.stderr)
        shutil.rmtree(out / "killed")
    print(json.dumps({"without_checkpoints_s": round(bare_s, 2), "undisturbed_s": round(whole_s, 2),
                      "without_checkpoints_cpu_s": round(bare_cpu_s, 2), "undisturbed_cpu_s": round(whole_cpu_s, 2),
                      "kills": kills, "runs": runs, "that_differ": wrong, "time_to_be_there_again": round(again / first, 3) if first else None}))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
