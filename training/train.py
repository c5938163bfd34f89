#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Trains the room detector on the CPU for a given time; resumes from its own checkpoint.

    training/train.py --views DIR/... --check DIR --out DIR --minutes 60
"""
import argparse
import json
import time
from pathlib import Path

import numpy as np
import torch
from torch.nn import functional as F

import data
import evaluate
from network import RoomDetector, boxes_of, cells

RANGES = {8: (0, 48), 16: (32, 112), 32: (80, 1e9)}  # px: largest distance of a side that a level answers for
CENTRE = 1.5  # strides: cells this near the middle of a box answer for it


def assign(boxes, grid):
    """For each cell the row of the box it answers for, -1: none, -2: not judged (it lies in a box that need not be found)."""
    owner = torch.full((len(grid),), -1, dtype=torch.long)
    if not len(boxes):
        return owner
    u, v, stride = grid[:, 0:1], grid[:, 1:2], grid[:, 2:3]
    u0, v0, u1, v1 = (boxes[:, k][None] for k in range(1, 5))
    sides = torch.stack([u - u0, v - v0, u1 - u, v1 - v], -1)
    inside, longest = sides.min(-1).values > 0, sides.max(-1).values
    low = torch.tensor([RANGES[int(s)][0] for s in stride[:, 0]])[:, None]
    high = torch.tensor([RANGES[int(s)][1] for s in stride[:, 0]])[:, None]
    near = ((u - (u0 + u1) / 2).abs() < CENTRE * stride) & ((v - (v0 + v1) / 2).abs() < CENTRE * stride)
    sure = boxes[:, 5][None] > 0
    owner[(inside & ~sure).any(1)] = -2
    area = (u1 - u0) * (v1 - v0)
    cost = torch.where(inside & near & sure & (longest >= low) & (longest < high), area.expand(len(grid), -1), torch.tensor(1e12))
    best, row = cost.min(1)
    owner[best < 1e12] = row[best < 1e12]
    return owner


def overlap(a, b):
    """IoU and generalised IoU (Rezatofighi et al. 2019) of boxes, pairwise."""
    low, high = torch.maximum(a[:, :2], b[:, :2]), torch.minimum(a[:, 2:], b[:, 2:])
    both = (high - low).clamp(min=0).prod(1)
    union = (a[:, 2:] - a[:, :2]).prod(1) + (b[:, 2:] - b[:, :2]).prod(1) - both
    iou = both / union.clamp(min=1e-6)
    hull = (torch.maximum(a[:, 2:], b[:, 2:]) - torch.minimum(a[:, :2], b[:, :2])).prod(1)
    return iou, iou - (hull - union) / hull.clamp(min=1e-6)


def loss_of(output, boxes, grid, classes):
    """Quality focal loss of the classes (Li et al. 2020) and generalised IoU of the boxes."""
    target, judged = torch.zeros(output.shape[:2] + (classes,)), torch.ones(output.shape[:2])
    corners, pairs = boxes_of(output, grid, classes), []
    for i, rows in enumerate(boxes):
        owner = assign(rows, grid)
        judged[i] = (owner != -2).float()
        found = (owner >= 0).nonzero()[:, 0]
        pairs.append((i, found, rows[owner[found]]))
    predicted = torch.cat([corners[i, cell] for i, cell, _ in pairs])
    wanted = torch.cat([rows for _, _, rows in pairs])
    count = max(1, len(wanted))
    iou, generalised = overlap(predicted, wanted[:, 1:5])
    start = 0
    for i, cell, rows in pairs:
        target[i, cell, rows[:, 0].long()] = iou[start:start + len(cell)].detach().clamp(min=0)
        start += len(cell)
    logits = output[..., :classes]
    weight = (target - logits.sigmoid()).abs().pow(2) * judged[..., None]
    kinds = (weight * F.binary_cross_entropy_with_logits(logits, target, reduction="none")).sum() / count
    return kinds, 2 * (1 - generalised).sum() / count


def copy_weights(model, stored):
    """Weights of an earlier network; classes that are new since then keep their first values."""
    own = model.state_dict()
    for name, value in stored.items():
        if own[name].shape == value.shape:
            own[name].copy_(value)
            continue
        known = len(value) - 4  # rows of the last layer: classes, then the box's four sides
        own[name][:known].copy_(value[:known])
        own[name][-4:].copy_(value[-4:])


def share_of(state, arguments):
    """Of the training that is done."""
    return state["steps"] / arguments.steps if arguments.steps else state["seconds"] / (60 * arguments.minutes)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--views", nargs="+", required=True, help="folders of `roomgraph training-set`")
    parser.add_argument("--check", required=True, help="folder of views that are not trained on")
    parser.add_argument("--out", type=Path, required=True, help="checkpoint.pt, log.jsonl")
    parser.add_argument("--minutes", type=float, default=60, help="of training; the learning rate ends at 0 then")
    parser.add_argument("--steps", type=int, default=0, help="end after so many steps instead, which is the same on every machine")
    parser.add_argument("--batch", type=int, default=16)
    parser.add_argument("--rate", type=float, default=2e-3, help="largest learning rate (AdamW)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--start", type=Path, help="checkpoint whose weights to begin with")
    parser.add_argument("--shrink", type=int, default=1, help="2: train on half the resolution, which is four times as fast")
    parser.add_argument("--threads", type=int, default=2)
    arguments = parser.parse_args()
    torch.set_num_threads(arguments.threads)
    torch.manual_seed(arguments.seed)
    arguments.out.mkdir(parents=True, exist_ok=True)
    # bfloat16 is four times as fast where the processor computes in it.
    half = "avx512_bf16" in Path("/proc/cpuinfo").read_text()
    views, check = data.Views(arguments.views), data.Views([arguments.check])
    classes = len(data.CLASSES)
    model, mean = (RoomDetector(classes).to(memory_format=torch.channels_last) for _ in range(2))
    grid = cells(views.height // arguments.shrink, views.width // arguments.shrink)
    optimizer = torch.optim.AdamW(model.parameters(), lr=arguments.rate, weight_decay=0.02)
    state = {"seconds": 0.0, "steps": 0}
    checkpoint = arguments.out / "checkpoint.pt"
    if checkpoint.exists():
        stored = torch.load(checkpoint)
        model.load_state_dict(stored["model"])
        mean.load_state_dict(stored["mean"])
        optimizer.load_state_dict(stored["optimizer"])
        state = stored["state"]
        print(f"goes on from {state['steps']} steps")
    else:
        if arguments.start:
            copy_weights(model, torch.load(arguments.start)["mean"])
        mean.load_state_dict(model.state_dict())
    parameters = sum(p.numel() for p in model.parameters())
    print(f"{len(views)} views, {len(check)} to check, {parameters} weights", flush=True)
    pairs = list(zip(mean.state_dict().values(), model.state_dict().values()))
    last, shown, sums = time.time(), time.time(), np.zeros(3)
    share = share_of(state, arguments)
    while share < 1:
        random = np.random.default_rng([arguments.seed, state["steps"]])
        pictures, boxes = data.augmented(*data.drawn(views, arguments.batch, random), random)
        pictures, boxes = data.shrunk(pictures, boxes, arguments.shrink)
        rate = arguments.rate * min(1, (state["steps"] + 1) / 200) * (0.5 * (1 + np.cos(np.pi * share)) + 0.002)
        for group in optimizer.param_groups:
            group["lr"] = rate
        model.train()
        with torch.autocast("cpu", dtype=torch.bfloat16, enabled=half):
            output = model(pictures.contiguous(memory_format=torch.channels_last))
        kinds, places = loss_of(output.float(), boxes, grid, classes)
        optimizer.zero_grad()
        (kinds + places).backward()
        torch.nn.utils.clip_grad_norm_(model.parameters(), 10)
        optimizer.step()
        keep = min(0.998, state["steps"] / (state["steps"] + 10))
        with torch.no_grad():
            for old, value in pairs:
                old.mul_(keep).add_(value, alpha=1 - keep) if value.dtype.is_floating_point else old.copy_(value)
        state["steps"] += 1
        sums += (kinds.item(), places.item(), 1)
        state["seconds"] += time.time() - last
        last, share = time.time(), share_of(state, arguments)
        if last - shown > 60 or share >= 1:
            figures = {"steps": state["steps"], "minutes": state["seconds"] / 60, "kinds": sums[0] / sums[2], "places": sums[1] / sums[2]}
            if state["steps"] // 1000 != state.get("checked", 0) or share >= 1:
                state["checked"] = state["steps"] // 1000
                figures.update(evaluate.average_precisions(mean, check, shrink=arguments.shrink))
            with open(arguments.out / "log.jsonl", "a") as log:
                log.write(json.dumps(figures) + "\n")
            print({k: round(v, 3) for k, v in figures.items()}, flush=True)
            torch.save({"model": model.state_dict(), "mean": mean.state_dict(), "optimizer": optimizer.state_dict(), "state": state},
                       checkpoint.with_suffix(".new"))
            checkpoint.with_suffix(".new").replace(checkpoint)
            last = shown = time.time()
            sums[:] = 0


if __name__ == "__main__":
    main()
