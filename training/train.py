#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Trains the room detector for a given time, on the CPU or a GPU; resumes from its own checkpoint.

    training/train.py --views DIR/... --check DIR --out DIR --minutes 60
"""
import argparse
import json
import math
import time
from pathlib import Path

import numpy as np
import torch

import augment
import data
import evaluate
from losses import Targets, loss_of
from network import RoomDetector, cells

LOSSES = ("kinds", "places", "extras")


def parsed():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--views", nargs="+", required=True, help="folders of `roomgraph training-set`, or patterns; such as are finished meanwhile are taken, too")
    parser.add_argument("--check", help="folder of views that are not trained on: average precision every 1000 steps and in the end")
    parser.add_argument("--out", type=Path, required=True, help="checkpoint.pt, log.jsonl")
    parser.add_argument("--minutes", type=float, default=60, help="of training; the learning rate ends at 0 then")
    parser.add_argument("--steps", type=int, default=0, help="end after so many steps instead, which is the same on every machine")
    parser.add_argument("--batch", type=int, default=16)
    parser.add_argument("--rate", type=float, default=2e-3, help="largest learning rate (AdamW)")
    parser.add_argument("--decay", type=float, default=0.02, help="of the weights")
    parser.add_argument("--memory", type=float, default=0.998, help="of the mean of the weights over steps, which is what is shipped")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--textures", type=float, default=0, help="share of the pictures that get other colours and textures")
    parser.add_argument("--floors", type=float, default=0, help="share of the pictures in which something higher is taken for the floor")
    parser.add_argument("--start", type=Path, help="checkpoint whose weights to begin with")
    parser.add_argument("--shrink", type=int, default=1, help="2: train on half the resolution, which is four times as fast")
    parser.add_argument("--device", default="cpu", help="cpu or cuda")
    parser.add_argument("--threads", type=int, default=2)
    return parser.parse_args()


def computes_in_bfloat16(device):
    """It is four times as fast where the processor does, too."""
    return device != "cpu" or "avx512_bf16" in Path("/proc/cpuinfo").read_text()


class Training:
    """The network, the mean of its weights over steps, the optimizer, and how far they are."""

    def __init__(self, arguments):
        self.arguments, self.device = arguments, arguments.device
        self.model, self.mean = (RoomDetector(len(data.CLASSES)).to(self.device, memory_format=torch.channels_last) for _ in range(2))
        self.half = computes_in_bfloat16(self.device)
        self.optimizer = torch.optim.AdamW(self.model.parameters(), lr=arguments.rate, weight_decay=arguments.decay)
        self.state = {"seconds": 0.0, "steps": 0}
        self.checkpoint = arguments.out / "checkpoint.pt"
        if self.checkpoint.exists():
            self._resume()
        else:
            if arguments.start:
                self.model.load_state_dict(torch.load(arguments.start, map_location=self.device)["mean"])
            self.mean.load_state_dict(self.model.state_dict())
        values = list(zip(self.mean.state_dict().values(), self.model.state_dict().values()))
        self.averaged = [list(pair) for pair in zip(*(p for p in values if p[0].dtype.is_floating_point))]
        self.counted = [p for p in values if not p[0].dtype.is_floating_point]

    def _resume(self):
        stored = torch.load(self.checkpoint, map_location=self.device)
        self.model.load_state_dict(stored["model"])
        self.mean.load_state_dict(stored["mean"])
        self.optimizer.load_state_dict(stored["optimizer"])
        self.state = stored["state"]
        print(f"goes on from {self.state['steps']} steps")

    def share(self):
        """Of the training that is done."""
        if self.arguments.steps:
            return self.state["steps"] / self.arguments.steps
        return self.state["seconds"] / (60 * self.arguments.minutes)

    def step(self, pictures, boxes, grid):
        """One step down the losses of a batch, which are returned."""
        rate = self.arguments.rate * min(1, (self.state["steps"] + 1) / 200) * (0.5 * (1 + math.cos(math.pi * min(1, self.share()))) + 0.002)
        for group in self.optimizer.param_groups:
            group["lr"] = rate
        self.model.train()
        targets = Targets(boxes, grid)
        with torch.autocast(torch.device(self.device).type, dtype=torch.bfloat16, enabled=self.half):
            output = self.model(pictures.contiguous(memory_format=torch.channels_last))
        losses = loss_of(output.float(), targets, grid, len(data.CLASSES))
        self.optimizer.zero_grad(set_to_none=True)
        sum(losses).backward()
        torch.nn.utils.clip_grad_norm_(self.model.parameters(), 10)
        self.optimizer.step()
        keep = min(self.arguments.memory, self.state["steps"] / (self.state["steps"] + 10))
        with torch.no_grad():
            torch._foreach_mul_(self.averaged[0], keep)
            torch._foreach_add_(self.averaged[0], self.averaged[1], alpha=1 - keep)
            for old, value in self.counted:
                old.copy_(value)
        self.state["steps"] += 1
        return torch.stack([loss.detach() for loss in losses])

    def save(self):
        stored = {"model": self.model.state_dict(), "mean": self.mean.state_dict(), "optimizer": self.optimizer.state_dict(), "state": self.state}
        torch.save(stored, self.checkpoint.with_suffix(".new"))
        self.checkpoint.with_suffix(".new").replace(self.checkpoint)


def report(training, sums, count, views, check):
    """Appends to the log what has been reached; average precision now and then."""
    state = training.state
    figures = {"steps": state["steps"], "minutes": state["seconds"] / 60, "views": len(views)}
    figures.update({name: value / count for name, value in zip(LOSSES, sums.tolist())})
    if check and (state["steps"] // 1000 != state.get("checked", 0) or training.share() >= 1):
        state["checked"] = state["steps"] // 1000
        figures.update(evaluate.average_precisions(training.mean, check, shrink=training.arguments.shrink))
    with open(training.arguments.out / "log.jsonl", "a") as log:
        log.write(json.dumps(figures) + "\n")
    print({name: round(value, 3) for name, value in figures.items()}, flush=True)
    training.save()


def main():
    arguments = parsed()
    torch.set_num_threads(arguments.threads)
    torch.manual_seed(arguments.seed)
    torch.backends.cudnn.benchmark = True
    arguments.out.mkdir(parents=True, exist_ok=True)
    views = data.Views(arguments.views, arguments.device)
    check = data.Views([arguments.check], arguments.device) if arguments.check else None
    training = Training(arguments)
    grid = cells(views.height // arguments.shrink, views.width // arguments.shrink).to(arguments.device)
    weights = sum(p.numel() for p in training.model.parameters())
    print(f"{len(views)} views, {len(check) if check else 0} to check, {weights} weights", flush=True)
    state, last = training.state, time.time()
    looked = shown = last
    sums, count = torch.zeros(len(LOSSES), device=arguments.device), 0
    while training.share() < 1:
        if last - looked > 5:
            views.refresh()
            looked = time.time()
        random = np.random.default_rng([arguments.seed, state["steps"]])
        pictures, boxes = augment.augmented(*augment.drawn(views, arguments.batch, random), random, arguments.textures, arguments.floors)
        sums += training.step(*augment.shrunk(pictures, boxes, arguments.shrink), grid)
        count += 1
        state["seconds"] += time.time() - last
        last = time.time()
        if last - shown > 60 or training.share() >= 1:
            report(training, sums, count, views, check)
            sums.zero_()
            count, last = 0, time.time()
            looked = shown = last


if __name__ == "__main__":
    main()
