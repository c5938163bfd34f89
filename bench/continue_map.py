#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Continues maps of lab_a with cuts of the recording, and says when and where each run was re-localised.

    bench/continue_map.py DATA [--out DIR] [--program PROGRAM] [--length S] [--starts N] [--only NAME ...]

DATA holds lab/lab_a and models/. The networks run once (DIR/boxes.rawlog keeps their boxes; an existing one is used). Maps: of
the whole recording, and of either half; each of N starts, spread over the recording, is continued for S seconds in the map of
the whole and in that of the half that does not hold its start. Also: sources one by one, and --foreign RAWLOG ..., recordings of
other places, which must not be re-localised. The error is that of the robot against ground truth in the frame of the earlier map:
that frame is laid onto the truth by the earlier run's own trajectory, nothing is aligned afterwards. Wrong: re-localised, and on
average more than .5 m off. `of arriving`: within 5 s of being, for the first time, within 1 m of the path that the earlier map was
made on, or of the start where that is later: a half map does not know the other room.

Prints Markdown; DIR/continue.json keeps all figures. Exit codes: 0 done, 1 a run failed or was laid into the wrong place, 2 usage.
"""
import argparse
import json
import math
import subprocess
import sys
from pathlib import Path

NETWORKS = ["nanodet-plus-m-1.5x/nanodet-plus-m_1.5x-416.onnx", "deeplabv3-mnv2-ade20k/deeplabv3_mnv2_ade20k_256x256.onnx"]
WRONG_M, KNOWN_M, SOON_S = 0.5, 1, 5
LENGTH_S, HALF_S = 72, 36
QUIET = ["--quiet", "--no-report", "--no-snapshot"]
# What is taken away, so that one source alone is left.
ALONE = {"objects": ["relocalisation.ambiguity_ratio=0", "relocalisation.views=0"],
         "images": ["relocalisation.ambiguity_ratio=0", "detection.enabled=false"],
         "scans": ["tracking.enabled=false", "detection.enabled=false", "relocalisation.views=0"]}


def poses_of(file):
    """stamp in us -> (x, y, yaw) of a TUM file."""
    out = {}
    for line in file.read_text(encoding="utf-8").splitlines():
        if line.startswith("#") or not line.strip():
            continue
        t, x, y, _, qx, qy, qz, qw = map(float, line.split())
        out[round(t * 1e6)] = (x, y, math.atan2(2 * (qw * qz + qx * qy), 1 - 2 * (qy * qy + qz * qz)))
    return out


def aligned(a, b):
    """(turn, dx, dy) of a_from_b by least squares over common stamps (Umeyama 1991 in the plane, no scale)."""
    pairs = [(a[t], b[t]) for t in a.keys() & b.keys()]
    count = len(pairs)
    ax, ay, bx, by = (sum(pair[k][i] for pair in pairs) / count for k in (0, 1) for i in (0, 1))
    sine = sum((p[1] - ay) * (q[0] - bx) - (p[0] - ax) * (q[1] - by) for p, q in pairs)
    cosine = sum((p[0] - ax) * (q[0] - bx) + (p[1] - ay) * (q[1] - by) for p, q in pairs)
    turn = math.atan2(sine, cosine)
    c, s = math.cos(turn), math.sin(turn)
    return turn, ax - c * bx + s * by, ay - s * bx - c * by


def errors(truth, estimate, map_from_truth):
    """(RMSE of the place in m, of the yaw in degrees) in the frame of the map."""
    turn, dx, dy = map_from_truth
    c, s = math.cos(turn), math.sin(turn)
    place = yaw = 0.0
    common = truth.keys() & estimate.keys()
    for t in common:
        x, y, heading = truth[t]
        ex, ey, eh = estimate[t]
        place += (ex - (c * x - s * y + dx)) ** 2 + (ey - (s * x + c * y + dy)) ** 2
        off = (eh - heading - turn + math.pi) % (2 * math.pi) - math.pi
        yaw += off * off
    count = max(1, len(common))
    return math.sqrt(place / count), math.degrees(math.sqrt(yaw / count))


def arrival(truth, path, start_s, length_s):
    """Seconds from a start until the true robot is within KNOWN_M of a path (poses); None: never."""
    begin = min(truth) / 1e6 + start_s
    for t in sorted(truth):
        if begin <= t / 1e6 <= begin + length_s and any(math.dist(truth[t][:2], p[:2]) < KNOWN_M for p in path):
            return t / 1e6 - begin
    return None


class Bench:
    def __init__(self, arguments):
        self.program, self.out, self.data = arguments.program, arguments.out, arguments.data
        self.out.mkdir(parents=True, exist_ok=True)
        self.truth = poses_of(self.data / "lab/lab_a/groundtruth_robot.txt")

    def call(self, *arguments):
        done = subprocess.run([self.program, *map(str, arguments)], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise RuntimeError(f"roomgraph {' '.join(map(str, arguments))}: {done.stderr.strip()}")
        return done.stdout

    def recording(self):
        boxes = self.out / "boxes.rawlog"
        if not boxes.exists():
            networks = ",".join(str(self.data / "models" / name) for name in NETWORKS)
            self.call("run", self.data / "lab/lab_a/lab_a.rawlog", "-o", self.out / "boxes", *QUIET,
                      "--set", f"detection.models={networks}", "--record-detections", boxes)
        return boxes

    def map_of(self, name, span):
        """(map.rgmap, map_from_truth, true poses of its path) of a part of the recording."""
        folder = self.out / f"map_{name}"
        if not (folder / "map.rgmap").exists():
            self.call("run", self.recording(), "-o", folder, *QUIET, *span)
        poses = poses_of(folder / "trajectory.tum")
        return folder / "map.rgmap", aligned(poses, self.truth), [self.truth[t] for t in sorted(poses.keys() & self.truth.keys())][::5]

    def continued(self, name, recording, map_file, extra):
        folder = self.out / name
        self.call("run", recording, "-o", folder, *QUIET, "--map", map_file, *extra)
        summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
        return folder, summary["earlier_map"]

    def start(self, name, earlier, start_s, length_s, settings=()):
        """Figures of one continued cut."""
        map_file, map_from_truth, path = earlier
        extra = ["--from", f"{start_s:.1f}", "--until", f"{start_s + length_s:.1f}"]
        for setting in settings:
            extra += ["--set", setting]
        folder, said = self.continued(name, self.recording(), map_file, extra)
        out = {"start_s": start_s, "relocalised": said["relocalised"] == "yes", **{k: said.get(k) for k in ("after_s", "by", "objects")}}
        out["arrives_s"] = arrival(self.truth, path, start_s, length_s)
        if out["relocalised"]:
            out["ate_m"], out["yaw_deg"] = errors(self.truth, poses_of(folder / "trajectory.tum"), map_from_truth)
            out["wrong"] = out["ate_m"] > WRONG_M
        print(name, out, file=sys.stderr)
        return out


def median(values):
    values = sorted(values)
    return values[len(values) // 2] if values else float("nan")


def row(name, figures):
    found = [f for f in figures if f["relocalised"]]
    right = [f for f in found if not f["wrong"]]
    after = [f["after_s"] for f in right]
    ways = ", ".join(f"{by} {sum(f['by'] == by for f in right)}" for by in sorted({f["by"] for f in right}))
    return (f"| {name} | {len(right)}/{len(figures)} | {sum(a <= SOON_S for a in after)}/{len(figures)} | "
            f"{sum(f['after_s'] - f['arrives_s'] <= SOON_S for f in right if f['arrives_s'] is not None)}/"
            f"{sum(f['arrives_s'] is not None for f in figures)} | {len(found) - len(right)} | "
            f"{median(after):.1f} / {max(after, default=float('nan')):.1f} | {ways} | "
            f"{median([f['ate_m'] for f in right]):.3f} / {max([f['ate_m'] for f in right], default=float('nan')):.3f} | "
            f"{median([f['yaw_deg'] for f in right]):.2f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", type=Path)
    parser.add_argument("--out", type=Path, default=Path("out/continue"))
    parser.add_argument("--program", default="build/release/bin/roomgraph")
    parser.add_argument("--length", type=float, default=20, help="seconds of each cut")
    parser.add_argument("--starts", type=int, default=10)
    parser.add_argument("--only", nargs="+", default=["whole", "other_half", *ALONE], choices=["whole", "other_half", *ALONE])
    parser.add_argument("--foreign", nargs="*", type=Path, default=[], help="recordings of other places")
    arguments = parser.parse_args()
    if not (arguments.data / "lab/lab_a/lab_a.rawlog").exists():
        parser.error(f"{arguments.data}/lab/lab_a/lab_a.rawlog: no such file")
    bench = Bench(arguments)
    starts = [i * (LENGTH_S - arguments.length) / max(1, arguments.starts - 1) for i in range(arguments.starts)]
    whole = bench.map_of("whole", [])
    halves = [bench.map_of("first", ["--until", HALF_S]), bench.map_of("second", ["--from", HALF_S])]
    all_figures = {}
    for name in arguments.only:
        earlier = [halves[s < HALF_S] if name == "other_half" else whole for s in starts]
        length = [min(arguments.length, HALF_S - s) if name == "other_half" and s < HALF_S else arguments.length for s in starts]
        all_figures[name] = [bench.start(f"{name}_{i}", earlier[i], starts[i], max(5, length[i]), ALONE.get(name, ()))
                             for i in range(len(starts))]
    foreign = {}
    for recording in arguments.foreign:
        foreign[recording.name] = bench.continued(f"foreign_{recording.stem}", recording, whole[0], [])[1]
    print("| map, sources | re-localised | within 5 s | of arriving | wrong | after s, median / most | by | ATE m, median / most | yaw deg |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    for name, figures in all_figures.items():
        print(row(name, figures))
    for name, said in foreign.items():
        print(f"{name} in the map of lab_a: re-localised: {said['relocalised']}")
    (bench.out / "continue.json").write_text(json.dumps({"starts": all_figures, "foreign": foreign}, indent=1), encoding="utf-8")
    wrong = any(f.get("wrong") for figures in all_figures.values() for f in figures)
    return 1 if wrong or any(said["relocalised"] == "yes" for said in foreign.values()) else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except RuntimeError as error:
        print(error, file=sys.stderr)
        sys.exit(1)
