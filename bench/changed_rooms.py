#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Simulates flats twice, with furniture changed in between, and continues the map of the first visit on the second.

    bench/changed_rooms.py [--flats 1-4] [--changes 2] [--out DIR] [--program PROGRAM]

The second visit drives the path backwards, with other noise; of the chairs that the first map knows some are gone, and as many stand
where nothing stood before, beside the path. Both chosen by the flat's number. The frame of the first map is laid onto the truth by
the first run's trajectory; nothing is aligned afterwards. Counted are the true objects of the second visit that its camera saw
(half visible in twenty frames or more) and, of what is gone, what the continued map still holds. Simulated recordings and boxes.

Prints Markdown; DIR/changed.json keeps all figures. Exit codes: 0 done, 1 a run failed or was laid into the wrong place, 2 usage.
"""
import argparse
import json
import math
import random
import subprocess
import sys
from collections import Counter
from pathlib import Path

import continue_map
import flats
import seeds

CHAIR, COUNT, NEAR_M, WRONG_M = "swivel_chair", ("swivel_chair", "sofa", "door"), 0.5, 0.5
CLEAR_M, FROM_PATH_M, SEEN_FRAMES, FREE = 0.6, (0.9, 2.2), 20, 250


def objects_of(file):
    read = json.loads(file.read_text(encoding="utf-8"))
    return [o for o in read.get("objects", read.get("landmarks", [])) if o["class"] in COUNT]


def placed(frame, x, y):
    turn, dx, dy = frame
    c, s = math.cos(turn), math.sin(turn)
    return dx + c * x - s * y, dy + s * x + c * y


def free_places(folder, path, count, draw):
    """Places (m, in the frame of the truth) with nothing near, beside the path."""
    info = dict(line.split(": ", 1) for line in (folder / "map_truth.yaml").read_text(encoding="utf-8").splitlines() if ": " in line)
    resolution, origin = float(info["resolution"]), json.loads(info["origin"])
    image = (folder / "map_truth.pgm").read_bytes()
    width, height = map(int, image.split(b"\n", 2)[1].split())
    pixels, clear, out = image[-width * height:], math.ceil(CLEAR_M / resolution), []
    for _ in range(100000):
        u, v = draw.randrange(clear, width - clear), draw.randrange(clear, height - clear)
        x, y = origin[0] + (u + 0.5) * resolution, origin[1] + (height - v - 0.5) * resolution
        off = min(math.hypot(x - px, y - py) for px, py in path)
        if not FROM_PATH_M[0] < off < FROM_PATH_M[1] or any(math.hypot(x - px, y - py) < 1.5 for px, py in out):
            continue
        if all(pixels[row * width + column] > FREE for row in range(v - clear, v + clear) for column in range(u - clear, u + clear)):
            out.append((x, y))
            if len(out) == count:
                break
    return out


class Flat:
    """Both visits of one flat. Frames: `world` of its description, `truth` of a visit's first pose, `map` of the first run."""

    def __init__(self, number, arguments):
        self.number, self.arguments, self.draw = number, arguments, random.Random(number)
        self.first, self.second = arguments.out / f"flat_{number}", arguments.out / f"flat_{number}_later"

    def call(self, *arguments):
        done = subprocess.run([str(self.arguments.program), *map(str, arguments)], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise RuntimeError(f"roomgraph {' '.join(map(str, arguments))}: {done.stderr.strip()}")

    def run(self, folder, *more):
        self.call("run", next(folder.glob("*.rawlog")), "-o", folder / "run", *continue_map.QUIET, *more)
        return folder / "run"

    def first_visit(self):
        if not list(self.first.glob("*.rawlog")):
            self.call("simulate", "--flat", self.number, "-o", self.first, "--quiet")
        run = self.run(self.first)
        self.world = json.loads((self.first / "world.json").read_text(encoding="utf-8"))
        self.described = [f for f in self.world["furniture"] if f["model"] == CHAIR]
        truth = [o for o in objects_of(self.first / "objects.json") if o["class"] == CHAIR]
        places = {i: (*f["at_m"], 0) for i, f in enumerate(self.described)}
        self.world_from_truth = continue_map.aligned(places, {i: (o["x"], o["y"], 0) for i, o in enumerate(truth)})
        self.path = [pose[:2] for pose in continue_map.poses_of(self.first / "groundtruth_robot.txt").values()]
        self.map_from_truth = continue_map.aligned(continue_map.poses_of(run / "trajectory.tum"),
                                                   continue_map.poses_of(self.first / "groundtruth_robot.txt"))
        self.map_from_world = lambda x, y: placed(self.map_from_truth, *unplaced(self.world_from_truth, x, y))
        landmarks = objects_of(run / "landmarks.json")
        return [i for i, f in enumerate(self.described) if near(self.map_from_world(*f["at_m"]), CHAIR, landmarks)]

    def second_visit(self, known):
        """Simulates it; places (map) of the chairs that are gone, and of those that are new."""
        gone = sorted(self.draw.sample(known, min(len(known), self.arguments.changes)))
        new = [placed(self.world_from_truth, *p) for p in free_places(self.first, self.path[::5], self.arguments.changes, self.draw)]
        leave = [self.described[i] for i in gone]
        self.world["furniture"] = [f for f in self.world["furniture"] if f not in leave]
        self.world["furniture"] += [{"model": CHAIR, "at_m": [round(v, 3) for v in p], "yaw_deg": self.draw.randrange(360)} for p in new]
        self.world["robot"]["path_m"].reverse()
        description = self.second.parent / f"{self.second.name}.json"
        description.write_text(json.dumps(self.world), encoding="utf-8")
        if not list(self.second.glob("*.rawlog")):
            self.call("simulate", description, "--seed", 5000 + self.number, "-o", self.second, "--quiet")
        return [self.map_from_world(*f["at_m"]) for f in leave], [self.map_from_world(*p) for p in new]

    def figures(self):
        known = self.first_visit()
        gone, new = self.second_visit(known)
        run = self.run(self.second, "--map", self.first / "run" / "map.rgmap")
        said = json.loads((run / "summary.json").read_text(encoding="utf-8"))["earlier_map"]
        out = {"flat": self.number, **said, "gone": len(gone), "new": 0, "new_mapped": 0, "other": 0, "other_mapped": 0}
        estimate = continue_map.poses_of(run / "trajectory.tum")
        truth = continue_map.poses_of(self.second / "groundtruth_robot.txt")
        frame = continue_map.aligned(estimate, truth)
        landmarks = objects_of(run / "landmarks.json")
        out["still_there"] = sum(near(place, CHAIR, landmarks) for place in gone)
        shift = math.dist(placed(frame, 0, 0), self.map_from_world(*self.world["robot"]["path_m"][0]))
        out["ate_m"], out["laid_off_m"] = continue_map.errors(truth, estimate, frame)[0], shift
        frames = Counter(o["id"] for line in open(self.second / "boxes.jsonl", encoding="utf-8")
                         for o in json.loads(line)["objects"] if o["visible"] > 0.5)
        for thing in objects_of(self.second / "objects.json"):
            if frames[thing["id"]] < SEEN_FRAMES:
                continue
            place = placed(frame, thing["x"], thing["y"])
            kind = "new" if any(math.dist(place, p) < NEAR_M for p in new) else "other"
            out[kind] += 1
            out[kind + "_mapped"] += near(place, thing["class"], landmarks)
        print(out, file=sys.stderr)
        return out


def unplaced(frame, x, y):
    turn, dx, dy = frame
    return placed((-turn, 0, 0), x - dx, y - dy)


def near(place, class_name, landmarks):
    return any(o["class"] == class_name and math.dist(place, (o["x"], o["y"])) < NEAR_M for o in landmarks)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--flats", default="1-4", type=flats.parse_seeds, help="1-4 or 3,7 (1 to 99: for choosing; 1000 to 1019: for reporting only)")
    parser.add_argument("--changes", type=int, default=2, help="chairs that are gone, and as many that are new")
    parser.add_argument("--out", type=Path, default=Path("out/changed"))
    parser.add_argument("--program", default=seeds.PROGRAM)
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    rows = [Flat(number, arguments).figures() for number in arguments.flats]
    print("| flat | re-localised | after s | laid off by, m | ATE, m | gone: still in the map | new: mapped | others: mapped |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for r in rows:
        print(f"| {r['flat']} | {r['relocalised']} | {r.get('after_s', math.nan):.1f} | {r['laid_off_m']:.3f} | {r['ate_m']:.3f} | "
              f"{r['still_there']} of {r['gone']} | {r['new_mapped']} of {r['new']} | {r['other_mapped']} of {r['other']} |")
    (arguments.out / "changed.json").write_text(json.dumps(rows, indent=1), encoding="utf-8")
    return 1 if any(r["relocalised"] == "yes" and r["laid_off_m"] > WRONG_M for r in rows) else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except RuntimeError as error:
        print(error, file=sys.stderr)
        sys.exit(1)
