# SPDX-License-Identifier: BSD-3-Clause
"""Training views of `roomgraph training-set`, their classes, and the augmentation of batches."""
import json
from pathlib import Path

import numpy as np
import torch
from torch.nn import functional as F

CLASSES = ["swivel chair", "other seat", "sofa", "door", "person", "table", "bed", "cabinet", "plant", "monitor", "coat stand", "box", "wooden chair"]
KINDS = {"swivel_chair": 0, "armchair": 1, "stool": 1, "bench": 1, "sofa": 2, "door": 3, "person": 4,
         "desk": 5, "table": 5, "round table": 5, "bed": 6, "shelf": 7, "cabinet": 7, "cupboard": 7, "refrigerator": 7, "plant": 8,
         "monitor": 9, "coat stand": 10, "printer": 11, "box": 11, "bin": 11, "wooden chair": 12,
         "visitor chair": 12}
COLOR, DEPTH = slice(0, 3), slice(3, 6)
NEAR_M = 0.4  # depth whose inverse is the channel's largest value
FAR_SHARE = 0.4  # of the batches' pictures
MIN_VISIBLE, MIN_HEIGHT_PX = 0.2, 8  # what is seen less of is neither asked for nor wrong


class Views:
    """Views of one or more folders, memory-mapped."""

    def __init__(self, folders):
        self.arrays, self.index, self.boxes = [], [], []
        for folder in sorted(map(Path, folders)):
            about = json.loads((folder / "set.json").read_text())
            shape = (about["views"], about["channels"], about["height"], about["width"])
            self.arrays.append(np.memmap(folder / "views.u8", np.uint8, "r", shape=shape))
            self.height, self.width = shape[2:]
            for row, line in enumerate((folder / "views.jsonl").read_text().splitlines()):
                self.index.append((len(self.arrays) - 1, row))
                self.boxes.append(self._targets(json.loads(line)))

    @staticmethod
    def _targets(label):
        """(n, 6): class, u0, v0, u1, v1, 1 when it must be found."""
        rows = []
        for item in label["boxes"]:
            if item["kind"] not in KINDS:
                continue
            u0, v0, u1, v1 = item["box"]
            sure = item["visible"] > MIN_VISIBLE and item["unoccluded"] > 0.25 and v1 - v0 >= MIN_HEIGHT_PX and u1 - u0 >= 5
            rows.append([KINDS[item["kind"]], u0, v0, u1, v1, float(sure)])
        return np.array(rows, np.float32).reshape(-1, 6)

    def __len__(self):
        return len(self.index)

    def batch(self, numbers):
        pictures = np.stack([self.arrays[a][row] for a, row in (self.index[i] for i in numbers)])
        return torch.from_numpy(pictures).float().div_(255), [torch.from_numpy(self.boxes[i].copy()) for i in numbers]


def far_away(pictures, boxes, random):
    """Four pictures at half their size in one: everything seen from twice as far (mosaic, Bochkovskiy et al. 2020, with the depth to match).

    The channel of depth holds its inverse's root (rgbdChannels()); what is then beyond the sensor's range has none.
    """
    _, _, height, width = pictures.shape
    half = torch.empty((4, pictures.shape[1], height // 2, width // 2))
    half[:, COLOR] = F.avg_pool2d(pictures[:, COLOR], 2)
    half[:, DEPTH] = pictures[:, DEPTH, ::2, ::2]
    inverse = half[:, DEPTH.start].mul_(0.5 ** 0.5)
    half[:, DEPTH] *= (inverse > (NEAR_M / float(random.uniform(3, 8))) ** 0.5).unsqueeze(1)
    out, rows = torch.empty(pictures.shape[1:]), []
    for i in range(4):
        v, u = i // 2 * (height // 2), i % 2 * (width // 2)
        out[:, v:v + height // 2, u:u + width // 2] = half[i]
        own = boxes[i].clone()
        own[:, 1:5] = own[:, 1:5] / 2 + torch.tensor([u, v, u, v])
        own[own[:, 4] - own[:, 2] < MIN_HEIGHT_PX, 5] = 0
        rows.append(own)
    return out, torch.cat(rows)


def drawn(views, count, random):
    """A batch of `count` pictures, FAR_SHARE of them of four views each."""
    pictures, boxes = views.batch(random.integers(0, len(views), count))
    for i in range(count):
        if random.random() < FAR_SHARE:
            pictures[i], boxes[i] = far_away(*views.batch(random.integers(0, len(views), 4)), random)
    return pictures, boxes


def shrunk(pictures, boxes, factor):
    """Every `factor`-th pixel, so that no depth is made up between near and far."""
    if factor == 1:
        return pictures, boxes
    for rows in boxes:
        rows[:, 1:5] /= factor
    return pictures[:, :, ::factor, ::factor].contiguous(), boxes


def augmented(pictures, boxes, random):
    """Mirrored, re-lit, and without colour or depth in some: in place, returned for convenience."""
    width = pictures.shape[-1]
    for i in range(len(pictures)):
        if random.random() < 0.5:
            pictures[i] = pictures[i].flip(-1)
            boxes[i][:, [1, 3]] = width - boxes[i][:, [3, 1]]
        colors = pictures[i, COLOR]
        u = random.random()
        if u < 0.15:
            colors.zero_()
        else:
            if u < 0.35:
                colors.copy_(colors.mean(0, keepdim=True).expand(3, -1, -1).clone())
            gain = torch.from_numpy(random.uniform(0.7, 1.4) * random.uniform(0.85, 1.15, (3, 1, 1))).float()
            colors.mul_(gain).add_(float(random.uniform(-0.08, 0.08))).clamp_(0, 1).pow_(float(random.uniform(0.7, 1.4)))
            if random.random() < 0.3:
                colors.add_(torch.randn(colors.shape) * float(random.uniform(0, 0.05))).clamp_(0, 1)
        if u > 0.9:
            pictures[i, DEPTH].zero_()
        elif random.random() < 0.3:
            pictures[i, 4:].zero_()  # height and slope, as where no level surface is seen
    return pictures, boxes
