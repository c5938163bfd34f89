#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""How selection of proposals copes with boxes that flicker, on a recording with known truth.

    bench/flickering_boxes.py make TRUTH -o boxes.jsonl     detections from TRUTH/boxes.jsonl: missed, halved, noisy
    bench/flickering_boxes.py compare TRUTH RUN RUN...      choices of the later runs that differ from the first's

TRUTH holds boxes.jsonl and objects.json, as `roomgraph simulate` writes them; RUN is a result of `roomgraph run`.
"""
import argparse
import json
import math
import pathlib
import random

MISSED, HALVED, NOISE_PX, LEAST_VISIBLE = 0.15, 0.08, 2.5, 0.25
CHANGED_M, FARTHER_M = 0.03, 0.01  # places of one box in two runs that differ; differences that count


def frames(truth):
    return [json.loads(line) for line in (truth / "boxes.jsonl").read_text().splitlines()]


def detected(box):
    """A box as the detector gives it: with noise, perhaps one half of it; None: too small."""
    box = [side + random.gauss(0, NOISE_PX) for side in box]
    if random.random() < HALVED:
        middle = (box[0] + box[2]) / 2
        box[2 if random.random() < 0.5 else 0] = middle
    box = [max(0, min(limit, side)) for side, limit in zip(box, (640, 480, 640, 480))]
    return box if min(box[2] - box[0], box[3] - box[1]) >= 8 else None


def make(arguments):
    random.seed(arguments.seed)
    with arguments.output.open("w") as out:
        for frame in frames(arguments.truth):
            boxes = []
            for thing in frame["objects"]:
                if thing["class"] == "other" or thing["visible"] < LEAST_VISIBLE or random.random() < MISSED:
                    continue
                if box := detected(thing["bbox"]):
                    score = max(0.3, min(0.98, random.gauss(0.55 + 0.4 * thing["visible"], 0.1)))
                    boxes.append({"class": thing["class"], "score": score, "bbox": box})
            out.write(json.dumps({"timestamp": frame["t"], "boxes": boxes}) + "\n")


def iou(a, b):
    width, height = min(a[2], b[2]) - max(a[0], b[0]), min(a[3], b[3]) - max(a[1], b[1])
    common = max(0, width) * max(0, height)
    return common / sum(((a[2] - a[0]) * (a[3] - a[1]), (b[2] - b[0]) * (b[3] - b[1]), -common))


def errors(run, truth):
    """By time and box: (place, distance from the true object with the most of the box), m."""
    places = {thing["id"]: thing for thing in json.loads((truth / "objects.json").read_text())["objects"]}
    seen = {round(frame["t"], 3): frame["objects"] for frame in frames(truth)}
    out = {}
    for line in (run / "associations.jsonl").read_text().splitlines():
        record = json.loads(line)
        time = round(record["timestamp"], 3)
        for chosen in record["measurements"]:
            alike = [thing for thing in seen.get(time, []) if thing["class"] == chosen["class"]]
            best = max(alike, key=lambda thing: iou(thing["bbox"], chosen["bbox"]), default=None)
            if best and iou(best["bbox"], chosen["bbox"]) >= 0.2:
                true = places[best["id"]]
                out[time, tuple(chosen["bbox"])] = (chosen["world"][:2], math.dist(chosen["world"][:2], (true["x"], true["y"])))
    return out


def compare(arguments):
    first = errors(arguments.runs[0], arguments.truth)
    print("| run | choices | changed | nearer | farther | mean gain, m | more | of these beyond .3 m |\n|" + " --- |" * 8)
    for run in arguments.runs[1:]:
        now = errors(run, arguments.truth)
        changed = [key for key in now.keys() & first.keys() if math.dist(now[key][0], first[key][0]) > CHANGED_M]
        gains = [first[key][1] - now[key][1] for key in changed]
        more = [now[key][1] for key in now.keys() - first.keys()]
        mean = sum(gains) / max(1, len(gains))
        print(f"| {run.name} | {len(now)} | {len(changed)} | {sum(gain > FARTHER_M for gain in gains)} "
              f"| {sum(gain < -FARTHER_M for gain in gains)} | {mean:.2f} | {len(more)} | {sum(error > 0.3 for error in more)} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    maker = commands.add_parser("make")
    maker.add_argument("truth", type=pathlib.Path)
    maker.add_argument("-o", "--output", type=pathlib.Path, required=True)
    maker.add_argument("--seed", type=int, default=5)
    maker.set_defaults(call=make)
    comparer = commands.add_parser("compare")
    comparer.add_argument("truth", type=pathlib.Path)
    comparer.add_argument("runs", type=pathlib.Path, nargs="+")
    comparer.set_defaults(call=compare)
    arguments = parser.parse_args()
    arguments.call(arguments)


if __name__ == "__main__":
    main()
