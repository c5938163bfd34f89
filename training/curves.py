#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws what `train.py` logged: losses and average precisions over the steps.

    training/curves.py OUT/full/log.jsonl [MORE/log.jsonl ...] -o OUT/curves.png
"""
import argparse
import json
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot

FINDS = ("swivel chair", "sofa", "door", "person")


def rows_of(logs):
    """The lines of all logs, the steps of each going on from the one before."""
    rows, before = [], 0
    for log in logs:
        own = [json.loads(line) for line in log.read_text().splitlines()]
        rows += [row | {"steps": row["steps"] + before} for row in own]
        before = rows[-1]["steps"] if rows else 0
    return rows


def draw(rows, file):
    figure, (losses, precisions) = pyplot.subplots(1, 2, figsize=(10, 4), constrained_layout=True)
    steps = [row["steps"] for row in rows]
    for name, label in (("kinds", "classes (quality focal loss)"), ("places", "boxes (2 x generalised IoU loss)"), ("extras", "distance and front (0.3 x smooth L1)")):
        losses.plot(steps, [row.get(name, float("nan")) for row in rows], label=label)
    checked = [row for row in rows if "ap" in row]
    for name in FINDS:
        precisions.plot([row["steps"] for row in checked], [row["ap " + name] for row in checked], marker=".", label=name)
    for axes, title in ((losses, "loss, training views"), (precisions, "average precision at IoU .5, views to check with")):
        axes.set(title=title, xlabel="steps")
        axes.grid(alpha=0.3)
        axes.legend()
    losses.set_yscale("log")
    figure.savefig(file, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("logs", nargs="+", type=Path)
    parser.add_argument("-o", "--output", type=Path, required=True, help=".png, .svg or .pdf")
    arguments = parser.parse_args()
    draw(rows_of(arguments.logs), arguments.output)


if __name__ == "__main__":
    main()
