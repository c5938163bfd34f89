#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Simulates random flats, runs and evaluates each (`roomgraph batch`), and compares variants of the settings flat by flat.

    bench/flats.py [--seeds 1-20] [--variants name=k=v,k=v ...] [--set k=v ...] [--rooms N] [--handheld] [--out DIR]

Flats 1 to 99 are for choosing settings, 1000 to 1019 for reporting only: no setting may be chosen on them. One call takes
one kind, and its table says which. The variant `default` (nothing but --set) comes first; all others are compared with it, flat
by flat: the mean difference, or for errors in metres and seconds the geometric mean of the ratios, with its 95 % interval over
flats (percentile bootstrap, Efron 1979). An interval without 0, or without 1 for ratios, is marked with *.
What landmarks do for the trajectory, with nothing else different (no loops; people are kept out in both):

    bench/flats.py --set tracking.loop_closing=false lidar.loop_closing=false object_loop_closing.enabled=false \\
      --variants no_landmarks=landmarks.enabled=false

DIR/batch holds recordings, runs and the catalogue: what is complete and unchanged is used again by every later call. DIR/figures.json
has each flat's figures.
"""
import argparse
import json
import math
import random
import sqlite3
import sys
from pathlib import Path

import seeds

CHOOSING, REPORTING = range(1, 100), range(1000, 1020)
RESAMPLES = 4000

# Report, its key, what the table calls it, format, better: -1 small or 1 large, compared by: ratio or difference.
FIGURES = [
    ("trajectory", "ate_rmse_m", "ATE, m", ".3f", -1, "ratio"),
    ("live", "ate_rmse_m", "ATE live, m", ".3f", -1, "ratio"),
    ("objects", "precision", "objects: precision", ".3f", 1, "difference"),
    ("objects", "recall", "objects: recall", ".3f", 1, "difference"),
    ("objects", "f1", "objects: F1", ".3f", 1, "difference"),
    ("objects", "duplicates", "objects: duplicates", ".0f", -1, "difference"),
    ("objects", "position_error_mean_m", "objects: centre error, m", ".3f", -1, "ratio"),
    ("objects", "yaw_error_mean_deg", "objects: yaw error, deg", ".1f", -1, "difference"),
    ("objects", "iou3d_mean", "objects: 3D IoU", ".3f", 1, "difference"),
    ("objects", "position_nees_mean", "objects: normalised squared error of places (2 expected)", ".1f", -1, "difference"),
    ("objects", "association_accuracy", "association: accuracy", ".4f", 1, "difference"),
    ("objects", "association_ece", "association: calibration error", ".4f", -1, "difference"),
    ("objects_live", "association_accuracy", "association live: accuracy", ".4f", 1, "difference"),
    ("objects", "identity_switches", "association: identity switches", ".0f", -1, "difference"),
    ("detections", "precision", "detections: precision", ".3f", 1, "difference"),
    ("detections", "recall", "detections: recall", ".3f", 1, "difference"),
    ("map", "f1", "map: F1 of occupied", ".3f", 1, "difference"),
    ("run", "seconds", "time of the run, s", ".0f", -1, "ratio"),
]


def parse_seeds(text):
    """'1-3,7' -> [1, 2, 3, 7]; all for choosing or all for reporting."""
    out = []
    for part in text.split(","):
        first, _, last = part.partition("-")
        if not first.isdigit() or (last and not last.isdigit()):
            raise argparse.ArgumentTypeError(f"'{text}' is not a list such as 1-20 or 1,4,7")
        out += range(int(first), int(last or first) + 1)
    if not out or not (set(out) <= set(CHOOSING) or set(out) <= set(REPORTING)):
        raise argparse.ArgumentTypeError(f"'{text}': either within 1-99 (choosing) or within 1000-1019 (reporting)")
    return sorted(set(out))


def bootstrap(values):
    """Mean and the 2.5 % and 97.5 % quantiles of the mean over resampled values; the same values give the same interval."""
    generator = random.Random(0)
    means = [sum(generator.choices(values, k=len(values))) / len(values) for _ in range(RESAMPLES)]
    return sum(values) / len(values), seeds.quantile(means, 0.025), seeds.quantile(means, 0.975)


def comparison(ours, default, how, pattern):
    """'mean [low .. high]' over the flats that both have (their number where it is not all of them)."""
    pairs = [(a, b) for a, b in zip(ours, default) if a is not None and b is not None and (how != "ratio" or min(a, b) > 0)]
    if len(pairs) < 2:
        return "-"
    few = f"{len(pairs)}: " if len(pairs) < len(ours) else ""
    if how == "ratio":
        mean, low, high = (math.exp(value) for value in bootstrap([math.log(a / b) for a, b in pairs]))
        sure = low > 1 or high < 1
        pattern = ".3f"
        cell = f"x {mean:{pattern}} [{low:{pattern}} .. {high:{pattern}}]"
    else:
        mean, low, high = bootstrap([a - b for a, b in pairs])
        sure = low > 0 or high < 0
        pattern = {".0f": ".1f"}.get(pattern, pattern)
        cell = f"{mean:+{pattern}} [{low:+{pattern}} .. {high:+{pattern}}]"
    return few + cell + (" *" if sure else "")


def middle_and_worst(values, pattern, better):
    known = [value for value in values if value is not None]
    if not known:
        return "-"
    few = f"{len(known)}: " if len(known) < len(values) else ""
    worst = max(known) if better < 0 else min(known)
    return f"{few}{seeds.quantile(known, 0.5):{pattern}} ({worst:{pattern}})"


def table(numbers, results, revisions=()):
    """Markdown; results: variant -> list of the flats' figures in the order of `numbers` (empty: the run failed)."""
    reporting = numbers[0] in REPORTING
    purpose = "for reporting: no setting was chosen on them" if reporting else "for choosing: not a measure of how good the settings are"
    others = [name for name in results if name != "default"]
    columns = [f"{name}: median (worst)" for name in results] + [f"{name} against default" for name in others]
    lines = [f"### {len(numbers)} random flats, {numbers[0]} to {numbers[-1]}, {purpose}", "",
             "Against default: mean difference, or x mean ratio, flat by flat [95 % bootstrap interval]; * where that excludes no change. "
             f"Program {', '.join(revisions) or '-'}.",
             "", "| figure | " + " | ".join(columns) + " |", "| --- |" + " --- |" * len(columns)]
    failed = [str(sum(not figures for figures in flats)) for flats in results.values()]
    lines.append("| runs that failed | " + " | ".join(failed + ["" for _ in others]) + " |")
    for report, key, label, pattern, better, how in FIGURES:
        values = {name: [figures.get(f"{report}.{key}") for figures in flats] for name, flats in results.items()}
        cells = [middle_and_worst(of, pattern, better) for of in values.values()]
        if all(cell == "-" for cell in cells):
            continue
        cells += [comparison(values[name], values["default"], how, pattern) for name in others]
        lines.append(f"| {label} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def arguments_of(argv):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=parse_seeds, default=parse_seeds("1-20"), metavar="1-20", help="numbers of the flats")
    parser.add_argument("--set", nargs="+", action="extend", default=[], metavar="K=V", help="for every variant")
    parser.add_argument("--variants", nargs="+", action="extend", default=[], type=seeds.parse_variant, metavar="NAME=K=V,K=V")
    parser.add_argument("--rooms", type=int, default=0, help="of every flat; 0: drawn (default)")
    parser.add_argument("--handheld", action="store_true", help="a camera carried by hand, no robot")
    parser.add_argument("--meshes", type=Path, metavar="DIR", help="furnished with the catalogue models in this folder")
    parser.add_argument("--threads", type=int, default=1, help="of each run")
    parser.add_argument("--jobs", type=int, default=0, help="runs at once; 0: cores / threads")
    parser.add_argument("--out", type=Path, default=seeds.ROOT / "out" / "flats")
    parser.add_argument("--program", type=Path, default=seeds.PROGRAM)
    return parser.parse_args(argv)


def group(arguments):
    """What the flats of these options are called in the catalogue."""
    return "_".join(["flats", *(["handheld"] if arguments.handheld else []), *([f"{arguments.rooms}rooms"] if arguments.rooms else []),
                     *([arguments.meshes.resolve().name] if arguments.meshes else [])])


def job_file(arguments, variants):
    """What `roomgraph batch` is to do, as JSON, which is YAML."""
    flats = {"flats": ",".join(str(number) for number in arguments.seeds)}
    flats |= {"rooms": arguments.rooms} if arguments.rooms else {}
    flats |= {"handheld": True} if arguments.handheld else {}
    flats |= {"meshes": str(arguments.meshes.resolve())} if arguments.meshes else {}
    return {"inputs": [{"simulate": flats, "group": group(arguments)}],
            "variants": [{"name": name, "set": arguments.set + settings} for name, settings in variants.items()],
            "limits": {"jobs": arguments.jobs, "threads": arguments.threads}}


def main(argv=None):
    arguments = arguments_of(argv)
    out = arguments.out.resolve()
    variants = {"default": [], **dict(arguments.variants)}
    ended = seeds.batch(arguments.program, out, job_file(arguments, variants))
    if ended not in (0, 1):
        return ended
    catalogue = sqlite3.connect(out / "batch" / "catalogue.sqlite")
    results, revisions, problems = seeds.catalogued(catalogue, group(arguments), arguments.seeds, variants, FIGURES)
    catalogue.close()
    print(*problems, sep="\n", file=sys.stderr)
    (out / "figures.json").write_text(json.dumps({"flats": arguments.seeds, **results}, indent=1) + "\n")
    text = table(arguments.seeds, results, revisions)
    (out / "table.md").write_text(text)
    print(text)
    return 0 if all(figures for flats in results.values() for figures in flats) else 1


if __name__ == "__main__":
    sys.exit(main())
