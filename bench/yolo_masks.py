#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Recorded instance masks as detections that roomgraph replays: chairs with the track ids of their source.

    bench/yolo_masks.py $DATA/rgbd/fr3_office_10hz -o chairs.jsonl
    roomgraph run fr3.rawlog -o OUT --set detection.class=RecordedDetector --set detection.file=chairs.jsonl

Reads chair_detections_yolov8x.jsonl and chair_masks/TIMESTAMP_track_NNN.png; only frames with masks are written.
"""
import argparse
import json
from pathlib import Path


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("-o", "--output", type=Path, required=True)
    arguments = parser.parse_args()
    masks = (arguments.folder / "chair_masks").resolve()
    with arguments.output.open("w") as out:
        for line in (arguments.folder / "chair_detections_yolov8x.jsonl").read_text().splitlines():
            record = json.loads(line)
            boxes = []
            for found in record["detections"]:
                mask = masks / f"{record['timestamp']}_track_{found['track_id']:03d}.png"
                if mask.exists():
                    boxes.append({"class": found["label"], "score": found["score"], "track": found["track_id"], "mask": str(mask)})
            if boxes or not record["detections"]:
                out.write(json.dumps({"timestamp": record["timestamp"], "boxes": boxes}) + "\n")


if __name__ == "__main__":
    main()
