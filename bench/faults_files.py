# SPDX-License-Identifier: BSD-3-Clause
"""Faults of files and processes: disks that are full, signals at any moment. Used by faults.py.

A case is good when the folder holds the former results or the complete new ones, never some of each."""
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
RECORDINGS = ROOT / "rawlogs"
CHECKPOINT = "roomgraph_checkpoint"
TIMED = {"summary.json", "timings.csv", "report.html"}  # differ between runs of the same input
os.environ["XDG_DATA_HOME"] = os.devnull  # no networks that somebody has installed


def call(words, **more):
    return subprocess.run([str(w) for w in words], capture_output=True, text=True, **more)


def contents(folder):
    """Bytes of every file below a folder, by relative path."""
    folder = Path(folder)
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


def verdict(before, after, complete, exact):
    """'old', 'new' or 'mixture': which results a folder holds. `complete`: what a run without faults leaves; with
    `exact` new results must be equal to it, else (an interrupted run has results of its own) have all its files."""
    telling = {name for name in set(before) | set(complete)
               if name not in TIMED and before.get(name) != complete.get(name)}
    if after.keys() == before.keys() and all(after[n] == before[n] for n in telling & before.keys()):
        return "old"
    if after.keys() != complete.keys() or any(n in before and after[n] == before[n] for n in telling & after.keys()):
        return "mixture"
    return "new" if not exact or all(after[n] == complete[n] for n in telling & after.keys()) else "mixture"


class Disk:
    """A file system in memory of a given size (needs root)."""

    def __init__(self, size):
        self.path = Path(tempfile.mkdtemp(prefix="roomgraph_disk_"))
        if call(["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", self.path]).returncode:
            raise SystemExit("full-disk: cannot mount a file system in memory; be root")

    def __enter__(self):
        return self.path

    def __exit__(self, *_):
        call(["umount", self.path])
        self.path.rmdir()


def total(files):
    return sum(4096 * (1 + len(data) // 4096) for data in files.values())


class FullDisk:
    """One command on disks of several sizes. `prepare(place)` puts what is there before, `command(place)` gives
    the words to call."""

    def __init__(self, name, prepare, command, shares):
        self.name, self.prepare, self.command, self.shares = name, prepare, command, shares

    def run(self, program):
        with tempfile.TemporaryDirectory() as roomy:
            self.prepare(Path(roomy))
            before = contents(roomy)
            done = call([program, *self.command(Path(roomy))])
            if done.returncode:
                raise SystemExit(f"{self.name}: fails without a fault: {done.stderr}")
            complete = contents(roomy)
        written = total(complete)
        for share in self.shares:
            with Disk(total(before) + 8192 + int(share * written)) as place:
                self.prepare(place)
                done = call([program, *self.command(place)])
                lines = [line for line in done.stderr.splitlines() if line.startswith("roomgraph:")]
                yield {"case": f"{self.name}, room for {share:.0%}", "exit": done.returncode,
                       "holds": verdict(before, contents(place), complete, exact=True),
                       "says": lines[-1].replace(str(place), "DISK")[:120] if lines else ""}


def full_disk_cases(program, scratch):
    """20 cases: every command that writes more than a line."""
    tiny, handheld = RECORDINGS / "tiny_room.rawlog", RECORDINGS / "tiny_handheld.rawlog"
    old = scratch / "old"
    call([program, "run", handheld, "-o", old, "--quiet"], check=True)
    busy = scratch / "busy"
    call([program, "run", tiny, "-o", busy, "--quiet"], check=True)
    images = scratch / "tum"
    make_tum_folder(images)

    def former(place):
        shutil.copytree(old, place / "out")

    def nothing(place):
        pass

    def graph(place):
        shutil.copy(busy / "graph.g2o", place / "graph.g2o")

    return [
        FullDisk("second run", former, lambda p: ["run", tiny, "-o", p / "out", "--quiet"],
                 [.05, .15, .25, .35, .45, .55, .6]),
        FullDisk("first run", nothing, lambda p: ["run", tiny, "-o", p / "out", "--quiet"], [.1, .5]),
        FullDisk("run --record-detections", nothing,
                 lambda p: ["run", tiny, "-o", scratch / "other", "--quiet", "--record-detections", p / "copy.rawlog"],
                 [.1, .6]),
        FullDisk("optimize in place", graph,
                 lambda p: ["optimize", p / "graph.g2o", "-o", p / "graph.g2o", "--quiet"], [.2, .6]),
        FullDisk("snapshot", nothing, lambda p: ["snapshot", old / "map.rgmap", "-o", p / "map.png"], [.1, .6]),
        FullDisk("import", nothing, lambda p: ["import", "tum", images, "-o", p / "x.rawlog"], [.1, .6]),
        FullDisk("import with external images", nothing,
                 lambda p: ["import", "tum", images, "-o", p / "x.rawlog", "--external-images"], [.6]),
        FullDisk("simulate", nothing,
                 lambda p: ["simulate", RECORDINGS / "tiny_handheld.json", "-o", p / "world", "--quiet"], [.1, .6]),
    ]


def make_tum_folder(folder, count=12, width=160, height=120):
    """Images of noise: enough for the importer."""
    import struct
    import zlib

    def png(path, depth, channels, rows):
        def chunk(kind, data):
            return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        header = struct.pack(">IIBBBBB", width, height, depth, 2 if channels == 3 else 0, 0, 0, 0)
        raw = b"".join(b"\0" + row for row in rows)
        path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(raw))
                         + chunk(b"IEND", b""))

    generator = random.Random(1)
    for name in ("rgb", "depth"):
        (folder / name).mkdir(parents=True)
    lists = {"rgb": [], "depth": []}
    for i in range(count):
        t = f"{1000 + i / 10:.6f}"
        png(folder / "rgb" / f"{t}.png", 8, 3, [generator.randbytes(3 * width) for _ in range(height)])
        png(folder / "depth" / f"{t}.png", 16, 1,
            [b"".join(struct.pack(">H", 10000 + generator.randrange(4000)) for _ in range(width))
             for _ in range(height)])
        for name in lists:
            lists[name].append(f"{t} {name}/{t}.png\n")
    for name, lines in lists.items():
        (folder / f"{name}.txt").write_text("".join(lines))
    (folder / "camera.json").write_text(
        f'{{"fx": 130, "fy": 130, "cx": {width / 2}, "cy": {height / 2}, "depth_scale": 5000}}')


def full_disk(program):
    """A table of every command on disks that are too small; needs root, to mount file systems in memory."""
    with tempfile.TemporaryDirectory() as scratch:
        cases = [row for case in full_disk_cases(program, Path(scratch)) for row in case.run(program)]
    lines = ["| case | exit | folder holds | message |", "| --- | --- | --- | --- |"]
    return "\n".join(lines + [f"| {c['case']} | {c['exit']} | {c['holds']} | {c['says']} |" for c in cases]) + "\n"


def words_of(code, text, heard):
    """What is wrong with exit code and words of a command that got a signal: it ends well, says it was interrupted, or the signal came
    before it had begun, when it did not heed it."""
    return ["ended at once"] * (heard and code < 0) + ["internal error"] * ("internal error" in text) + [f"exit code {code}"] * (code > 0 and code != 4)


def processes_of(folder, seconds=5):
    """Whether a process that names this folder is left; those that are dying get some seconds."""
    own, ends = str(os.getpid()), time.monotonic() + seconds
    while True:
        left = []
        for process in Path("/proc").glob("[0-9]*"):
            try:
                if process.name != own and str(folder).encode() in (process / "cmdline").read_bytes():
                    left.append(process.name)
            except OSError:
                pass  # it has ended
        if not left or time.monotonic() > ends:
            return left
        time.sleep(0.05)


def heed(kinds):
    """Signals that this process was told to ignore (nohup, a shell's background) reach the programs that it starts again."""
    for kind in kinds:
        if kind != signal.SIGKILL and signal.getsignal(kind) == signal.SIG_IGN:
            signal.signal(kind, signal.SIG_DFL)


def catches(pid, kind):
    """Whether a process has a handler of its own for a signal; before it has, the signal ends it before it has begun."""
    try:
        line = re.search(r"SigCgt:\s*(\w+)", (Path("/proc") / str(pid) / "status").read_text())
    except OSError:
        return False
    return bool(line) and bool(int(line[1], 16) >> (kind - 1) & 1)


def send_at_random(process, kind, longest, generator):
    """Waits for a random time, in half of the cases from when the process heeds signals on, and sends one; whether it is heeded."""
    if generator.random() < 0.5:
        while process.poll() is None and not catches(process.pid, signal.SIGTERM):
            time.sleep(0.01)
    time.sleep(generator.uniform(0, longest))
    heard = catches(process.pid, kind)
    process.send_signal(kind)
    return heard


def tell(wrong, case, said):
    """A case that went wrong, for whoever looks into it."""
    if wrong:
        print(f"{case}: {', '.join(wrong)}: {said.strip()[-300:]}", file=sys.stderr, flush=True)


def progress(done, count):
    if sys.stderr.isatty() or done % 20 == 0:
        print(f"{done} of {count}", end="\r" if sys.stderr.isatty() else "\n", file=sys.stderr, flush=True)


def counts_table(head, rows):
    return "\n".join([f"| {' | '.join(head)} |", "| --- " * len(head) + "|"] +
                     [f"| {' | '.join(map(str, key))} | {n} |" for key, n in sorted(rows.items())]) + "\n"


def signals(program, count, seed=1):
    """A table of runs over former results, ended at random moments by each signal in turn. Poses of an interrupted run that were
    known live must be the first ones of the undisturbed run, to the bit."""
    rows = Counter()
    kinds = [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL]
    heed(kinds)
    generator = random.Random(seed)
    tiny, handheld = RECORDINGS / "tiny_room.rawlog", RECORDINGS / "tiny_handheld.rawlog"
    with tempfile.TemporaryDirectory() as scratch:
        scratch = Path(scratch)
        old, new = scratch / "old", scratch / "new"
        call([program, "run", handheld, "-o", old, "--quiet"], check=True)
        started = time.monotonic()
        call([program, "run", tiny, "-o", new, "--quiet"], check=True)
        usual = time.monotonic() - started
        before, complete = contents(old), contents(new)
        for i in range(count):
            kind, out = kinds[i % len(kinds)], scratch / "out"
            shutil.rmtree(out, ignore_errors=True)
            shutil.copytree(old, out)
            run = subprocess.Popen([program, "run", tiny, "-o", out, "--quiet"], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE, text=True)
            heard = send_at_random(run, kind, 1.1 * usual, generator)
            said = run.communicate()[1]
            if kind == signal.SIGKILL:
                shutil.rmtree(out / "roomgraph_unfinished", ignore_errors=True)
            resumable = (out / CHECKPOINT / "run.json").exists()
            shutil.rmtree(out / CHECKPOINT, ignore_errors=True)
            after = contents(out)
            # An interrupted run has results of its own: none of the former ones, and all files.
            holds = verdict(before, after, complete, exact=False)
            wrong = words_of(run.returncode, said, heard) + ["processes left"] * bool(processes_of(out))
            if holds == "new" and not complete["live.tum"].startswith(after["live.tum"]):
                wrong.append("other poses")
            # A run that is killed may have come to its end already.
            whole = holds == "new" and verdict(before, after, complete, exact=True) == "new"
            if holds == "new" and (resumable if run.returncode == 0 else not resumable and not whole):
                wrong.append("checkpoint of a whole run" if resumable else "no checkpoint")
            rows[kind.name, run.returncode, holds, ", ".join(wrong) or "nothing"] += 1
            tell(wrong, f"{kind.name}, exit code {run.returncode}", said)
            progress(i + 1, count)
    return counts_table(["signal", "exit code (negative: signal)", "folder holds", "wrong", "runs"], rows)


BATCH_SAME = ("trajectory.tum", "landmarks.json", "map.pgm", "graph.g2o", "associations.jsonl", "live.tum")


def results_in(folder):
    """(folder, result.json) of each complete run of a batch."""
    for run in sorted((folder / "runs").glob("*")):
        try:
            result = json.loads((run / "result.json").read_text())
        except (OSError, ValueError):
            continue
        if result.get("status") == "complete":
            yield run, result


def runs_in(folder):
    """Results of complete runs by name."""
    return {run.name: {name: (run / name).read_bytes() for name in BATCH_SAME if (run / name).exists()}
            for run, _ in results_in(folder)}


def programs_in(folder):
    """Checksums of the programs that made the complete runs."""
    return {result["program"] for _, result in results_in(folder)}


def batch_verdict(former, complete, whole, ended, out):
    """What is wrong after a signal: a run that says it is complete has the bits of an undisturbed one, and stays."""
    wrong = words_of(*ended)
    if any(files != whole[name] for name, files in complete.items()):
        wrong.append("other bits")
    if not former <= complete.keys():
        wrong.append("a complete run is gone")
    return wrong + ["processes left"] * bool(processes_of(out))


def batch_signals(program, count, seed=1):
    """A table of batches of two runs, two at a time, told to end at random moments by each signal in turn. One that was not
    over is gone on with until it is, over several signals. Runs that say they are complete must have the same bits as undisturbed
    ones, at every moment; the batch at its end, too."""
    rows, kinds = Counter(), [signal.SIGINT, signal.SIGTERM, signal.SIGHUP]
    heed(kinds)
    generator = random.Random(seed)
    with tempfile.TemporaryDirectory() as scratch:
        scratch = Path(scratch)
        for name in ("tiny_room", "tiny_handheld"):
            shutil.copy(RECORDINGS / f"{name}.rawlog", scratch)

        def command(out):
            return [program, "batch", scratch / "tiny_room.rawlog", scratch / "tiny_handheld.rawlog", "-o", out, "--quiet", "--jobs", "2",
                    "--keep", "all"]
        started = time.monotonic()
        call(command(scratch / "whole"), check=True)
        usual = time.monotonic() - started
        whole = runs_in(scratch / "whole")
        out, ended, former = scratch / "out", 0, set()
        for i in range(count):
            kind = kinds[i % len(kinds)]
            batch = subprocess.Popen(command(out), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
            heard = send_at_random(batch, kind, 0.7 * usual, generator)
            said = batch.communicate()[1]
            if programs_in(out) - programs_in(scratch / "whole"):
                raise SystemExit(f"batch-signals: {program} was built anew meanwhile; its results are not comparable")
            complete = runs_in(out)
            wrong = batch_verdict(former, complete, whole, (batch.returncode, said, heard), out)
            former = set(complete)
            if batch.returncode == 0:
                wrong += ["not all runs"] * (len(complete) != len(whole))
                ended += 1
                shutil.rmtree(out)
                former = set()
            rows[kind.name, batch.returncode, len(complete), ", ".join(wrong) or "nothing"] += 1
            tell(wrong, f"{kind.name}, exit code {batch.returncode}", said)
            progress(i + 1, count)
        call(command(out), check=True)
        last = "the same bits" if runs_in(out) == whole else "WRONG"
    text = counts_table(["signal", "exit code (negative: signal)", "complete runs", "wrong", "batches"], rows)
    return text + f"\n{ended} batches came to their end; the last one, gone on with: {last}\n"
