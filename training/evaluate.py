# SPDX-License-Identifier: BSD-3-Clause
"""Average precision at IoU .5 on views that were not trained on."""
import numpy as np
import torch

import augment
import data
from network import boxes_of, cells


def detections(output, grid, classes, least=0.05, same=0.5, most=100):
    """(n, 6) of one picture: class, u0, v0, u1, v1, score, after non-maximum suppression per class."""
    scores, kinds = output[:, :classes].sigmoid().max(1)
    kept = (scores > least).nonzero()[:, 0]
    kept = kept[scores[kept].argsort(descending=True)][:most].tolist()
    corners = boxes_of(output, grid, classes)
    out = []
    for i in kept:
        box = corners[i].tolist()
        if all(k != int(kinds[i]) or iou(box, b) < same for k, *b, _ in out):
            out.append([int(kinds[i]), *box, float(scores[i])])
    return out


def iou(a, b):
    width, height = min(a[2], b[2]) - max(a[0], b[0]), min(a[3], b[3]) - max(a[1], b[1])
    both = max(0, width) * max(0, height)
    return both / max(1e-9, (a[2] - a[0]) * (a[3] - a[1]) + (b[2] - b[0]) * (b[3] - b[1]) - both)


def judged(found, truth, kind):
    """(score, right) of the detections of a class in one picture; those on objects that need not be found are left out."""
    rows, taken = [], set()
    for _, u0, v0, u1, v1, score in (f for f in found if f[0] == kind):
        overlaps = [(iou((u0, v0, u1, v1), t[1:5]), j) for j, t in enumerate(truth) if int(t[0]) == kind]
        best, j = max(overlaps, default=(0, -1))
        if best >= 0.5 and j not in taken and truth[j][5] > 0:
            taken.add(j)
            rows.append((score, True))
        elif best < 0.5 or truth[j][5] > 0:
            rows.append((score, False))
    return rows


def average_precision(rows, wanted):
    """Area below the precision envelope over recall (PASCAL VOC 2010)."""
    if not wanted:
        return float("nan")
    rows = sorted(rows, reverse=True)
    right = np.cumsum([r for _, r in rows]) if rows else np.zeros(0)
    precision = right / np.arange(1, len(right) + 1)
    envelope = np.maximum.accumulate(precision[::-1])[::-1]
    recall = np.concatenate([[0], right / wanted])
    return float(np.sum(np.diff(recall) * envelope))


def average_precisions(model, views, batch=32, without=None, shrink=1):
    """{"ap swivel chair": ..., "ap": mean of those that are mapped}; `without`: channels set to 0."""
    model.eval()
    classes, grid = len(data.CLASSES), cells(views.height // shrink, views.width // shrink)
    rows, wanted = [[] for _ in data.CLASSES], np.zeros(classes)
    with torch.no_grad():
        for start in range(0, len(views), batch):
            pictures, boxes = augment.shrunk(*views.batch(range(start, min(len(views), start + batch))), shrink)
            if without is not None:
                pictures[:, without] = 0
            for output, truth in zip(model(pictures).float().cpu(), boxes.cpu().numpy()):
                found, truth = detections(output, grid, classes), truth[truth[:, data.KIND] >= 0]
                for kind in range(classes):
                    rows[kind] += judged(found, truth, kind)
                    wanted[kind] += sum(1 for t in truth if int(t[0]) == kind and t[5] > 0)
    out = {"ap " + name: average_precision(rows[k], wanted[k]) for k, name in enumerate(data.CLASSES)}
    out["ap"] = float(np.nanmean([out["ap " + name] for name in data.CLASSES[:5]]))
    return out
