#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Fits the weights of [existence] to the landmarks of simulated flats, and says how well they do on flats left out.

    bench/existence.py [--seeds 1-20] [--set k=v ...] [--out DIR] [--program PATH]

Flats 1 to 99 only: those from 1000 on are for reporting. Every flat is simulated (as by bench/flats.py, whose sequences are
used again), run and evaluated; each landmark of candidates.json with enough sightings is one sample, true when the evaluation
calls it correct and false when it calls it a false alarm or a duplicate; look-alikes that are not counted are left out.

The model is a logistic regression for each kind of shape, whose weights differ from common ones by a ridge penalty, and whose
signs agree with the meaning of the evidence. Printed are the reliability on flats left out one at a time, and the weights of
all flats as they stand in libs/estimation/src/existence_weights.cpp. Needs python3-numpy.
"""
import argparse
import json
import sys
from pathlib import Path

import flats
import seeds

LEAST_SIGHTINGS = 3
RIDGE_COMMON, RIDGE_OWN, RIDGE_BIAS = 2.0, 4.0, 0.05
SIGNS = {"filter": 1, "sightings": 1, "directions": 1, "score": 1, "label": 1, "scatter": -1, "turned": -1, "size": -1,
         "contested": -1, "crossed": -1, "filled": 1, "spread": 1, "beside_crossed": -1, "beside_filled": 1, "beams_crossed": -1}
ROUNDS, STEP = 400, 0.7
BINS = (0, 0.1, 0.3, 0.5, 0.7, 0.9, 1)


def samples_of(number, run, report):
    """[(flat, kind of shape, evidence, is true)] of one run."""
    verdicts = {entry["id"]: entry["verdict"] for entry in report["landmarks"]}
    out = []
    for landmark in json.loads((run / "candidates.json").read_text())["landmarks"]:
        verdict = verdicts[landmark["id"]]
        if landmark["observations"] >= LEAST_SIGHTINGS and verdict != "uncounted":
            out.append((number, landmark["shape"], landmark["evidence"], verdict == "correct"))
    return out


class Model:
    """Weights of standardised evidence; row i of `weights` is that of kinds[i], the bias first."""

    def __init__(self, samples):
        import numpy as np
        self.np = np
        self.kinds = sorted({kind for _, kind, _, _ in samples})
        self.names = list(SIGNS)
        values = np.array([[evidence[name] for name in self.names] for _, _, evidence, _ in samples])
        self.mean, self.sigma = values.mean(axis=0), values.std(axis=0) + 1e-6
        self.signs = np.array([0] + [SIGNS[name] for name in self.names])
        self.weights = np.zeros((len(self.kinds), 1 + len(self.names)))
        self.fit(self.rows(samples), np.array([self.kinds.index(kind) for _, kind, _, _ in samples]),
                 np.array([is_true for _, _, _, is_true in samples], float))

    def rows(self, samples):
        values = self.np.array([[evidence[name] for name in self.names] for _, _, evidence, _ in samples])
        return self.np.hstack([self.np.ones((len(samples), 1)), (values - self.mean) / self.sigma])

    def fit(self, rows, kinds, truth):
        """Damped Newton steps for each kind, towards the common weights; weights of the wrong sign are held at 0."""
        common = self.np.zeros(rows.shape[1])
        for _ in range(ROUNDS):
            for k in range(len(self.kinds)):
                self.weights[k] = self.improved(self.weights[k], common, rows[kinds == k], truth[kinds == k])
            common = RIDGE_OWN * self.weights.sum(axis=0) / (RIDGE_COMMON + RIDGE_OWN * len(self.kinds))
            common[0] = 0

    def improved(self, weights, common, rows, truth):
        np = self.np
        ridge = np.array([RIDGE_BIAS] + [RIDGE_OWN] * len(self.names))
        probability = 1 / (1 + np.exp(-rows @ weights))
        gradient = rows.T @ (truth - probability) - ridge * (weights - common)
        free = ~((weights * self.signs <= 0) & (self.signs != 0) & (gradient * self.signs < 0))
        hessian = (rows * (probability * (1 - probability))[:, None]).T @ rows + np.diag(ridge)
        step = np.zeros(len(weights))
        step[free] = np.linalg.solve(hessian[np.ix_(free, free)], gradient[free])
        out = weights + STEP * step
        out[out * self.signs < 0] = 0
        return out

    def probabilities(self, samples):
        kinds = [self.kinds.index(kind) for _, kind, _, _ in samples]
        return 1 / (1 + self.np.exp(-(self.rows(samples) * self.weights[kinds]).sum(axis=1)))

    def text(self, kind):
        """Weights of the evidence as it is, for the config."""
        raw = self.weights[self.kinds.index(kind)].copy()
        raw[1:] /= self.sigma
        raw[0] -= raw[1:] @ self.mean
        entries = [f"bias {raw[0]:.3g}"] + [f"{name} {value:.3g}" for name, value in zip(self.names, raw[1:]) if abs(value) > 1e-3]
        return f"{kind} = " + ", ".join(entries)


def cross_validated(samples):
    """Probability of each sample by a model of the other flats."""
    out = [0.0] * len(samples)
    for flat in sorted({number for number, *_ in samples}):
        model = Model([sample for sample in samples if sample[0] != flat])
        left_out = [i for i, sample in enumerate(samples) if sample[0] == flat]
        for i, probability in zip(left_out, model.probabilities([samples[i] for i in left_out])):
            out[i] = float(probability)
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


def collect(program, number, out, settings):
    truth = flats.flat(program, argparse.Namespace(rooms=0, handheld=False), number, out / "sequences")
    run = out / "runs" / "existence" / f"flat_{number}"
    _, problems = seeds.measure(program, truth, run, False, settings, 0)
    report = run / "candidates_score.json"
    problem = program.call("evaluate", "objects", truth / "objects.json", run / "candidates.json", "--truth-trajectory",
                           truth / "groundtruth_robot.txt", "--trajectory", run / "trajectory.tum", "--json", report)
    if problem:
        sys.exit("\n".join([problem, *problems]))
    return samples_of(number, run, json.loads(report.read_text()))


def main(argv=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=flats.parse_seeds, default=flats.parse_seeds("1-20"), metavar="1-20", help="numbers of the flats")
    parser.add_argument("--set", nargs="+", action="extend", default=[], metavar="K=V")
    parser.add_argument("--out", type=Path, default=seeds.ROOT / "out" / "flats")
    parser.add_argument("--program", type=Path, default=seeds.PROGRAM)
    arguments = parser.parse_args(argv)
    if arguments.seeds[0] in flats.REPORTING:
        parser.error("flats from 1000 on are for reporting: nothing is fitted to them")
    program, samples = seeds.Program(arguments.program), []
    for number in arguments.seeds:
        samples += collect(program, number, arguments.out.resolve(), arguments.set)
        print(f"flat {number}: {len(samples)} landmarks so far", file=sys.stderr, flush=True)
    print(summary(samples))
    return 0


def summary(samples):
    probabilities = cross_validated(samples)
    model = Model(samples)
    true = sum(is_true for _, _, _, is_true in samples)
    return "\n".join([f"{len(samples)} landmarks of {len({s[0] for s in samples})} flats, {true} true; on flats left out:", "",
                      reliability(samples, probabilities), "",
                      *(decisions(samples, probabilities, limit) for limit in (0.3, 0.5, 0.7, 0.9)), "",
                      *(model.text(kind) for kind in model.kinds)])


if __name__ == "__main__":
    sys.exit(main())
