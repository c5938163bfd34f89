#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""bench/existence.py: samples of a run, and the fit against probabilities that the samples were drawn with."""
import contextlib
import io
import json
import math
import pathlib
import random
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
import existence  # noqa: E402

TRUTH = {"cylinder": {"bias": -1, "score": 4, "crossed": -3}, "planar": {"bias": 1, "score": 4, "beside_crossed": -6}}


def drawn(count, seed, wrong_sign=0.0):
    """[(sample, probability it was drawn with)]; `wrong_sign`: weight by which crossed volumes speak for an object."""
    generator, out = random.Random(seed), []
    for i in range(count):
        kind = generator.choice(sorted(TRUTH))
        evidence = {name: generator.random() for name in existence.SIGNS}
        if kind != "planar":  # only doors are asked for the wall beside them
            evidence.update(beside_crossed=0.0, beside_filled=0.0)
        weights = {**TRUTH[kind], **({"crossed": wrong_sign} if wrong_sign else {})}
        log_odds = weights["bias"] - 2 + sum(weights.get(name, 0) * value for name, value in evidence.items())
        probability = 1 / (1 + math.exp(-log_odds))
        out.append(((i % 7, kind, evidence, generator.random() < probability), probability))
    return out


class Fit(unittest.TestCase):
    def test_probabilities_are_those_the_samples_were_drawn_with(self):
        model = existence.Model([sample for sample, _ in drawn(1500, 1)])
        others = drawn(300, 2)
        found = model.probabilities([sample for sample, _ in others])
        errors = [abs(p - truth) for p, (_, truth) in zip(found, others)]
        self.assertLess(sum(errors) / len(errors), 0.05)

    def test_the_text_gives_the_same_probabilities(self):
        samples = [sample for sample, _ in drawn(300, 3)]
        model = existence.Model(samples)
        for (_, kind, evidence, _), expected in zip(samples[:20], model.probabilities(samples[:20])):
            name, entries = model.text(kind).split(" = ")
            self.assertEqual(name, kind)
            weights = {key: float(value) for key, value in (entry.split() for entry in entries.split(", "))}
            log_odds = weights.pop("bias") + sum(value * evidence[key] for key, value in weights.items())
            self.assertAlmostEqual(1 / (1 + math.exp(-log_odds)), expected, delta=0.02)

    def test_no_weight_has_the_wrong_sign(self):
        model = existence.Model([sample for sample, _ in drawn(400, 4, wrong_sign=3)])
        for weights in model.weights.values():
            for name, weight in zip(model.names, weights[1:]):
                self.assertGreaterEqual(weight * existence.SIGNS[name], 0, name)
            self.assertEqual(weights[1 + model.names.index("crossed")], 0)

    def test_few_samples_leave_the_weights_they_start_near_to(self):
        near = {"cylinder": {"bias": -3, "score": 5, "crossed": -2}, "planar": {"bias": 0, "score": 4, "beside_crossed": -5}}
        for count, most in ((4, 0.6), (1500, 10)):
            model = existence.Model([sample for sample, _ in drawn(count, 6)], near)
            for kind, raw in near.items():
                if kind not in model.weights:
                    continue
                weights = {key: float(value) for key, value in (entry.split() for entry in model.text(kind).split(" = ")[1].split(", "))}
                self.assertLess(abs(weights["score"] - raw["score"]), most, kind)
        errors = [abs(p - truth) for p, (_, truth) in zip(model.probabilities([s for s, _ in drawn(300, 2)]), drawn(300, 2))]
        self.assertLess(sum(errors) / len(errors), 0.05)

    def test_names_and_signs_are_those_of_the_program(self):
        header = (ROOT / "libs/estimation/include/roomgraph/estimation/existence.h").read_text()
        names = header.split("kNames = {")[1].split("}")[0]
        of_program = [name.strip().strip('"') for name in names.split(",") if name.strip()]
        self.assertEqual([name for name in of_program if name != "size"], list(existence.SIGNS))
        self.assertIn("size", of_program)

    def test_the_reliability_counts_every_sample_once(self):
        pairs = drawn(100, 5)
        text = existence.reliability([sample for sample, _ in pairs], [0.05] * 40 + [0.95] * 59 + [1.0])
        self.assertIn("| 0 to 0.1 | 40 | 0.05 |", text)
        self.assertIn("| 0.9 to 1 | 60 | 0.95 |", text)


class Samples(unittest.TestCase):
    def test_true_false_and_not_counted(self):
        verdicts = ["correct", "false alarm", "duplicate", "uncounted", "correct"]
        landmarks = [{"id": i, "shape": "cuboid", "observations": 3 if i < 4 else 2, "evidence": {"score": i}} for i in range(5)]
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "candidates.json").write_text(json.dumps({"landmarks": landmarks}))
            report = {"landmarks": [{"id": i, "verdict": verdict} for i, verdict in enumerate(verdicts)]}
            samples = existence.samples_of(12, pathlib.Path(folder), report)
        self.assertEqual(samples, [(12, "cuboid", {"score": 0}, True), (12, "cuboid", {"score": 1}, False),
                                   (12, "cuboid", {"score": 2}, False)])

    def test_reporting_flats_are_refused(self):
        with contextlib.redirect_stderr(io.StringIO()) as err, self.assertRaises(SystemExit):
            existence.main(["--seeds", "1000-1003"])
        self.assertIn("nothing is fitted to them", err.getvalue())


if __name__ == "__main__":
    unittest.main()
