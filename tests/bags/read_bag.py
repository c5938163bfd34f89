# SPDX-License-Identifier: BSD-3-Clause
"""Reads a bag that roomgraph wrote with Debian's rosbag, and checks it. Exit code 1 names what is wrong.

Usage: read_bag.py recording X.bag | map X.bag FOLDER POSES, FOLDER having map.yaml, map.pgm and landmarks.json of the same map
"""
import importlib
import json
import math
import pathlib
import struct
import sys

import genpy.dynamic
import rosbag

START = 1700000000


def expect(condition, what):
    if not condition:
        sys.exit(f"read_bag.py: {what}")


def check_types(bag):
    """Checksums, and definitions from which the same checksum follows, of each connection."""
    for connection in bag._get_connections():
        package, name = connection.datatype.split("/")
        known = getattr(importlib.import_module(package + ".msg"), name)
        expect(connection.md5sum == known._md5sum, f"{connection.datatype}: checksum")
        made = genpy.dynamic.generate_dynamic(connection.datatype, connection.msg_def)
        expect(made[connection.datatype]._md5sum == known._md5sum, f"{connection.datatype}: definition")


def by_topic(bag):
    """Deserialised messages; also each one alone, found by its time in the index."""
    found = {}
    for topic, message, t in bag.read_messages():
        found.setdefault(topic, []).append(message)
        stamp = getattr(getattr(message, "header", None), "stamp", None)
        if stamp is not None:
            expect(stamp == t, f"{topic}: {stamp} was received at {t}")
            expect(any(True for _ in bag.read_messages(topics=[topic], start_time=t, end_time=t)), f"{topic}: not in the index")
    return found


def check_recording(bag):
    found = by_topic(bag)
    expect(sorted(found) == ["/camera/depth/camera_info", "/camera/depth/image_raw", "/camera/rgb/camera_info", "/camera/rgb/image_raw", "/imu",
                             "/scan", "/tf", "/tf_static"], f"topics {sorted(found)}")
    for topic in found:
        expect(topic.startswith("/tf") or len(found[topic]) == 30, f"{topic}: {len(found[topic])} messages")
    color, depth = found["/camera/rgb/image_raw"][2], found["/camera/depth/image_raw"][2]
    expect(abs(color.header.stamp.to_sec() - START - 0.2) < 1e-6, "time of an image")
    expect((color.width, color.height, color.encoding, color.step) == (16, 12, "bgr8", 48), "head of the colour image")
    at = 5 * color.step + 3 * 9
    expect(tuple(color.data[at:at + 3]) == (99, 35, 90), "pixel of the colour image")
    expect(depth.encoding == "32FC1", "encoding of depth in units of 0.2 mm")
    metres = struct.unpack_from("<f", depth.data, 5 * depth.step + 4 * 9)[0]
    expect(abs(metres - 0.0002 * (5001 + 317 * 9 + 5)) < 1e-6, f"depth {metres}")
    info = found["/camera/rgb/camera_info"][0]
    expect(info.K == (20, 0, 7.5, 0, 21, 5.5, 0, 0, 1) and info.D[3] == 0.002 and info.P[5] == 21, "camera_info")
    scan = found["/scan"][0]
    expect(abs(scan.angle_min - 1.5) < 1e-6 and abs(scan.angle_increment + 0.5) < 1e-6, "angles of a clockwise scan")
    expect(math.isinf(scan.ranges[4]) and abs(scan.ranges[5] - 2.5) < 1e-6, "ranges")
    imu = found["/imu"][3]
    expect(imu.orientation_covariance[0] == -1 and imu.angular_velocity.x == 1.5 and imu.angular_velocity.z == 3, "IMU")
    frames = {link.child_frame_id: link for link in found["/tf_static"][-1].transforms}
    expect(set(frames) == {"HEAD_optical_frame", "HEAD_depth_optical_frame", "rear_link_frame", "IMU_frame"}, f"frames {set(frames)}")
    q = frames["rear_link_frame"].transform.rotation
    expect(abs(abs(q.z) - 1) < 1e-9, "the scanner looks back")


def check_map(bag, folder, poses):
    found = by_topic(bag)
    grid, path, markers = found["/map"][0], found["/path"][0], found["/landmarks"][0].markers
    header, size, _, pixels = (folder / "map.pgm").read_bytes().split(b"\n", 3)
    width, height = map(int, size.split())
    expect((grid.info.width, grid.info.height) == (width, height), "size of the grid")
    yaml = dict(line.split(": ", 1) for line in (folder / "map.yaml").read_text().splitlines() if ": " in line)
    origin = json.loads(yaml["origin"])
    expect(abs(grid.info.origin.position.x - origin[0]) < 1e-5 and abs(grid.info.origin.position.y - origin[1]) < 1e-5, "origin of the grid")
    expect(abs(grid.info.resolution - float(yaml["resolution"])) < 1e-6, "resolution")
    occupied = [(x, y) for y in range(height) for x in range(width) if pixels[(height - 1 - y) * width + x] == 0]
    expect(occupied and all(grid.data[y * width + x] > 50 for x, y in occupied), "occupied cells")
    expect(min(grid.data) == -1, "unknown cells")
    expect(len(path.poses) == poses and len(found["/tf"]) == poses, "poses of the path")
    landmarks = json.loads((folder / "landmarks.json").read_text())["landmarks"]
    expect(landmarks and len(markers) == 2 * len(landmarks), "number of markers")
    for landmark, body, label in zip(landmarks, markers[::2], markers[1::2]):
        width, depth, tall = landmark["size_wdh"]
        expect(body.id == landmark["id"] and body.ns == landmark["class"], "id and class")
        expect(abs(body.pose.position.x - landmark["x"]) < 1e-4 and abs(body.pose.position.z - landmark["z"] - tall / 2) < 1e-4, "place")
        expect(abs(body.scale.x - max(depth, 0.05)) < 1e-4 and abs(body.scale.y - max(width, 0.05)) < 1e-4, "size")
        expect(label.type == label.TEXT_VIEW_FACING and landmark["class"] in label.text, "text")
    expect(all(c.header.get("latching") in (b"1", "1") for c in bag._get_connections() if c.topic != "/tf"), "latching")


if __name__ == "__main__":
    with rosbag.Bag(sys.argv[2]) as opened:
        check_types(opened)
        if sys.argv[1] == "recording":
            check_recording(opened)
        else:
            check_map(opened, pathlib.Path(sys.argv[3]), int(sys.argv[4]))
