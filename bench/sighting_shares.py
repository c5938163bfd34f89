#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What proposals err by, as shares of what they say, and how much of that repeats: `[backend] landmark_sigma_share` and
`landmark_repeating_share`, from recordings with truth.

    bench/sighting_shares.py out/flats/batch/inputs/flat_? [--detections out/flats/batch/runs/{name}--default/detections.jsonl]

Each INPUT is a folder of `roomgraph simulate` (only flats below 100: these are for choosing). `roomgraph bench proposals` lifts
its boxes, by the true poses. With z an error on the ground, along and across the view, in its own standard deviations:

    sigma_share^2 = median |z|^2 / (2 ln 2)        which is 1 for the errors of a Gaussian that are as large as said
    repeating     = 1 - median |z_i - z_j|^2 / (2 median |z|^2)    over two sightings of an object from one direction

"within a visit": half a second to ten seconds apart; "again": more than ten seconds apart, which is the landmark_repeating_share of
docs/method.md. Medians: some of the proposals are another depth or an object's other side, which robust losses are for.
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

LEAST_S, MOST_S = 0.5, 10  # apart, within a visit
VIEW_RAD = 0.26  # as [backend] landmark_view_rad
FEWEST = 20  # sightings, or pairs, that say something


def sightings_of(lines):
    """(Class, object) -> [(t, direction of view, z along it, z across it)] in order of time."""
    seen = collections.defaultdict(list)
    for line in lines:
        row = json.loads(line)
        proposal = row.get("proposal")
        if proposal:
            error = proposal["error_in_view_m"]
            z = [e / sigma for e, sigma in zip(error, proposal["sigma_in_view_m"])]
            east, north = proposal["center_error_m"]  # the same, not turned into the view
            seen[row["class"], row["object"]].append((row["timestamp"], math.atan2(north, east) - math.atan2(error[1], error[0]), *z))
    return {key: sorted(of) for key, of in seen.items()}


def differences(sightings, least_s, most_s):
    """Squared differences of one object's sightings and those from the same direction that follow after least_s to most_s."""
    times = [t for t, *_ in sightings]
    for t, direction, *z in sightings:
        for _, other_direction, *other in sightings[bisect.bisect_left(times, t + least_s):bisect.bisect_right(times, t + most_s)]:
            if abs(math.remainder(direction - other_direction, 2 * math.pi)) < VIEW_RAD:
                yield math.dist(z, other) ** 2


def shares(objects):
    """(Sightings, sigma share, (pairs, repeating share) within a visit, the same again); None where too few say it."""
    squares = [x * x + y * y for of in objects for *_, x, y in of]
    median = statistics.median(squares) if len(squares) >= FEWEST else None

    def repeating(least_s, most_s):
        pairs = [square for of in objects for square in differences(of, least_s, most_s)]
        return len(pairs), 1 - statistics.median(pairs) / (2 * median) if median and len(pairs) >= FEWEST else None

    sigma = math.sqrt(median / (2 * math.log(2))) if median else None
    return len(squares), sigma, repeating(LEAST_S, MOST_S), repeating(MOST_S, math.inf)


def lifted(program, folder, detections):
    """Lines of `bench proposals --each` of a simulated recording."""
    rawlog = next(folder.glob("*.rawlog"), None)
    if not rawlog:
        sys.exit(f"{folder}: no *.rawlog in it")
    number = folder.name.rpartition("_")[2]
    if number.isdigit() and int(number) >= 1000:
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
    def figure(value):
        return "-" if value is None else f"{value:.2f}"

    lines = ["| class | sightings | sigma share | pairs within a visit | repeating share | pairs again | repeating share |",
             "| --- | --- | --- | --- | --- | --- | --- |"]
    for name, objects in by_class.items():
        count, sigma, *repeating = shares(objects)
        cells = [str(count), figure(sigma)] + [cell for pairs, share in repeating for cell in (str(pairs), figure(share))]
        lines.append(f"| {name} | " + " | ".join(cells) + " |")
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
