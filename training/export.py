#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Calibrates the scores on views that were not trained on, and writes the network for OpenCV.

    training/export.py --checkpoint DIR/checkpoint.pt --check DIR --out models/room_detector

The scores' logits are stretched and shifted per class so that they are probabilities (Platt 1999); that becomes part of the
last layer's weights. Writes room_detector.onnx, labels.txt and room_detector.pt (weights to train on from) into the folder.
"""
import argparse
import json
import sys
from pathlib import Path

import numpy as np
import torch

import data
import evaluate
from network import RoomDetector, STRIDES, cells, folded

sys.path.append(str(Path(__file__).resolve().parent.parent / "bench"))
from calibrate_scores import fitted  # noqa: E402  (found by the line above)


def mean_weights(each):
    """Of networks that one began where the other ended (Izmailov et al. 2018); whole numbers are the last one's."""
    return {k: torch.stack([w[k].float() for w in each]).mean(0) if v.dtype.is_floating_point else v for k, v in each[-1].items()}


def calibrated(model, views):
    """The model with calibrated logits, and the reliability table."""
    classes, grid = len(data.CLASSES), cells(views.height, views.width)
    rows = [[] for _ in data.CLASSES]
    with torch.no_grad():
        for start in range(0, len(views), 32):
            pictures, boxes = views.batch(range(start, min(len(views), start + 32)))
            for output, truth in zip(model(pictures), boxes):
                found = evaluate.detections(output, grid, classes)
                for kind in range(classes):
                    rows[kind] += evaluate.judged(found, truth[truth[:, data.KIND] >= 0].numpy(), kind)
    table = {}
    for kind, name in enumerate(data.CLASSES):
        scores = np.clip([s for s, _ in rows[kind]], 1e-9, 1 - 1e-9)
        right = np.array([r for _, r in rows[kind]])
        if len(right) < 20 or right.all() or not right.any():
            continue
        logits = np.log(scores / (1 - scores))
        slope, shift = fitted(scores, right)
        if not slope >= 0.2:
            continue
        for layer in model.output:
            layer.weight.data[kind] *= slope
            layer.bias.data[kind] = layer.bias.data[kind] * slope + shift
        p = 1 / (1 + np.exp(-(slope * logits + shift)))
        table[name] = [[round(float(p[m].mean()), 3), round(float(right[m].mean()), 3), int(m.sum())]
                       for m in (np.floor(p * 5) == k for k in range(5)) if m.any()]
    return model, table


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--checkpoint", type=Path, nargs="+", required=True, help="of several the mean of their weights, as of one training's passes")
    parser.add_argument("--check", nargs="+", required=True, help="folders of views to calibrate with")
    parser.add_argument("--out", type=Path, required=True)
    arguments = parser.parse_args()
    torch.set_num_threads(1)  # it takes a minute; two threads beside other work take far longer
    model = RoomDetector(len(data.CLASSES))
    weights = mean_weights([torch.load(file)["mean"] for file in arguments.checkpoint])
    model.load_state_dict(weights)
    model.eval()
    views = data.Views(arguments.check)
    figures = {"all channels": evaluate.average_precisions(model, views), "without depth": evaluate.average_precisions(model, views, without=data.DEPTH),
               "without colour": evaluate.average_precisions(model, views, without=data.COLOR)}
    model, table = calibrated(model, views)
    arguments.out.mkdir(parents=True, exist_ok=True)
    torch.save({"mean": {k: v.half() if v.dtype.is_floating_point else v for k, v in weights.items()}}, arguments.out / "room_detector.pt")
    (arguments.out / "labels.txt").write_text("\n".join(data.CLASSES) + "\n")
    torch.onnx.export(folded(model), torch.zeros(1, 6, views.height, views.width), str(arguments.out / "room_detector.onnx"),
                      opset_version=11, input_names=["rgbd"], output_names=["cells"])
    print(json.dumps({"figures": figures, "reliability": table}, indent=1))


if __name__ == "__main__":
    main()
