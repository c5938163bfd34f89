#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What proposals err by, as shares of what they say, and how much of that repeats: `[backend] landmark_sigma_share` and
`landmark_repeating_share`, from recordings with truth.

    bench/sighting_shares.py out/flats/batch/inputs/flat_* [--detections runs/{name}--default/detections.jsonl] [--program PROGRAM]

Each INPUT is a folder of `roomgraph simulate` (only flats below 100: these are for choosing). `roomgraph bench proposals` lifts
its boxes, by the true poses. With z an error on the ground, along and across the view, in its own standard deviations:

    sigma_share^2 = median |z|^2 / (2 ln 2)        which is 1 for the errors of a Gaussian that are as large as said
    repeating     = 1 - median |z_i - z_j|^2 / (2 median |z|^2)    over two sightings of an object, half a second to ten apart

Medians: a tenth of the proposals is another depth or an object's other side, which robust losses are for.
"""
import argparse
import bisect
import collections
import json
import math
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

LEAST_S, MOST_S = 0.5, 10
FEWEST = 20  # sightings, or pairs, that say something


def sightings_of(lines):
    """Object -> [(t, z along the view, z across it)] in order of time, with its class."""
    seen = collections.defaultdict(list)
    for line in lines:
        row = json.loads(line)
        proposal = row.get("proposal")
        if proposal:
            z = [error / sigma for error, sigma in zip(proposal["error_in_view_m"], proposal["sigma_in_view_m"])]
            seen[row["class"], row["object"]].append((row["timestamp"], *z))
    return {key: sorted(of) for key, of in seen.items()}


def differences(sightings):
    """Squared differences of one object's sightings and those that follow in LEAST_S to MOST_S."""
    times = [t for t, *_ in sightings]
    for i, (t, *z) in enumerate(sightings):
        for _, *other in sightings[bisect.bisect_left(times, t + LEAST_S):bisect.bisect_right(times, t + MOST_S)]:
            yield math.dist(z, other) ** 2


def shares(objects):
    """(sigma share, repeating share, sightings, pairs) of sightings of objects; None where too few say it."""
    squares = [x * x + y * y for of in objects for _, x, y in of]
    pairs = [square for of in objects for square in differences(of)]
    if len(squares) < FEWEST or len(pairs) < FEWEST:
        return None, None, len(squares), len(pairs)
    median = statistics.median(squares)
    return math.sqrt(median / (2 * math.log(2))), 1 - statistics.median(pairs) / (2 * median), len(squares), len(pairs)


def lifted(program, folder, detections):
    """Lines of `bench proposals --each` of a simulated recording."""
    rawlog = next(folder.glob("*.rawlog"), None)
    if not rawlog:
        sys.exit(f"{folder}: no *.rawlog in it")
    number = folder.name.rpartition("_")[2]
    if number.isdigit() and int(number) > 99:
        sys.exit(f"{folder}: flats from 1000 on are for reporting, not for choosing")
    with tempfile.TemporaryDirectory() as temporary:
        each = Path(temporary) / "each.jsonl"
        words = [program, "bench", "proposals", rawlog, "--boxes", folder / "boxes.jsonl", "--objects", folder / "objects.json",
                 "--trajectory", folder / "groundtruth_robot.txt", "--min-visible", "0.3", "--each", each]
        if detections:
            words += ["--detections", detections.format(name=folder.name)]
        subprocess.run(list(map(str, words)), check=True, stdout=subprocess.DEVNULL)
        return each.read_text().splitlines()


def table(by_class):
    lines = ["| class | sightings | pairs | sigma share | repeating share |", "| --- | --- | --- | --- | --- |"]
    for name, objects in by_class.items():
        sigma, repeating, count, pairs = shares(objects)
        cells = ["-", "-"] if sigma is None else [f"{sigma:.2f}", f"{repeating:.2f}"]
        lines.append(f"| {name} | {count} | {pairs} | {cells[0]} | {cells[1]} |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("inputs", nargs="+", type=Path, metavar="INPUT", help="folders of simulated recordings")
    parser.add_argument("--detections", metavar="FILE", help="a detector's boxes in place of true ones; {name}: that of the folder")
    parser.add_argument("--program", default="build/release/bin/roomgraph")
    arguments = parser.parse_args()
    by_class = collections.defaultdict(list)
    for folder in arguments.inputs:
        for (name, _), of in sightings_of(lifted(arguments.program, folder, arguments.detections)).items():
            by_class[name].append(of)
            by_class["all"].append(of)
        print(folder.name, file=sys.stderr)
    print(table(dict(sorted(by_class.items()))))


if __name__ == "__main__":
    main()
