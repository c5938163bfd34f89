# SPDX-License-Identifier: BSD-3-Clause
"""Assignment of cells to boxes, and what is minimised."""
import torch
from torch.nn import functional as F

from data import FRONT, KIND, RANGE, SURE, U0, U1, V0, V1
from network import boxes_of, split

RANGES = {8: (0, 48), 16: (32, 112), 32: (80, 1e9)}  # px: largest distance of a side that a level answers for
CENTRE = 1.5  # strides: cells this near the middle of a box answer for it
EXTRA_WEIGHT = 0.3  # of distance and front, beside classes and boxes


def assign(boxes, grid):
    """(B, M, 8) boxes -> (B, cells): the row of the box a cell answers for, -1: none, -2: not judged (it lies in a box that need not be found)."""
    u, v, stride = (grid[None, :, k:k + 1] for k in range(3))
    low, high = (torch.tensor([RANGES[s][k] for s in RANGES], device=grid.device)[(stride / 16).log2().long() + 1] for k in range(2))
    u0, v0, u1, v1, sure = (boxes[:, None, :, k] for k in (U0, V0, U1, V1, SURE))
    known, sure = boxes[:, None, :, KIND] >= 0, sure > 0
    sides = torch.stack([u - u0, v - v0, u1 - u, v1 - v], -1)
    inside, longest = (sides.amin(-1) > 0) & known, sides.amax(-1)
    near = ((u - (u0 + u1) / 2).abs() < CENTRE * stride) & ((v - (v0 + v1) / 2).abs() < CENTRE * stride)
    area = ((u1 - u0) * (v1 - v0)).expand(-1, len(grid), -1)
    cost, row = torch.where(inside & near & sure & (longest >= low) & (longest < high), area, torch.full_like(area, 1e12)).min(2)
    owner = torch.where((inside & ~sure).any(2), -2, -1)
    return torch.where(cost < 1e12, row, owner)


def overlap(a, b):
    """IoU and generalised IoU (Rezatofighi et al. 2019) of boxes, pairwise."""
    low, high = torch.maximum(a[:, :2], b[:, :2]), torch.minimum(a[:, 2:], b[:, 2:])
    both = (high - low).clamp(min=0).prod(1)
    union = (a[:, 2:] - a[:, :2]).prod(1) + (b[:, 2:] - b[:, :2]).prod(1) - both
    iou = both / union.clamp(min=1e-6)
    hull = (torch.maximum(a[:, 2:], b[:, 2:]) - torch.minimum(a[:, :2], b[:, :2])).prod(1)
    return iou, iou - (hull - union) / hull.clamp(min=1e-6)


class Targets:
    """What is wanted of which cells. (It does not need the network's output: a GPU need not wait for that.)"""

    def __init__(self, boxes, grid):
        owner = assign(boxes, grid)
        self.judged = owner != -2
        self.picture, self.cell = (owner >= 0).nonzero(as_tuple=True)
        self.boxes = boxes[self.picture, owner[self.picture, self.cell]]

    def of(self, values):
        """Rows of (B, cells, ...) that answer for a box."""
        return values[self.picture, self.cell]


def loss_of(output, targets, grid, classes):
    """Three sums over what cells answer for, per such cell: quality focal loss of the classes (Li et al. 2020), generalised IoU of the boxes, and the
    error of the distance's logarithm and of the front's direction."""
    logits, _, extras = split(output, classes)
    wanted, extras = targets.boxes, targets.of(extras)
    count = max(1, len(wanted))
    iou, generalised = overlap(targets.of(boxes_of(output, grid, classes)), wanted[:, U0:SURE])
    target = torch.zeros_like(logits)
    target[targets.picture, targets.cell, wanted[:, KIND].long()] = iou.detach().clamp(min=0)
    weight = (target - logits.sigmoid()).abs().pow(2) * targets.judged.unsqueeze(2)
    kinds = (weight * F.binary_cross_entropy_with_logits(logits, target, reduction="none")).sum() / count
    far, front = wanted[:, RANGE], wanted[:, FRONT]
    distance = F.smooth_l1_loss(extras[:, 0], far.clamp(min=0.1).log(), reduction="none", beta=0.1) * (far > 0)
    direction = torch.stack([front.cos(), front.sin()], 1)
    turned = F.smooth_l1_loss(extras[:, 1:], direction.nan_to_num(), reduction="none", beta=0.2).sum(1) * ~front.isnan() * (far > 0)
    return kinds, 2 * (1 - generalised).sum() / count, EXTRA_WEIGHT * (distance + turned).sum() / count
