#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Fits the weights of [existence] to the landmarks of simulated flats, and says how well they do on flats left out.

    bench/existence.py [--seeds 1-20] [--near-shipped] [--set k=v ...] [--out DIR] [--program PATH]
                       [--network-seeds 1-5 --network-set k=v ... [--meshes DIR]]

--network-seeds adds runs that see by a network, furnished with catalogue models where --meshes names them (worlds/extract_meshes.sh).
The shipped weights are of both detectors on the same flats:

    bench/existence.py --seeds 1-12,21-38 --network-seeds 1-12,21-38 --network-set detection.class=DnnDetector \\
      detection.models=models/room_detector/room_detector.onnx

Flats 1 to 99 only: those from 1000 on are for reporting. Every flat is simulated (as by bench/flats.py, whose sequences are
used again), run and evaluated; each landmark of candidates.json with enough sightings is one sample, true when the evaluation
calls it correct and false when it calls it a false alarm or a duplicate; look-alikes that are not counted are left out.

The model is a logistic regression for each kind of shape, whose weights differ from common ones by a ridge penalty, and whose
signs agree with the meaning of the evidence. With --near-shipped the penalty is on what they differ from the program's own
weights: for a change of the evidence that a few flats shall tell of. Printed are the reliability on flats left out one at a time, and the weights of
all flats as they stand in libs/estimation/src/existence.cpp.
"""
import argparse
import json
import math
import re
import statistics
import subprocess
import sys
from pathlib import Path

import flats
import seeds

LEAST_SIGHTINGS = {"cylinder": 3, "cuboid": 3, "planar": 1}
RIDGE_COMMON, RIDGE_OWN, RIDGE_BIAS, RIDGE_SHIPPED = 4.0, 8.0, 0.05, 4.0
# Without "size": simulated objects are nearer to the usual sizes than real ones, and the shapes' scores contain it.
SIGNS = {"filter": 1, "sightings": 1, "directions": 1, "score": 1, "label": 1, "scatter": -1, "turned": -1, "measured": 1,
         "detected": 1, "contested": -1, "outdone": -1, "mislabelled": -1, "crossed": -1, "filled": 1, "spread": 1, "beside_crossed": -1, "beside_filled": 1, "beams_crossed": -1, "above_filled": -1, "uneven": -1, "confidence": 1,
         "missed_since": -1, "emptied": -1, "shorter": -1}
ROUNDS, STEP = 60, 0.8
BINS = (0, 0.1, 0.3, 0.5, 0.7, 0.9, 1)


def samples_of(number, run, report):
    """[(flat, kind of shape, evidence, is true)] of one run; the number of a flat with meshes is negative."""
    verdicts = {entry["id"]: entry["verdict"] for entry in report["landmarks"]}
    out = []
    for landmark in json.loads((run / "candidates.json").read_text())["landmarks"]:
        verdict = verdicts[landmark["id"]]
        if landmark["observations"] >= LEAST_SIGHTINGS[landmark["shape"]] and verdict != "uncounted":
            out.append((number, landmark["shape"], landmark["evidence"], verdict == "correct"))
    return out


def shipped_weights(program):
    """{kind of shape: {name: weight}} of the program's own configuration."""
    reference = subprocess.run([program, "config-reference"], check=True, capture_output=True, text=True).stdout
    rows = re.findall(r"^\| `(\w+)_weights` \| `(bias [^`]*)`", reference, re.MULTILINE)
    return {kind: {name: float(value) for name, value in map(str.split, entries.split(","))} for kind, entries in rows}


def solved(matrix, right):
    """Solution of a linear system by Gaussian elimination; the matrix is positive definite."""
    rows = [[*row, value] for row, value in zip(matrix, right)]
    for i, pivot in enumerate(rows):
        for row in rows[i + 1:]:
            factor = row[i] / pivot[i]
            for j in range(i, len(row)):
                row[j] -= factor * pivot[j]
    out = [0.0] * len(rows)
    for i in reversed(range(len(rows))):
        out[i] = (rows[i][-1] - sum(rows[i][j] * out[j] for j in range(i + 1, len(rows)))) / rows[i][i]
    return out


def logistic(log_odds):
    return 1 / (1 + math.exp(-max(-500.0, min(500.0, log_odds))))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


class Model:
    """Weights of standardised evidence by kind of shape, the bias first; `near`: weights of the evidence as it is, from which they
    differ as little as the samples allow."""

    def __init__(self, samples, near=None):
        self.names, self.signs = list(SIGNS), [0, *SIGNS.values()]
        columns = [[evidence[name] for _, _, evidence, _ in samples] for name in self.names]
        self.mean = [statistics.fmean(column) for column in columns]
        self.sigma = [statistics.pstdev(column) + 1e-6 for column in columns]
        self.weights = {kind: [0.0] * len(self.signs) for _, kind, _, _ in samples}
        self.near = near and {kind: self.standardised(near[kind]) for kind in self.weights}
        self.fit({kind: ([self.row(e) for _, k, e, _ in samples if k == kind], [v for _, k, _, v in samples if k == kind])
                  for kind in self.weights})

    def standardised(self, raw):
        weights = [raw.get(name, 0.0) for name in self.names]
        return [raw["bias"] + dot(weights, self.mean), *(w * s for w, s in zip(weights, self.sigma))]

    def row(self, evidence):
        return [1.0, *((evidence[name] - m) / s for name, m, s in zip(self.names, self.mean, self.sigma))]

    def fit(self, samples_of_kind):
        """Damped Newton steps for each kind, towards the common weights; weights of the wrong sign are held at 0."""
        common, ridge = [0.0] * len(self.signs), RIDGE_SHIPPED if self.near else RIDGE_OWN
        for _ in range(ROUNDS):
            for kind, (rows, truth) in samples_of_kind.items():
                aim = self.near[kind] if self.near else common
                self.weights[kind] = self.improved(self.weights[kind], aim, ridge, rows, truth)
            shrunk = RIDGE_OWN / (RIDGE_COMMON + RIDGE_OWN * len(self.weights))
            common = [0.0, *(shrunk * sum(of) for of in list(zip(*self.weights.values()))[1:])]

    def improved(self, weights, aim, penalty, rows, truth):
        ridge = [RIDGE_BIAS] + [penalty] * len(self.names)
        probability = [logistic(dot(row, weights)) for row in rows]
        gradient = [dot([row[i] for row in rows], [v - p for v, p in zip(truth, probability)]) - ridge[i] * (weights[i] - aim[i])
                    for i in range(len(weights))]
        free = [i for i, s in enumerate(self.signs) if not (s and weights[i] * s <= 0 and gradient[i] * s < 0)]
        spread = [p * (1 - p) for p in probability]
        hessian = [[sum(w * row[i] * row[j] for w, row in zip(spread, rows)) + (ridge[i] if i == j else 0) for j in free] for i in free]
        out = list(weights)
        for i, step in zip(free, solved(hessian, [gradient[i] for i in free])):
            out[i] += STEP * step
        return [0.0 if w * s < 0 else w for w, s in zip(out, self.signs)]

    def probabilities(self, samples):
        return [logistic(dot(self.row(evidence), self.weights[kind])) for _, kind, evidence, _ in samples]

    def text(self, kind):
        """Weights of the evidence as it is, for the config; only doors are asked for the wall beside them."""
        raw = [w / s for w, s in zip(self.weights[kind][1:], self.sigma)]
        entries = [f"bias {self.weights[kind][0] - dot(raw, self.mean):.3g}"]
        asked = [(name, value) for name, value in zip(self.names, raw) if kind == "planar" or not name.startswith("beside")]
        return f"{kind} = " + ", ".join(entries + [f"{name} {value:.3g}" for name, value in asked if abs(value) > 1e-3])


def cross_validated(samples, near=None):
    """Probability of each sample by a model of the other flats."""
    out = [0.0] * len(samples)
    for flat in sorted({number for number, *_ in samples}):
        model = Model([sample for sample in samples if sample[0] != flat], near)
        left_out = [i for i, sample in enumerate(samples) if sample[0] == flat]
        for i, probability in zip(left_out, model.probabilities([samples[i] for i in left_out])):
            out[i] = probability
    return out


def reliability(samples, probabilities):
    lines = ["| probability | landmarks | mean probability | share that is true |", "| --- | --- | --- | --- |"]
    for low, high in zip(BINS, BINS[1:]):
        inside = [(p, is_true) for p, (_, _, _, is_true) in zip(probabilities, samples) if low <= p < high or p == high == 1]
        if inside:
            lines.append(f"| {low} to {high} | {len(inside)} | {sum(p for p, _ in inside) / len(inside):.2f} | "
                         f"{sum(is_true for _, is_true in inside) / len(inside):.2f} |")
    return "\n".join(lines)


def decisions(samples, probabilities, limit):
    false = sum(p >= limit and not is_true for p, (_, _, _, is_true) in zip(probabilities, samples))
    lost = sum(p < limit and is_true for p, (_, _, _, is_true) in zip(probabilities, samples))
    return f"from {limit} on: {false} false landmarks kept, {lost} true ones lost"


def collect(program, number, out, settings, of="flat", meshes=None):
    """Samples of one flat; its run is kept as `of`_`number`. Left out together is what has the same flat."""
    furnished = ["--meshes", meshes.resolve()] if meshes else []
    truth = seeds.simulated(program, "flat", repr(furnished).encode(), number, out / "sequences", ["--flat", number, *furnished])
    run = out / "runs" / "existence" / f"{of}_{number}"
    _, problems = seeds.measure(program, truth, run, False, settings, 0)
    report = run / "candidates_score.json"
    problem = program.call("evaluate", "objects", truth / "objects.json", run / "candidates.json", "--truth-trajectory",
                           truth / "groundtruth_robot.txt", "--trajectory", run / "trajectory.tum", "--json", report)
    if problem:
        sys.exit("\n".join([problem, *problems]))
    return samples_of(-number if meshes else number, run, json.loads(report.read_text()))


def main(argv=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=flats.parse_seeds, default=flats.parse_seeds("1-20"), metavar="1-20", help="numbers of the flats")
    parser.add_argument("--near-shipped", action="store_true", help="weights near the program's own")
    parser.add_argument("--set", nargs="+", action="extend", default=[], metavar="K=V")
    parser.add_argument("--network-seeds", type=flats.parse_seeds, default=[], metavar="1-5", help="flats seen by the network of --network-set, too")
    parser.add_argument("--network-set", nargs="+", action="extend", default=[], metavar="K=V")
    parser.add_argument("--meshes", type=Path, metavar="DIR", help="furniture of the flats of --network-seeds")
    parser.add_argument("--out", type=Path, default=seeds.ROOT / "out" / "flats")
    parser.add_argument("--program", type=Path, default=seeds.PROGRAM)
    arguments = parser.parse_args(argv)
    if bool(arguments.network_seeds) != bool(arguments.network_set):
        parser.error("--network-seeds and --network-set need each other")
    if arguments.meshes and not arguments.network_seeds:
        parser.error("--meshes needs --network-seeds")
    if any(seeds_of and seeds_of[0] in flats.REPORTING for seeds_of in (arguments.seeds, arguments.network_seeds)):
        parser.error("flats from 1000 on are for reporting: nothing is fitted to them")
    program, samples = seeds.Program(arguments.program), []
    for number in arguments.seeds:
        samples += collect(program, number, arguments.out.resolve(), arguments.set)
        print(f"flat {number}: {len(samples)} landmarks so far", file=sys.stderr, flush=True)
    for number in arguments.network_seeds:
        of = "network_meshes" if arguments.meshes else "network"
        samples += collect(program, number, arguments.out.resolve(), arguments.network_set, of, arguments.meshes)
        print(f"flat {number}, {of}: {len(samples)} landmarks so far", file=sys.stderr, flush=True)
    print(summary(samples, shipped_weights(arguments.program) if arguments.near_shipped else None))
    return 0


def summary(samples, near=None):
    probabilities = cross_validated(samples, near)
    model = Model(samples, near)
    true = sum(is_true for _, _, _, is_true in samples)
    return "\n".join([f"{len(samples)} landmarks of {len({s[0] for s in samples})} flats, {true} true; on flats left out:", "",
                      reliability(samples, probabilities), "",
                      *(decisions(samples, probabilities, limit) for limit in (0.3, 0.5, 0.7, 0.9)), "",
                      *(model.text(kind) for kind in sorted(model.weights))])


if __name__ == "__main__":
    sys.exit(main())
