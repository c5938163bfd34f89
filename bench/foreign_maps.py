#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs recordings of random flats with the maps of other flats: none may be re-localised. Each with its own map, as a control, must be.

    bench/foreign_maps.py [--flats 1-4] [--seconds 60] [--out DIR] [--program PROGRAM]

Every flat is simulated (kept in OUT/sequences and used again) and mapped once as a whole; its first SECONDS are then run with the map of every
flat. Simulated recordings and boxes. Prints Markdown; OUT/foreign.json keeps what each run said.

Exit codes: 0 done, 1 a run failed or one was re-localised in a foreign map, 2 usage.
"""
import argparse
import json
import sys
from pathlib import Path

import continue_map
import flats
import seeds


class Maps:
    """Recordings and maps of flats by number."""

    def __init__(self, arguments):
        self.program, self.out = seeds.Program(arguments.program), arguments.out
        self.recording, self.map = {}, {}

    def call(self, *arguments):
        problem = self.program.call(*arguments)
        if problem:
            raise RuntimeError(problem)

    def make(self, number):
        truth = seeds.simulated(self.program, "flat", b"[]", number, self.out / "sequences", ["--flat", number])
        self.recording[number], self.map[number] = next(truth.glob("*.rawlog")), self.out / f"flat_{number}" / "map.rgmap"
        self.call("run", self.recording[number], "-o", self.out / f"flat_{number}", *continue_map.QUIET)

    def said(self, driven, mapped, seconds):
        """`earlier_map` of the summary of one flat's recording in another's map."""
        folder = self.out / f"flat_{driven}_in_{mapped}"
        self.call("run", self.recording[driven], "-o", folder, *continue_map.QUIET, "--until", seconds, "--map", self.map[mapped])
        return json.loads((folder / "summary.json").read_text(encoding="utf-8"))["earlier_map"]


def table(numbers, said):
    """Rows: the flat that is driven; columns: the flat whose map is used."""
    def cell(driven, mapped):
        found = said[driven, mapped]
        return f"after {found['after_s']:.1f} s, by {found['by']}" if found["relocalised"] == "yes" else "refused"
    lines = ["| flat \\ map of | " + " | ".join(map(str, numbers)) + " |", "| --- |" + " --- |" * len(numbers)]
    return lines + [f"| {driven} | " + " | ".join(cell(driven, mapped) for mapped in numbers) + " |" for driven in numbers]


def wrong_places(said):
    """(driven, mapped) of runs that were laid into a foreign map."""
    return [pair for pair, found in said.items() if pair[0] != pair[1] and found["relocalised"] == "yes"]


def main(argv=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--flats", default="1-4", type=flats.parse_seeds, help="1-4 or 3,7 (1 to 99: for choosing; 1000 to 1019: for reporting only)")
    parser.add_argument("--seconds", type=float, default=60, help="of each recording that is run in the maps")
    parser.add_argument("--out", type=Path, default=seeds.ROOT / "out" / "foreign")
    parser.add_argument("--program", type=Path, default=seeds.PROGRAM)
    arguments = parser.parse_args(argv)
    arguments.out.mkdir(parents=True, exist_ok=True)
    maps = Maps(arguments)
    for number in arguments.flats:
        maps.make(number)
    said = {}
    for driven in arguments.flats:
        for mapped in arguments.flats:
            said[driven, mapped] = maps.said(driven, mapped, arguments.seconds)
            print(driven, "in the map of", mapped, said[driven, mapped], file=sys.stderr, flush=True)
    (arguments.out / "foreign.json").write_text(
        json.dumps([{"driven": driven, "mapped": mapped, **found} for (driven, mapped), found in said.items()], indent=1), encoding="utf-8")
    print("\n".join(table(arguments.flats, said)))
    return 1 if wrong_places(said) else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except RuntimeError as error:
        print(error, file=sys.stderr)
        sys.exit(1)
