#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Folders as TUM RGB-D and ICL-NUIM have them, of one that `roomgraph export tum` wrote.

    table1_layouts.py tum EXPORT PLACE/rgbd_dataset_freiburg1_desk
    table1_layouts.py icl EXPORT PLACE/living_room_traj1_frei_png

TUM: rgb.txt and depth.txt with comments, groundtruth.txt, no associations; camera.json stays, as no published camera took the pictures.
ICL-NUIM: associations.txt with the depth image first and frame numbers for times, truth in a file of its own beside the images and in a
left-handed world with y up (S T S, S = diag(1, -1, 1)), depth in fifths of a millimetre, no camera file. Needs Python's OpenCV.
"""
import json
import pathlib
import shutil
import sys


def rows(file):
    return [line.split() for line in file.read_text().splitlines() if line.strip() and not line.startswith("#")]


def as_tum(export, place):
    shutil.copytree(export, place)
    (place / "associations.txt").unlink()
    for name in ("rgb.txt", "depth.txt"):
        list_of = place / name
        list_of.write_text("# images\n# file: 'recording.bag'\n# timestamp filename\n" + "\n".join(" ".join(row) for row in rows(list_of)) + "\n")


def as_icl(export, place):
    import cv2
    factor = 5000 / json.loads((export / "camera.json").read_text())["depth_scale"]
    (place / "rgb").mkdir(parents=True)
    (place / "depth").mkdir()
    stamps, lines = [], []
    for number, (t, rgb, _, depth) in enumerate(rows(export / "associations.txt")):
        shutil.copy(export / rgb, place / f"rgb/{number}.png")
        metric = cv2.imread(str(export / depth), cv2.IMREAD_UNCHANGED)
        cv2.imwrite(str(place / f"depth/{number}.png"), (metric * factor).clip(0, 65535).astype(metric.dtype))
        stamps.append(float(t))
        lines.append(f"{number} depth/{number}.png {number} rgb/{number}.png")
    (place / "associations.txt").write_text("\n".join(lines) + "\n")
    truth = {round(float(row[0]), 3): row[1:] for row in rows(export / "groundtruth.txt")}
    poses = []
    for number, t in enumerate(stamps):
        x, y, z, qx, qy, qz, qw = map(float, truth[round(t, 3)])
        poses.append(f"{number} {x:.9f} {-y:.9f} {z:.9f} {-qx:.9f} {qy:.9f} {-qz:.9f} {qw:.9f}")
    (place / "livingRoom1.gt.freiburg").write_text("\n".join(poses) + "\n")


if __name__ == "__main__":
    {"tum": as_tum, "icl": as_icl}[sys.argv[1]](pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]))
