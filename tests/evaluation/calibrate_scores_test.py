# SPDX-License-Identifier: BSD-3-Clause
"""bench/calibrate_scores.py: which boxes are right, and a line through logits that is known."""
import math
import random
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "bench"))
import calibrate_scores


def box(u, score=None):
    return {"bbox": [u, 0, u + 10, 10]} | ({} if score is None else {"score": score})


def logistic(x):
    return 1 / (1 + math.exp(-x))


class Judged(unittest.TestCase):
    def test_the_better_box_finds_the_true_one(self):
        # Boxes moved by 2 and 3 px overlap a true one by 8 / 12 and 7 / 13.
        found = [box(3, 0.4), box(2, 0.9), box(40, 0.5)]
        self.assertEqual(calibrate_scores.judged(found, [box(0), box(80)]), [(0.9, True), (0.5, False), (0.4, False)])

    def test_less_than_half_is_not_the_same(self):
        self.assertAlmostEqual(calibrate_scores.iou([0, 0, 10, 10], [4, 0, 14, 10]), 6 / 14)
        self.assertEqual(calibrate_scores.judged([box(4, 0.9)], [box(0)]), [(0.9, False)])


class Fitted(unittest.TestCase):
    def test_finds_the_line_that_the_boxes_were_drawn_with(self):
        generator = random.Random(3)
        scores = [generator.uniform(0.02, 0.98) for _ in range(50000)]
        right = [generator.random() < logistic(1.8 * math.log(s / (1 - s)) - 0.7) for s in scores]
        slope, shift = calibrate_scores.fitted(scores, right)
        self.assertAlmostEqual(slope, 1.8, delta=0.06)
        self.assertAlmostEqual(shift, -0.7, delta=0.06)

    def test_boxes_that_are_all_right_end_somewhere(self):
        slope, shift = calibrate_scores.fitted([0.999] * 20 + [0.9999] * 15, [True] * 35)
        for score in (0.999, 0.9999):  # Platt's prior: one right box more, and one wrong one
            self.assertAlmostEqual(logistic(slope * math.log(score / (1 - score)) + shift), 36 / 37, delta=0.02)

    def test_scores_that_say_nothing_become_the_share_of_right_boxes(self):
        right = [i % 4 == 0 for i in range(1000)]
        slope, shift = calibrate_scores.fitted([0.3, 0.3, 0.7, 0.7, 0.7, 0.7, 0.3, 0.3] * 125, right)
        for score in (0.3, 0.7):
            self.assertAlmostEqual(logistic(slope * math.log(score / (1 - score)) + shift), 0.25, delta=0.01)


if __name__ == "__main__":
    unittest.main()
