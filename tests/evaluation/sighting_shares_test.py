#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""bench/sighting_shares.py: shares that errors were drawn with are found again, whatever a tenth of them is."""
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


def drawn(sigma_share, repeating, outliers=0.0, objects=300):
    """Lines of sightings, ten of each object and a second apart, and those objects seen again an hour later with another error."""
    generator = random.Random(3)
    lines = []
    for number in range(objects):
        for visit in 0, 3600:
            shared = [generator.gauss(0, sigma_share * math.sqrt(repeating)) for _ in range(2)]
            for i in range(10):
                z = [s + generator.gauss(0, sigma_share * math.sqrt(1 - repeating)) for s in shared]
                if generator.random() < outliers:
                    z = [30, -20]
                lines.append(json.dumps({"timestamp": visit + i, "class": "door", "object": number,
                                         "proposal": {"error_in_view_m": [0.4 * z[0], 0.1 * z[1]], "sigma_in_view_m": [0.4, 0.1]}}))
    return lines


def found(lines):
    return sighting_shares.shares(list(sighting_shares.sightings_of(lines).values()))


class SightingShares(unittest.TestCase):
    def test_are_those_that_errors_were_drawn_with(self):
        for sigma_share, repeating in (1, 0), (0.5, 0.5), (1.5, 0.9):
            sigma, repeats, count, pairs = found(drawn(sigma_share, repeating))
            self.assertAlmostEqual(sigma, sigma_share, delta=0.03 * sigma_share)
            self.assertAlmostEqual(repeats, repeating, delta=0.05)
            self.assertEqual((count, pairs), (6000, 300 * 2 * 45), "an hour later is no pair")

    def test_another_depth_now_and_then_changes_little(self):
        sigma, repeats, *_ = found(drawn(0.5, 0.5, outliers=0.05))
        self.assertAlmostEqual(sigma, 0.5, delta=0.03)
        self.assertAlmostEqual(repeats, 0.5, delta=0.1)

    def test_few_sightings_say_nothing(self):
        self.assertEqual(found(drawn(1, 0, objects=1)[:8]), (None, None, 8, 28))
        self.assertEqual(sighting_shares.sightings_of(['{"timestamp": 1, "class": "door", "object": 1, "proposal": null}']), {})
        self.assertIn("| door | 8 | 28 | - | - |", sighting_shares.table({"door": list(sighting_shares.sightings_of(drawn(1, 0, objects=1)[:8]).values())}))

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
