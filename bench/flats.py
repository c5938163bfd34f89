#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Simulates random flats, runs and evaluates each, and compares variants of the settings flat by flat.

    bench/flats.py [--seeds 1-20] [--variants name=k=v,k=v ...] [--set k=v ...] [--rooms N] [--handheld] [--out DIR]

Flats 1 to 99 are for choosing settings, 1000 to 1019 for reporting only: no setting may be chosen on them. One call takes
one kind, and its table says which. The variant `default` (nothing but --set) comes first; all others are compared with it, flat
by flat: the mean difference, or for errors in metres and seconds the geometric mean of the ratios, with its 95 % interval over
flats (percentile bootstrap, Efron 1979). An interval without 0, or without 1 for ratios, is marked with *.
What landmarks do for the trajectory, with nothing else different (no loops; people are kept out in both):

    bench/flats.py --set tracking.loop_closing=false lidar.loop_closing=false object_loop_closing.enabled=false \\
      --variants no_landmarks=landmarks.enabled=false

Simulated flats are kept in DIR/sequences and used again until the simulator changes. DIR/figures.json keeps each flat's figures.
"""
import argparse
import json
import math
import random
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
    ("objects", "association_accuracy", "association: accuracy", ".4f", 1, "difference"),
    ("objects_live", "association_accuracy", "association live: accuracy", ".4f", 1, "difference"),
    ("objects", "identity_switches", "association: identity switches", ".0f", -1, "difference"),
    ("detections", "precision", "detections: precision", ".3f", 1, "difference"),
    ("detections", "recall", "detections: recall", ".3f", 1, "difference"),
    ("map", "f1", "map: F1 of occupied", ".3f", 1, "difference"),
    ("run", "seconds", "time of the run, s", ".0f", -1, "ratio"),
]


def evaluations(truth, run, handheld):
    """Those of bench/seeds.py, and the trajectory and the associations as they were known at the moment."""
    for report, arguments in seeds.evaluations(truth, run, handheld):
        yield report, arguments
        live = run / "associations_live.jsonl"
        if report == "objects" and run / "associations.jsonl" in arguments and live.exists():
            yield "objects_live", [live if part == run / "associations.jsonl" else part for part in arguments]
    if (run / "live.tum").exists():
        yield "live", ["trajectory", truth / "groundtruth_robot.txt", run / "live.tum"]


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


def table(numbers, results):
    """Markdown; results: variant -> list of the flats' figures in the order of `numbers` (empty: the run failed)."""
    reporting = numbers[0] in REPORTING
    purpose = "for reporting: no setting was chosen on them" if reporting else "for choosing: not a measure of how good the settings are"
    others = [name for name in results if name != "default"]
    columns = [f"{name}: median (worst)" for name in results] + [f"{name} against default" for name in others]
    lines = [f"### {len(numbers)} random flats, {numbers[0]} to {numbers[-1]}, {purpose}", "",
             "Against default: mean difference, or x mean ratio, flat by flat [95 % bootstrap interval]; * where that excludes no change.",
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
    parser.add_argument("--threads", type=int, default=0, help="of each run; 0: all cores")
    parser.add_argument("--out", type=Path, default=seeds.ROOT / "out" / "flats")
    parser.add_argument("--program", type=Path, default=seeds.PROGRAM)
    return parser.parse_args(argv)


def flat(program, arguments, number, folder):
    """Folder of the recording of a flat."""
    options = ["--rooms", arguments.rooms] if arguments.rooms else []
    options += ["--handheld"] if arguments.handheld else []
    options += ["--meshes", arguments.meshes.resolve()] if arguments.meshes else []
    return seeds.simulated(program, "flat", repr(options).encode(), number, folder, ["--flat", number, *options])


def main(argv=None):
    arguments = arguments_of(argv)
    program, out = seeds.Program(arguments.program), arguments.out.resolve()
    variants = {"default": [], **dict(arguments.variants)}
    results = {name: [] for name in variants}
    for number in arguments.seeds:
        truth = flat(program, arguments, number, out / "sequences")
        for name, settings in variants.items():
            figures, problems = seeds.measure(program, truth, out / "runs" / name / f"flat_{number}", arguments.handheld,
                                              arguments.set + settings, arguments.threads, evaluations, FIGURES)
            results[name].append(figures)
            print(f"flat {number}, {name}: {len(figures)} figures", *problems, sep="\n  ", file=sys.stderr, flush=True)
        (out / "figures.json").write_text(json.dumps({"flats": arguments.seeds, **results}, indent=1) + "\n")
    text = table(arguments.seeds, results)
    (out / "table.md").write_text(text)
    print(text)
    return 0 if all(figures for flats in results.values() for figures in flats) else 1


if __name__ == "__main__":
    sys.exit(main())
