#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes the scores of a network probabilities: runs it over recordings with true boxes and writes NETWORK's .scores.json.

    bench/calibrate_scores.py --network nanodet.onnx data/flat_1 data/flat_2 [-o nanodet.scores.json]

Each folder holds a rawlog and boxes.jsonl, as `roomgraph simulate` writes them. A box is right when its IoU with a true one of
its class is .5 or more. The logits of a class's scores are stretched and shifted to fit that (Platt 1999); classes with fewer
than 20 right boxes are left out. The program uses the file where it lies beside the network. Probabilities hold for scenes such as those in the
recordings: of rendered ones they are no word on a real camera.
"""
import argparse
import collections
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LEAST_SCORE, LEAST_RIGHT, SAME = 0.05, 20, 0.5
LONGEST_STEP, MOST_SLOPE, MOST_SHIFT = 1.0, 100, 100


def iou(a, b):
    width, height = min(a[2], b[2]) - max(a[0], b[0]), min(a[3], b[3]) - max(a[1], b[1])
    common = max(0, width) * max(0, height)
    return common / ((a[2] - a[0]) * (a[3] - a[1]) + (b[2] - b[0]) * (b[3] - b[1]) - common)


def judged(found, true):
    """(score, whether it is right) of boxes of one class in one image; each true box is found once."""
    left, out = list(true), []
    for box in sorted(found, key=lambda box: -box["score"]):
        best = max(left, key=lambda t: iou(box["bbox"], t["bbox"]), default=None)
        right = best is not None and iou(box["bbox"], best["bbox"]) >= SAME
        if right:
            left.remove(best)
        out.append((box["score"], right))
    return out


def fitted(scores, right, steps=100):
    """(slope, shift) of the logistic regression on logits, with the prior of one of each that Platt recommends."""
    logits, good = [math.log(s / (1 - s)) for s in scores], sum(right)
    wanted = {True: (good + 1) / (good + 2), False: 1 / (len(right) - good + 2)}
    slope, shift = 1.0, 0.0
    for _ in range(steps):  # Newton's method
        g0 = g1 = 0.0
        h00 = h11 = 1e-6
        h01 = 0.0
        for x, is_right in zip(logits, right):
            p = 1 / (1 + math.exp(-max(-500.0, min(500.0, slope * x + shift))))
            off, weight = p - wanted[bool(is_right)], p * (1 - p)
            g0, g1 = g0 + off * x, g1 + off
            h00, h01, h11 = h00 + weight * x * x, h01 + weight * x, h11 + weight
        determinant = h00 * h11 - h01 * h01
        step = (h11 * g0 - h01 * g1) / determinant, (h00 * g1 - h01 * g0) / determinant
        shorter = min(1, LONGEST_STEP / max(*map(abs, step), 1e-12))  # far from the end, Newton's steps may lead away from it
        step = step[0] * shorter, step[1] * shorter
        slope, shift = slope - step[0], shift - step[1]
        if max(map(abs, step)) < 1e-9:
            break
    return slope, shift


def lines_of(file, key):
    return {round(line["timestamp" if "timestamp" in line else "t"], 2): line[key] for line in map(json.loads, open(file))}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recordings", nargs="+", type=Path, help="folders with a rawlog and boxes.jsonl")
    parser.add_argument("--network", required=True, type=Path)
    parser.add_argument("--every", type=int, default=3, help="n-th frame is looked at")
    parser.add_argument("--program", type=Path, default=ROOT / "build/release/bin/roomgraph")
    parser.add_argument("-o", "--output", type=Path, help="default: the network's name with .scores.json in place of its ending")
    arguments = parser.parse_args()
    rows = collections.defaultdict(list)
    with tempfile.TemporaryDirectory() as scratch:
        for folder in arguments.recordings:
            rawlog = next(iter(sorted(folder.glob("*.rawlog"))), None)
            if rawlog is None or not (folder / "boxes.jsonl").exists():
                sys.exit(f"{folder}: holds no rawlog with boxes.jsonl beside it")
            out = Path(scratch) / folder.name
            bare = Path(scratch) / "network" / arguments.network.name  # without the calibration of an earlier time
            bare.parent.mkdir(exist_ok=True)
            for suffix in (arguments.network.suffix, ".cfg"):
                if arguments.network.with_suffix(suffix).exists() and not bare.with_suffix(suffix).exists():
                    bare.with_suffix(suffix).symlink_to(arguments.network.with_suffix(suffix).resolve())
            labels = arguments.network.parent / "labels.txt"
            settings = ["class=DnnDetector", f"models={bare}", f"score_threshold={LEAST_SCORE}", f"every_nth_frame={arguments.every}",
                        "track_boxes=false"] + ([f"labels_file={labels}"] if labels.exists() else [])
            command = [arguments.program, "run", rawlog, "-o", out, "--quiet", "--no-report", "--no-snapshot",
                       *(part for s in settings for part in ("--set", "detection." + s))]
            done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
            if done.returncode:
                sys.exit(f"{rawlog}: the run failed with {done.returncode}: {done.stderr.strip()}")
            truth = lines_of(folder / "boxes.jsonl", "objects")
            for t, boxes in lines_of(out / "detections.jsonl", "boxes").items():
                for kind in {box["class"] for box in boxes} if t in truth else ():
                    rows[kind] += judged([b for b in boxes if b["class"] == kind], [b for b in truth[t] if b["class"] == kind])
            print(f"{folder}: {sum(map(len, rows.values()))} boxes so far", file=sys.stderr)
    classes = {}
    for kind, judgements in sorted(rows.items()):
        scores, right = zip(*judgements)
        if sum(right) < LEAST_RIGHT:
            print(f"{kind}: {sum(right)} right boxes of {len(right)} are too few", file=sys.stderr)
            continue
        slope, shift = fitted([min(max(score, 1e-9), 1 - 1e-9) for score in scores], right)
        if not (0.001 <= slope < MOST_SLOPE and abs(shift) < MOST_SHIFT):
            print(f"{kind}: its scores do not tell right boxes from wrong ones (slope {slope:.3g}, shift {shift:.3g})", file=sys.stderr)
            continue
        classes[kind] = {"slope": round(slope, 4), "shift": round(shift, 4), "boxes": len(right), "right": sum(right)}
    output = arguments.output or arguments.network.with_suffix(".scores.json")
    output.write_text(json.dumps({"network": arguments.network.name, "recordings": [f.name for f in arguments.recordings], "classes": classes}, indent=1) + "\n")
    print(output)


if __name__ == "__main__":
    main()
