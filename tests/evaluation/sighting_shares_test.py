#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""bench/sighting_shares.py: shares that errors were drawn with are found again, whatever one in twenty is."""
import json
import math
import pathlib
import random
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
import sighting_shares  # noqa: E402


def drawn(sigma_share, of_view, of_visit, outliers=0.0, objects=400):
    """Lines of sightings, ten of each visit and a second apart, two visits of each of two views of each object. The shares of the variance
    that a view has in common, and that a visit has besides; directions and scales differ, and must not matter."""
    generator = random.Random(3)

    def error(share):
        return [generator.gauss(0, sigma_share * math.sqrt(share)) for _ in range(2)]

    lines = []
    for number in range(objects):
        for view, direction in enumerate((0.3, 2.1)):
            shared = error(of_view)
            for visit in range(2):
                shared_now = error(of_visit)
                for i in range(10):
                    z = [sum(parts) for parts in zip(shared, shared_now, error(1 - of_view - of_visit))]
                    if generator.random() < outliers:
                        z = [30, -20]
                    seen = [0.4 * z[0], 0.1 * z[1]]
                    turn = direction + generator.uniform(-0.1, 0.1)
                    east, north = math.cos(turn) * seen[0] - math.sin(turn) * seen[1], math.sin(turn) * seen[0] + math.cos(turn) * seen[1]
                    lines.append(json.dumps({"timestamp": 1000 * view + 3600 * visit + i, "class": "door", "object": number, "proposal": {
                        "error_in_view_m": seen, "sigma_in_view_m": [0.4, 0.1], "center_error_m": [east, north]}}))
    return lines


def found(lines):
    return sighting_shares.shares(list(sighting_shares.sightings_of(lines).values()))


class SightingShares(unittest.TestCase):
    def test_are_those_that_errors_were_drawn_with(self):
        for sigma_share, of_view, of_visit in (1, 0, 0), (0.5, 0.5, 0), (1.5, 0.3, 0.4):
            count, sigma, (pairs, within), (pairs_again, again) = found(drawn(sigma_share, of_view, of_visit))
            self.assertAlmostEqual(sigma, sigma_share, delta=0.04 * sigma_share)
            self.assertAlmostEqual(within, of_view + of_visit, delta=0.05)
            self.assertAlmostEqual(again, of_view, delta=0.06)
            self.assertEqual((count, pairs, pairs_again), (16000, 400 * 4 * 45, 400 * 2 * 100), "another view is no pair")

    def test_another_depth_now_and_then_changes_little(self):
        _, sigma, (_, within), (_, again) = found(drawn(0.5, 0.5, 0.2, outliers=0.05))
        self.assertAlmostEqual(sigma, 0.5, delta=0.03)
        self.assertAlmostEqual(within, 0.7, delta=0.1)
        self.assertAlmostEqual(again, 0.5, delta=0.1)

    def test_few_sightings_say_nothing(self):
        few = drawn(1, 0, 0, objects=1)[:8]
        self.assertEqual(found(few), (8, None, (28, None), (0, None)))
        self.assertEqual(sighting_shares.sightings_of(['{"timestamp": 1, "class": "door", "object": 1, "proposal": null}']), {})
        self.assertIn("| door | 8 | - | 28 | - | 0 | - |", sighting_shares.table({"door": list(sighting_shares.sightings_of(few).values())}))

    def test_flats_for_reporting_are_refused(self):
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(temporary) / "flat_1003"
            folder.mkdir()
            with self.assertRaisesRegex(SystemExit, "no .*rawlog"):
                sighting_shares.lifted("false", folder, None)
            (folder / "flat_1003.rawlog").touch()
            with self.assertRaisesRegex(SystemExit, "for reporting"):
                sighting_shares.lifted("false", folder, None)


if __name__ == "__main__":
    unittest.main()
