#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Localises with MRPT's pf-localization in a semantic map: with scans, with objects, with both and with neither.

    bench/pf_localization.py [--ini share/mrpt/pf-localization.ini] [--repetitions N] [--particles N] [--json FILE]

Each arm is the ini with use_grid and use_objects switched, run N times (the filter's random numbers differ). An error is the
filter's own, GT_error.txt: the mean distance of the weighted particles from the truth, m. The table has its mean over the
last half of the recording, the share of runs in which that is below 0.5 m, and for how long, in seconds of the recording,
the error stays below 0.5 m until the end. Needs pf-localization (Debian package mrpt-apps) and the release build.
"""
import argparse
import json
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
LIBRARY = ROOT / "build" / "release" / "lib" / "libroomgraph_observations.so"
ARMS = {"odometry alone": (False, False), "scans": (True, False), "objects": (False, True), "scans and objects": (True, True)}
FOUND_M = 0.5


def with_keys(text, values):
    """The ini with keys that it holds set to other values; a key that it lacks is an error."""
    for key, value in values.items():
        text, count = re.subn(rf"(?m)^{key}\s*=.*$", f"{key} = {value}", text)
        if count != 1:
            sys.exit(f"the ini has {count} lines '{key} = …', one is needed")
    return text


def errors_of(ini, folder):
    """Errors of one run, step by step, m."""
    file = folder / "pf.ini"
    file.write_text(ini, encoding="utf-8")
    done = subprocess.run(["pf-localization", str(file)], cwd=ROOT, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          env=os.environ | {"LD_PRELOAD": str(LIBRARY)}, check=False)
    results = sorted(folder.glob("out_*/GT_error.txt"))
    if done.returncode != 0 or not results:
        sys.exit("pf-localization failed:\n" + "\n".join((done.stdout + done.stderr).splitlines()[-5:]))
    return [float(line) for line in results[0].read_text(encoding="utf-8").split()]


def figures_of(runs):
    means = [statistics.fmean(errors[len(errors) // 2:]) for errors in runs]
    found = [mean < FOUND_M for mean in means]
    kept = []
    for errors in runs:
        last = max((i for i, error in enumerate(errors) if error >= FOUND_M), default=-1)
        kept.append(1 - (last + 1) / len(errors))
    return {"runs": len(runs), "found_share": sum(found) / len(found), "error_median_m": statistics.median(means),
            "error_max_m": max(means), "share_of_time_found": statistics.median(kept)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--ini", type=pathlib.Path, default=ROOT / "share" / "mrpt" / "pf-localization.ini")
    parser.add_argument("--repetitions", type=int, default=20, metavar="N")
    parser.add_argument("--particles", type=int, metavar="N", help="in place of those of the ini")
    parser.add_argument("--set", nargs="*", default=[], metavar="KEY=VALUE", help="other keys of the ini")
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE")
    options = parser.parse_args()
    if not shutil.which("pf-localization"):
        sys.exit("pf-localization is not installed (Debian package mrpt-apps)")
    if not LIBRARY.exists():
        sys.exit(f"{LIBRARY} is not built")
    text = options.ini.read_text(encoding="utf-8")
    report = {}
    print(f"{'':18} runs  found  error median  max, m  share of the time found")
    for arm, (grid, objects) in ARMS.items():
        runs = []
        for _ in range(options.repetitions):
            with tempfile.TemporaryDirectory() as folder:
                values = {"use_grid": str(grid).lower(), "use_objects": str(objects).lower(), "experimentRepetitions": 1,
                          "logOutput_dir": f"{folder}/out"} | dict(pair.split("=", 1) for pair in options.set)
                if options.particles:
                    values["particles_count"] = options.particles
                runs.append(errors_of(with_keys(text, values), pathlib.Path(folder)))
        report[arm] = figures_of(runs)
        f = report[arm]
        print(f"{arm:18} {f['runs']:4}  {f['found_share']:5.2f}  {f['error_median_m']:12.3f}  {f['error_max_m']:6.3f}"
              f"  {f['share_of_time_found']:.2f}", flush=True)
    if options.json:
        options.json.write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
