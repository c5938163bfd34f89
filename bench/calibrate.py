#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Calibrates recordings of random flats whose calibration is deliberately wrong, and compares with the truth.

    bench/calibrate.py [--seeds 1-20] [--rooms 1] [--out DIR]

For each seed: simulates the flat, writes a recording with sensor poses off by 5 cm and 5 degrees and clocks off by 30 ms
(the records change, not the world), calibrates it, and prints errors and stated standard deviations. At the end: by parameter
the largest error, how many seeds are within 5 mm, 0.2 degrees and 3 ms, and the mean squared error in stated standard
deviations, which is 1 when these are right. Recordings are simulated: DIR keeps them for later calls.
"""
import argparse
import json
import math
import random
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "build" / "release" / "bin" / "roomgraph"
LENGTH, ANGLE, TIME = 0.05, math.radians(5), 0.03
LIMITS = {"m": 0.005, "rad": math.radians(0.2), "s": 0.003}
PLACES = ("lidar x", "lidar y", "lidar yaw", "camera x", "camera y", "camera z", "camera yaw", "camera pitch",
          "camera roll", "camera time offset", "wheel time offset")


def call(*arguments):
    done = subprocess.run([str(PROGRAM), *map(str, arguments)], capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, arguments))}: {done.stderr.strip()}")
    return done.stdout


def seeds_of(text):
    out = []
    for part in text.split(","):
        first, _, last = part.partition("-")
        out += range(int(first), int(last or first) + 1)
    return out


def truth_of(world):
    """True parameters, as `calibrate` names them, of a world without wrong calibration."""
    sensors = world["sensors"]
    camera, lidar, wheels = (sensors[k] for k in ("camera", "lidar", "odometry"))
    drift = wheels["drift_rad_m"] if "drift_rad_m" in wheels else math.radians(wheels["drift_deg_m"])
    pitch = camera["pitch_down_rad"] if "pitch_down_rad" in camera else math.radians(camera["pitch_down_deg"])
    turn = 1 + wheels["turn_error"]
    return {"lidar x": lidar["at_m"][0], "lidar y": lidar["at_m"][1], "lidar yaw": 0,
            "camera x": camera["at_m"][0], "camera y": camera["at_m"][1], "camera z": camera["at_m"][2],
            "camera yaw": 0, "camera pitch": pitch, "camera roll": 0,
            "wheel scale": 1 / (1 + wheels["scale_error"]), "wheel turn scale": 1 / turn,
            "wheel heading drift": -drift / turn, "depth scale": 1, "depth bias": 0}


def wrong_file(truth, world, rng, file):
    """Writes a wrong calibration; returns the time offsets that undo it. Lengths of 5 cm and turns of 5 degrees, of
    whatever direction; the lidar stays level, as its tilt is not asked for."""
    def direction(n):
        v = [rng.gauss(0, 1) for _ in range(n)]
        size = math.hypot(*v)
        return [x / size for x in v]

    camera, turn, lidar = direction(3), direction(3), direction(2)
    place = [truth[f"camera {k}"] + LENGTH * d for k, d in zip("xyz", camera)]
    angles = [math.degrees(truth[f"camera {k}"] + ANGLE * d) for k, d in zip(("yaw", "pitch", "roll"), turn)]
    lidar_z = world["sensors"]["lidar"]["at_m"][2]
    lidar_pose = [truth["lidar x"] + LENGTH * lidar[0], truth["lidar y"] + LENGTH * lidar[1], lidar_z,
                  5 * rng.choice((-1, 1)), 0, 0]
    late, wheels_late = TIME * rng.choice((-1, 1)), TIME * rng.choice((-1, 1))
    pose = lambda values: ",".join(f"{v:.6f}" for v in values)
    file.write_text(f"[sensor KINECT]\npose = {pose(place + angles)}\ntime_offset_s = {late}\n"
                    f"[sensor LIDAR]\npose = {pose(lidar_pose)}\n[wheels]\ntime_offset_s = {wheels_late}\n")
    return -late, -wheels_late


def calibrate(seed, rooms, out):
    folder = out / f"flat_{seed}"
    if not (folder / "objects.json").exists():
        call("simulate", "--flat", seed, "--rooms", rooms, "-o", folder, "--quiet")
    world = json.loads((folder / "world.json").read_text())
    recording = next(folder.glob("*.rawlog"))
    truth = truth_of(world)
    wrong = folder / "wrong.ini"
    truth["camera time offset"], truth["wheel time offset"] = wrong_file(truth, world, random.Random(seed), wrong)
    call("calibrate", recording, "--apply", wrong, "--rawlog", folder / "wrong.rawlog.gz", "--jpeg", 95, "--quiet")
    call("calibrate", folder / "wrong.rawlog.gz", "-o", folder / "found.ini", "--json", folder / "found.json", "--quiet")
    (folder / "wrong.rawlog.gz").unlink()
    found = json.loads((folder / "found.json").read_text())["parameters"]
    return {p["name"]: (p["after"] - truth[p["name"]], p["sigma"], p["fixed"], p["unit"]) for p in found}


def shown(value, unit):
    if unit in ("rad", "rad/m"):
        return f"{math.degrees(value):.3f} deg"
    return f"{1000 * value:.2f} m{unit}" if unit in ("m", "s") else f"{value:.5f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", default="1-20")
    parser.add_argument("--rooms", type=int, default=1)
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "calibrate")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    results = {}
    for seed in seeds_of(arguments.seeds):
        results[seed] = calibrate(seed, arguments.rooms, arguments.out)
        print(f"seed {seed}: " + ", ".join(f"{name} {shown(e, u)} +-{shown(s, u)}{'' if f == 'yes' else ' (' + f + ')'}"
                                           for name, (e, s, f, u) in results[seed].items()), flush=True)
    print("\n| parameter | largest error | root mean square | within the limit | fixed | mean square over stated variance |\n"
          "| --- | --- | --- | --- | --- | --- |")
    for name in next(iter(results.values())):
        values = [r[name] for r in results.values()]
        errors, unit = [abs(v[0]) for v in values], values[0][3]
        fixed = [v for v in values if v[2] == "yes"]
        limit = LIMITS.get(unit) if name in PLACES else None
        chi = sum((e / s) ** 2 for e, s, _, _ in fixed) / len(fixed) if fixed else float("nan")
        within = f"{sum(e <= limit for e in errors)} of {len(errors)}" if limit else "-"
        rms = math.sqrt(sum(e * e for e in errors) / len(errors))
        print(f"| {name} | {shown(max(errors), unit)} | {shown(rms, unit)} | {within} | {len(fixed)} | {chi:.2f} |")
    (arguments.out / "figures.json").write_text(json.dumps(results, indent=1))


if __name__ == "__main__":
    main()
