#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Recall and precision of each network, and what is lost when it runs on every k-th frame only and its boxes are tracked.

    bench/detectors.py --data DATA [--every 3 5] [--meshes] [--only NETWORK ...] [--out OUT]

Writes OUT/detectors.md and OUT/detectors.json (OUT: out/bench). A network runs once over a sequence; what it found stays in
OUT/detectors and is used again (--again: run the networks again). For every k-th frame the recorded boxes of the other frames
are taken away and RecordedDetector replays what is left, once for each of the first k frames to begin with. --meshes adds
worlds/lab_meshes.json with NanoDet (simulated here; worlds/extract_meshes.sh must have run).
"""
import argparse
import json
import os
import shlex
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "build" / "release" / "bin" / "roomgraph"
NETWORKS = {
    "nanodet-plus-m_1.5x-416": "nanodet-plus-m-1.5x/nanodet-plus-m_1.5x-416.onnx",
    "nanodet-plus-m_1.5x-320": "nanodet-plus-m-1.5x/nanodet-plus-m_1.5x-320.onnx",
    "yolox_nano": "yolox-nano/yolox_nano.onnx",
    "yolo-fastest-1.1-xl": "yolo-fastest-1.1-xl/yolo-fastest-1.1-xl.weights",
    "deeplabv3_mnv2_ade20k_256x256": "deeplabv3-mnv2-ade20k/deeplabv3_mnv2_ade20k_256x256.onnx",
}
CLASSES = ["swivel_chair", "sofa", "person", "door"]
# Only the detector is looked at: wheel odometry alone says how the camera moved.
PLAIN = ["lidar.enabled=false", "tracking.enabled=false"]


def call(*arguments):
    command = [str(a) for a in (PROGRAM, *arguments)]
    environment = {**os.environ, "XDG_DATA_HOME": os.devnull}  # no networks that somebody has installed
    done = subprocess.run(command, capture_output=True, text=True, env=environment)
    if done.returncode:
        sys.exit(f"{shlex.join(command)}\nfailed with {done.returncode}: {done.stderr.strip()}")


class Sequence:
    def __init__(self, name, rawlog, boxes, out):
        self.name, self.rawlog, self.boxes, self.out = name, rawlog, boxes, out / "detectors"

    def run(self, name, settings):
        folder = self.out / f"{self.name}_{name}"
        call("run", self.rawlog, "-o", folder, "--quiet", "--no-snapshot",
             *(part for setting in PLAIN + settings for part in ("--set", setting)))
        return folder

    def record(self, network, weights, again):
        folder = self.out / f"{self.name}_{network}"
        if again or not (folder / "summary.json").exists():
            self.run(network, [f"detection.models={weights}"])
        return folder

    def figures(self, folder):
        report = folder / "detections.json"
        call("evaluate", "detections", self.boxes, folder / "detections.jsonl", "--json", report)
        figures = json.loads(report.read_text())
        figures["per_class"]["all"] = {key: value for key, value in figures.items() if key != "per_class"}
        return figures

    def sparse(self, network, recorded, every, first):
        """The network on every k-th frame from one on; the boxes of the frames between are carried."""
        lines = (recorded / "detections.jsonl").read_text().splitlines()
        file = self.out / f"{self.name}_{network}_every_{every}.jsonl"
        file.write_text("".join(line + "\n" for line in lines[first::every]))
        return self.run(f"{network}_every_{every}",
                        ["detection.class=RecordedDetector", f"detection.file={file}",
                         f"detection.max_carried_frames={max(5, every - 1)}"])


def total(reports):
    """Counts of several reports together, per class, with recall and precision."""
    out = {}
    for name in sorted({name for report in reports for name in report["per_class"]}):
        found = [report["per_class"].get(name, {}) for report in reports]
        correct, wrong, missed = (sum(f.get(key, 0) for f in found) for key in ("correct", "false_alarms", "missed"))
        out[name] = {"correct": correct, "false_alarms": wrong, "missed": missed,
                     "recall": correct / max(1, correct + missed), "precision": correct / max(1, correct + wrong)}
    return {"per_class": out}


def measure(sequence, network, weights, every, again):
    recorded = sequence.record(network, weights, again)
    rows = []
    for step in [1, *every]:
        reports = [sequence.figures(recorded if step == 1 else sequence.sparse(network, recorded, step, first))
                   for first in range(step)]
        rows.append({"sequence": sequence.name, "network": network, "every": step, **total(reports)})
    return rows


def cell(row, first, name):
    """Recall / precision, with the change against every frame in points."""
    figures, reference = row["per_class"].get(name), first["per_class"].get(name)
    if not figures or figures["correct"] + figures["false_alarms"] == 0:
        return "–"
    text = f"{figures['recall']:.3f} / {figures['precision']:.3f}"
    if row is first or not reference:
        return text
    change = [100 * (figures[key] - reference[key]) for key in ("recall", "precision")]
    return f"{text} ({change[0]:+.1f} / {change[1]:+.1f})"


def page(rows):
    lines = ["# Detectors", "",
             "Made by `bench/detectors.py`. Recall / precision per class at IoU .5, score ≥ .35, over true boxes with more than half "
             "of the object visible and higher than 40 px; \"all\" also holds the classes that the network does not know. Networks "
             "on every frame, and on every k-th with the boxes tracked in between, judged over all frames and all k frames to "
             "begin with; in brackets the change in points. Rendered or simulated input.", "",
             "| sequence, network | runs on | " + " | ".join(CLASSES) + " | all |",
             "| --- | --- | " + " | ".join("---" for _ in CLASSES) + " | --- |"]
    for row in rows:
        first = next(r for r in rows if (r["sequence"], r["network"]) == (row["sequence"], row["network"]))
        step = "every frame" if row["every"] == 1 else f"every {row['every']}."
        lines.append(f"| `{row['sequence']}`, {row['network']} | {step} | " +
                     " | ".join(cell(row, first, name) for name in [*CLASSES, "all"]) + " |")
    return "\n".join(lines) + "\n"


def meshes(out):
    """The world furnished with catalogue models; simulated once."""
    folder = out / "detectors" / "lab_meshes"
    if not (folder / "boxes.jsonl").exists():
        if not (ROOT / "worlds" / "meshes").is_dir():
            sys.exit("worlds/meshes is missing: install sweethome3d-furniture and run worlds/extract_meshes.sh")
        call("simulate", ROOT / "worlds/lab_meshes.json", "-o", folder, "--seed", "1")
    return Sequence("lab_meshes", folder / "lab_meshes.rawlog", folder / "boxes.jsonl", out)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, default=os.environ.get("ROOMGRAPH_DATA", ROOT.parent / "shared" / "data"))
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "bench")
    parser.add_argument("--every", type=int, nargs="+", default=[3])
    parser.add_argument("--only", nargs="+", choices=NETWORKS, default=list(NETWORKS))
    parser.add_argument("--meshes", action="store_true")
    parser.add_argument("--again", action="store_true")
    arguments = parser.parse_args()
    out, data = arguments.out.resolve(), Path(arguments.data).resolve()
    (out / "detectors").mkdir(parents=True, exist_ok=True)
    lab = Sequence("lab_a", data / "lab/lab_a/lab_a.rawlog", data / "lab/lab_a/boxes.jsonl", out)
    jobs = [(lab, network) for network in arguments.only]
    if arguments.meshes:
        jobs.append((meshes(out), "nanodet-plus-m_1.5x-416"))
    rows = []
    for sequence, network in jobs:
        print(sequence.name, network, "...", flush=True)
        rows += measure(sequence, network, data / "models" / NETWORKS[network], arguments.every, arguments.again)
        (out / "detectors.json").write_text(json.dumps(rows, indent=1))
        (out / "detectors.md").write_text(page(rows))
    print(page(rows))


if __name__ == "__main__":
    main()
