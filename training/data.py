# SPDX-License-Identifier: BSD-3-Clause
"""Training views of `roomgraph training-set` and their labels."""
import json
from glob import glob
from pathlib import Path

import numpy as np
import torch

CLASSES = ["swivel chair", "other seat", "sofa", "door", "person", "table", "bed", "cabinet", "plant", "monitor", "coat stand", "box", "wooden chair"]
KINDS = {"swivel_chair": 0, "armchair": 1, "stool": 1, "bench": 1, "sofa": 2, "door": 3, "person": 4,
         "desk": 5, "table": 5, "round table": 5, "bed": 6, "shelf": 7, "cabinet": 7, "cupboard": 7, "refrigerator": 7, "plant": 8,
         "monitor": 9, "coat stand": 10, "printer": 11, "box": 11, "bin": 11, "wooden chair": 12,
         "visitor chair": 12}
DOOR = 3
FRONTED = (0, 1, 2, 3, 12)  # classes with a front that shows
COLOR, DEPTH, HEIGHT = slice(0, 3), slice(3, 6), 4
HEIGHT_STEPS_PER_M = 254 / 2.6  # rgbdChannels()
MIN_VISIBLE, MIN_HEIGHT_PX = 0.2, 8  # what is seen less of is neither asked for nor wrong
# Columns of a box: class (-1: none), corners in px, 1 when it must be found, distance of the object's middle in m (0: not known),
# angle about the vertical from the direction to the camera to the object's front in rad (NaN: not known).
KIND, U0, V0, U1, V1, SURE, RANGE, FRONT = range(8)


def front_of(kind, angle):
    """The front that can be seen: of a door the side that faces the camera."""
    if kind not in FRONTED or angle is None:
        return float("nan")
    if kind == DOOR and np.cos(angle) < 0:
        angle += np.pi
    return (angle + np.pi) % (2 * np.pi) - np.pi


def boxes_of_label(label):
    """(n, 8) boxes of a line of views.jsonl."""
    rows = []
    for item in label["boxes"]:
        if item["kind"] not in KINDS:
            continue
        u0, v0, u1, v1 = item["box"]
        sure = item["visible"] > MIN_VISIBLE and item["unoccluded"] > 0.25 and v1 - v0 >= MIN_HEIGHT_PX and u1 - u0 >= 5
        kind = KINDS[item["kind"]]
        rows.append([kind, u0, v0, u1, v1, float(sure), item.get("range", 0), front_of(kind, item.get("front"))])
    return np.array(rows, np.float32).reshape(-1, 8)


def padded(rows, length):
    out = np.full((length, 8), -1, np.float32)
    out[:len(rows)] = rows
    return out


class Views:
    """Views of the folders that match patterns: mapped from disk, or in the memory of a GPU (`joined`: in one array, as a batch is then one
    lookup). Folders that are finished later can be added."""

    def __init__(self, patterns, device="cpu", joined=None):
        self.patterns, self.device = [str(p) for p in patterns], torch.device(device)
        self.joined = self.device.type != "cpu" if joined is None else joined
        self.known, self.arrays, self.boxes = set(), [], []
        self.array, self.row = torch.empty(0, dtype=torch.long), torch.empty(0, dtype=torch.long)
        self.refresh()

    def refresh(self):
        """Adds the folders that are finished since the last call; returns their number."""
        folders = sorted({Path(f).parent for p in self.patterns for f in glob(str(Path(p) / "set.json"))} - self.known)
        for folder in folders:
            self._add(folder)
        return len(folders)

    def _add(self, folder):
        self.known.add(folder)
        about = json.loads((folder / "set.json").read_text())
        count = about["views"]
        if not count:
            return
        shape = (count, about["channels"], about["height"], about["width"])
        self.height, self.width = shape[2:]
        self._keep(torch.from_numpy(np.memmap(folder / "views.u8", np.uint8, "c", shape=shape)))
        self.boxes += [boxes_of_label(json.loads(line)) for line in (folder / "views.jsonl").read_text().splitlines()]

    def _keep(self, pictures):
        """Their place is at the end."""
        count = len(pictures)
        if not self.joined:
            self.array = torch.cat([self.array, torch.full((count,), len(self.arrays))])
            self.row = torch.cat([self.row, torch.arange(count)])
            self.arrays.append(pictures)
            return
        used = len(self.row)
        if not self.arrays or used + count > len(self.arrays[0]):  # half as much again: the allocator keeps what was given back of each size
            grown = torch.empty((3 * (used + count) // 2, *pictures.shape[1:]), dtype=torch.uint8, device=self.device)
            if used:
                grown[:used] = self.arrays[0][:used]
            self.arrays = [grown]
            if self.device.type == "cuda":
                torch.cuda.empty_cache()
        self.arrays[0][used:used + count] = pictures.to(self.device)
        self.array, self.row = torch.zeros(used + count, dtype=torch.long), torch.arange(used + count)

    def __len__(self):
        return len(self.row)

    def batch(self, numbers):
        """Pictures (B, 6, H, W) in [0, 1], and boxes (B, M, 8) in the processor's memory, of the given views."""
        numbers = torch.as_tensor(np.asarray(numbers), dtype=torch.long)
        if len(self.arrays) == 1:
            pictures = self.arrays[0][self.row[numbers].to(self.device)]
        else:
            pictures = torch.stack([self.arrays[a][row] for a, row in zip(self.array[numbers].tolist(), self.row[numbers].tolist())])
        boxes = [self.boxes[i] for i in numbers.tolist()]
        length = max(1, max(len(rows) for rows in boxes))
        return pictures.float().div_(255), torch.from_numpy(np.stack([padded(rows, length) for rows in boxes]))
