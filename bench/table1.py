#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Table I of the founding paper on this disk: imports, runs and evaluates the sequences of TUM RGB-D and ICL-NUIM that lie below DIR.

    bench/table1.py DIR [--only fr1/desk ...] [--seeds N] [--set k=v ...] [--out DIR] [--list]

DIR holds the unpacked folders under their published names, however deep (at most four levels): rgbd_dataset_freiburg1_360,
..._freiburg1_floor, ..._freiburg1_desk, ..._freiburg2_desk, ..._freiburg3_long_office_household; of ICL-NUIM
living_room_traj1_frei_png, living_room_traj2_frei_png, traj1_frei_png and traj2_frei_png (the office; office_room_traj... will do).
ICL-NUIM's ground truth (livingRoom1.gt.freiburg, traj1.gt.freiburg) lies in the folder or beside it. What is not found is named and left out.

Loops are not closed, as in the paper. Three arms, in which nothing else differs: `no_landmarks` (the trajectory alone, to compare with the
paper's ORB-SLAM2 without loop closing), `cuboids_only` (bench/cuboids_only.ini, with the paper's Cube+Ours) and `ours`. Figures are the
RMSE of the ATE in metres of the camera's path after SE(3) alignment, and the share of the time that has a pose where that is less than 0.99.

A run is the same to the last bit each time; --seeds N > 1 shows how much chance is in one: seed 1 is the recording as it is, the others
lack a twentieth of their image pairs, drawn anew for each. Cells are then median (least .. largest).

The camera is camera.json of a folder that has one, else the published one. OUT/batch holds the runs: what is complete and unchanged is
used again by every later call; OUT/figures.json has each run's figures. Recordings are as large as the folders (--external-images).
"""
import argparse
import hashlib
import json
import os
import random
import re
import shutil
import sqlite3
import sys
from dataclasses import dataclass
from pathlib import Path

import seeds

CUBOIDS = seeds.ROOT / "bench" / "cuboids_only.ini"
LOOPS_OFF = ["tracking.loop_closing=false", "lidar.loop_closing=false", "object_loop_closing.enabled=false"]
ARMS = {"no_landmarks": ["landmarks.enabled=false"], "cuboids_only": [f"pipeline.objects_file={CUBOIDS}"], "ours": []}
FIGURES = [("trajectory", "ate_rmse_m"), ("trajectory", "coverage"), ("run", "seconds")]
DEEPEST = 4
LEFT_OUT = 0.05
LISTS = ("associations.txt", "association.txt", "associate.txt", "rgb.txt")


@dataclass(frozen=True)
class Sequence:
    name: str           # as in the paper
    folder: str         # pattern of its folder's name
    truth: str          # file beside the folder, when none lies inside
    camera: list        # of `import tum`, when the folder has no camera.json
    rate: list          # of `import tum`: stamps are frame numbers
    paper: tuple        # ORB-SLAM2 without loop closing, Cube+Ours, ours; m


def tum(name, folder, camera, *paper):
    return Sequence(name, rf"(rgbd_dataset_)?{folder}(_validation)?", "", ["--camera", camera], [], paper)


def icl(name, folder, truth, *paper):
    return Sequence(name, folder, truth, ["--camera", "icl"], ["--frame-rate", "30"], paper)


SEQUENCES = [
    icl("Living1", r"living_room_traj1(n)?_frei_png", "livingRoom1*.gt.freiburg", 0.041, 0.039, 0.043),
    icl("Living2", r"living_room_traj2(n)?_frei_png", "livingRoom2*.gt.freiburg", 0.038, 0.034, 0.045),
    icl("Office1", r"(office_room_|office_)?traj1(n)?_frei_png", "traj1*.gt.freiburg", 0.062, 0.073, 0.069),
    icl("Office2", r"(office_room_|office_)?traj2(n)?_frei_png", "traj2*.gt.freiburg", 0.048, 0.029, 0.032),
    tum("fr1/360", "freiburg1_360", "freiburg1", 0.028, 0.058, 0.062),
    tum("fr1/floor", "freiburg1_floor", "freiburg1", 0.068, 1.157, 2.128),
    tum("fr1/desk", "freiburg1_desk", "freiburg1", 0.021, 0.028, 0.022),
    tum("fr2/desk", "freiburg2_desk", "freiburg2", 0.014, 0.019, 0.013),
    tum("fr3/office", "freiburg3_long_office_household", "freiburg3", 0.036, 0.032, 0.028),
]


def image_folders(top):
    """Folders with lists of images at `top` and below it, in the order of their names."""
    for path, below, files in os.walk(top, followlinks=True):
        below.sort()
        if any(name in files for name in LISTS):
            yield Path(path)
            below.clear()
        elif len(Path(path).relative_to(top).parts) >= DEEPEST:
            below.clear()


def find(top):
    """Sequence name -> folder; what was found twice, in lines. An archive may have unpacked into a folder of its name in one of its name."""
    found, problems = {}, []
    for folder in image_folders(top):
        for sequence in SEQUENCES:
            if not re.fullmatch(sequence.folder, folder.name) and not re.fullmatch(sequence.folder, folder.parent.name):
                continue
            if sequence.name in found:
                problems.append(f"{sequence.name}: {folder} is left out, {found[sequence.name]} is used")
            found.setdefault(sequence.name, folder)
    return found, problems


def truth_beside(sequence, folder):
    """The file of ICL-NUIM that was downloaded beside the archive; None when the folder has its own, or there is none."""
    if (folder / "groundtruth.txt").exists() or any(folder.glob("*.gt.freiburg*")) or not sequence.truth:
        return None
    places = (folder.parent, folder.parent.parent)
    return next((file for place in places for file in sorted(place.glob(sequence.truth))), None)


def thinned(text, seed):
    """The lines of a list without a twentieth of its entries; comments stay."""
    generator = random.Random(seed)
    return "".join(line for line in text.splitlines(keepends=True)
                   if line.startswith("#") or not line.strip() or generator.random() >= LEFT_OUT)


def view_of(sequence, folder, seed, place):
    """What is to be imported: `folder`, or a folder of links to what is in it, with the truth from beside it and thinned lists."""
    truth = truth_beside(sequence, folder)
    if seed == 1 and truth is None:
        return folder
    shutil.rmtree(place, ignore_errors=True)
    place.mkdir(parents=True)
    for entry in folder.iterdir():
        (place / entry.name).symlink_to(entry.resolve())
    if truth:
        (place / truth.name).symlink_to(truth.resolve())
    for name in LISTS:
        if seed > 1 and (place / name).exists():
            (place / name).unlink()
            (place / name).write_text(thinned((folder / name).read_text(), seed))
    return place


def import_words(sequence, folder, rawlog):
    camera = [] if (folder / "camera.json").exists() else sequence.camera
    stamps = sequence.rate if frame_numbers(folder) else []
    return ["import", "tum", folder, "-o", rawlog, "--external-images", *camera, *stamps]


def frame_numbers(folder):
    """Whether the stamps of the first list are whole numbers below a million: ICL-NUIM has no times."""
    for name in LISTS:
        if (folder / name).exists():
            stamps = [line.split()[0] for line in (folder / name).read_text().splitlines() if line.strip() and line[0] != "#"]
            return bool(stamps) and all(stamp.isdigit() and int(stamp) < 1000000 for stamp in stamps)
    return False


def state_of(folder, words):
    """Changes with the command and with the lists, cameras and truth of the folder."""
    key = hashlib.sha256("\n".join(map(str, words)).encode())
    for file in sorted(folder.iterdir()):
        if file.is_file() and not file.name.startswith("."):
            key.update(file.name.encode() + b"\0" + str(file.stat().st_mtime_ns).encode() + file.read_bytes()[:1 << 20])
    return key.hexdigest()


def imported(program, sequence, folder, seed, out):
    """(rawlog, None), or (None, what went wrong). An import of the same folder is used again."""
    name = f"{sequence.name.replace('/', '_')}.seed{seed}"
    out.mkdir(parents=True, exist_ok=True)
    rawlog, stamp = out / f"{name}.rawlog", out / f"{name}.key"
    view = view_of(sequence, folder, seed, out / f"{name}.folder")
    words = import_words(sequence, view, rawlog)
    state = state_of(view if view == folder else folder, [*words, seed, LEFT_OUT])
    if rawlog.exists() and stamp.exists() and stamp.read_text() == state:
        return rawlog, None
    stamp.unlink(missing_ok=True)
    problem = program.call(*words)
    if problem:
        return None, problem
    if not rawlog.with_suffix(".groundtruth.txt").exists():
        return None, f"{folder}: has no ground truth (groundtruth.txt, or {sequence.truth or 'that file'} in or beside it)"
    stamp.write_text(state)
    return rawlog, None


def job_file(arguments, rawlogs):
    """What `roomgraph batch` is to do, as JSON, which is YAML. rawlogs: (sequence name, seed) -> file."""
    inputs = [{"files": str(rawlog), "group": name, "truth": {"camera_trajectory": str(rawlog.with_suffix(".groundtruth.txt"))}}
              for (name, _), rawlog in rawlogs.items()]
    return {"inputs": inputs,
            "variants": [{"name": arm, "set": LOOPS_OFF + arguments.set + settings} for arm, settings in ARMS.items()],
            "limits": {"jobs": arguments.jobs, "threads": arguments.threads},
            "keep": "map"}


def catalogued(catalogue, rawlogs):
    """(sequence name, seed) -> arm -> figures; the program's revisions; what went wrong, in lines."""
    by_path = {str(rawlog): key for key, rawlog in rawlogs.items()}
    results, revisions, problems = {key: {arm: {} for arm in ARMS} for key in rawlogs}, set(), []
    for run, path, arm, status, reason, revision in catalogue.execute(
            "SELECT runs.name, path, variant, status, reason, revision FROM runs JOIN inputs ON inputs.id = input_id ORDER BY runs.name"):
        if path not in by_path or arm not in ARMS:
            continue  # of an earlier call
        if reason:
            problems.append(f"{run}: {reason}")
        if status == "complete":
            revisions.add(revision)
            figures = dict(catalogue.execute("SELECT figure, value FROM figures WHERE run = ?", [run]))
            figures["run.seconds"] = figures.pop("run.wall_s", None)
            wanted = (f"{report}.{key}" for report, key in FIGURES)
            results[by_path[path]][arm] = {name: figures[name] for name in wanted if figures.get(name) is not None}
    return results, sorted(revisions), problems


def cell(runs):
    """Of the seeds of one arm: median (least .. largest), and how much of the time has a pose."""
    errors = [figures["trajectory.ate_rmse_m"] for figures in runs if "trajectory.ate_rmse_m" in figures]
    if not errors:
        return "-" if not any(runs) else "no ATE"
    text = f"{seeds.quantile(errors, 0.5):.3f}"
    if len(errors) > 1:
        text += f" ({min(errors):.3f} .. {max(errors):.3f})"
    if len(errors) < len(runs):
        text = f"{len(errors)} of {len(runs)}: {text}"
    covered = [figures["trajectory.coverage"] for figures in runs if "trajectory.coverage" in figures]
    return text + (f", {seeds.quantile(covered, 0.5):.2f} of the time" if covered and seeds.quantile(covered, 0.5) < 0.99 else "")


def table(found, results, revisions, count, settings):
    """Markdown; found: names of the sequences that were on the disk."""
    lines = ["### Table I: RMSE of the ATE, m", "",
             f"Loops off; {count} seed{'s' if count > 1 else ''}; program {', '.join(revisions) or '-'}"
             + (f"; {' '.join(settings)}" if settings else "") + ".", "",
             "| sequence | paper: ORB-SLAM2 w/o LC | paper: Cube+Ours | paper: ours | no_landmarks | cuboids_only | ours |",
             "| --- | --- | --- | --- | --- | --- | --- |"]
    for sequence in SEQUENCES:
        theirs = [f"{value:.3f}" for value in sequence.paper]
        ours = [cell([arms[arm] for (name, _), arms in results.items() if name == sequence.name]) for arm in ARMS]
        lines.append("| " + " | ".join([sequence.name, *theirs, *(ours if sequence.name in found else ["not found"] * len(ARMS))]) + " |")
    return "\n".join(lines) + "\n"


def arguments_of(argv):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, metavar="DIR")
    parser.add_argument("--only", nargs="+", action="extend", default=[], metavar="NAME", choices=[s.name for s in SEQUENCES])
    parser.add_argument("--list", action="store_true", help="only say what is found where")
    parser.add_argument("--seeds", type=int, default=1, help="how many (default 1)")
    parser.add_argument("--set", nargs="+", action="extend", default=[], metavar="K=V", help="for every arm, e.g. detection.models=NETWORK.onnx")
    parser.add_argument("--threads", type=int, default=1, help="of each run")
    parser.add_argument("--jobs", type=int, default=0, help="runs at once; 0: cores / threads")
    parser.add_argument("--out", type=Path, default=seeds.ROOT / "out" / "table1")
    parser.add_argument("--program", type=Path, default=seeds.PROGRAM)
    arguments = parser.parse_args(argv)
    if arguments.seeds < 1:
        parser.error("--seeds must be at least 1")
    if not arguments.folder.is_dir():
        parser.error(f"{arguments.folder}: no such folder")
    return arguments


def main(argv=None):
    arguments = arguments_of(argv)
    out = arguments.out.resolve()
    found, problems = find(arguments.folder)
    found = {name: folder for name, folder in found.items() if not arguments.only or name in arguments.only}
    missing = [s.name for s in SEQUENCES if s.name not in found and (not arguments.only or s.name in arguments.only)]
    for line in problems + ([f"not found below {arguments.folder}: {', '.join(missing)}"] if missing else []):
        print(line, file=sys.stderr)
    if arguments.list or not found:
        print(*(f"{name}: {folder}" for name, folder in found.items()), sep="\n")
        return 0 if found else 3
    program, rawlogs, failed = seeds.Program(arguments.program), {}, False
    for sequence in (s for s in SEQUENCES if s.name in found):
        for seed in range(1, arguments.seeds + 1):
            print(f"{sequence.name}, seed {seed}: import of {found[sequence.name]}", file=sys.stderr, flush=True)
            rawlog, problem = imported(program, sequence, found[sequence.name], seed, out / "recordings")
            if problem:
                print(problem, file=sys.stderr)
                failed = True
            else:
                rawlogs[sequence.name, seed] = rawlog
    if not rawlogs:
        return 1
    ended = seeds.batch(arguments.program, out, job_file(arguments, rawlogs))
    if ended not in (0, 1):
        return ended
    catalogue = sqlite3.connect(out / "batch" / "catalogue.sqlite")
    results, revisions, problems = catalogued(catalogue, rawlogs)
    catalogue.close()
    print(*problems, sep="\n", file=sys.stderr)
    (out / "figures.json").write_text(json.dumps([{"sequence": name, "seed": seed, **arms} for (name, seed), arms in results.items()], indent=1) + "\n")
    text = table(found, results, revisions, arguments.seeds, arguments.set)
    (out / "table.md").write_text(text)
    print(text)
    return 0 if not failed and all(figures for arms in results.values() for figures in arms.values()) else 1


if __name__ == "__main__":
    sys.exit(main())
