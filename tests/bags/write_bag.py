# SPDX-License-Identifier: BSD-3-Clause
"""Writes a test bag of ROS 1 with Debian's rosbag, or of ROS 2 by the documented layout of SQLite file and CDR.

Usage: write_bag.py OUT JSON, where JSON chooses what it holds (bag_content.py) and how it is written: "compression" (none, bz2, lz4)
of ROS 1; "ros2": "<" or ">" (byte order of CDR), with "index": false the table has no index on time.
"""
import importlib
import json
import pathlib
import sqlite3
import struct
import sys

import bag_content


def fill(message, fields):
    """A generated message of rospy from nested dictionaries."""
    for name, value in fields.items():
        member = getattr(message, name)
        if hasattr(member, "secs"):
            member.secs, member.nsecs = value["secs"], value["nsecs"]
        elif isinstance(value, dict):
            fill(member, value)
        elif name == "transforms":
            from geometry_msgs.msg import TransformStamped
            for entry in value:
                one = TransformStamped()
                fill(one, entry)
                member.append(one)
        else:
            setattr(message, name, value)
    return message


def write_ros1(out, options, compression):
    import genpy
    import rosbag
    with rosbag.Bag(out, "w", compression=compression, chunk_threshold=20000) as bag:
        for topic, kind, t, fields in bag_content.messages(options):
            package, name = kind.split("/")
            message = fill(getattr(importlib.import_module(package + ".msg"), name)(), fields)
            bag.write(topic, message, genpy.Time(t // 10**9, t % 10**9))


class Cdr:
    """XCDR1 behind its encapsulation header: numbers aligned to their size, counted from behind the header."""

    def __init__(self, order):
        self.order, self.bytes = order, bytearray()

    def put(self, code, *values):
        for value in values:
            size = struct.calcsize("=" + code)
            self.bytes += bytes(-len(self.bytes) % size)
            self.bytes += struct.pack(self.order + code, value)

    def text(self, text):
        data = text.encode() + b"\0"
        self.put("I", len(data))
        self.bytes += data

    def sequence(self, code, values):
        self.put("I", len(values))
        if code == "B":
            self.bytes += bytes(values)
        elif len(values):
            self.put(code, *values)

    def header(self, h):
        self.put("i", h["stamp"]["secs"])
        self.put("I", h["stamp"]["nsecs"])
        self.text(h["frame_id"])

    def all(self, fields, names):
        for name in names:
            self.put("d", fields[name])

    def pose(self, p):
        self.all(p["position"], "xyz")
        self.all(p["orientation"], "xyzw")

    def message(self):
        return bytes([0, 1 if self.order == "<" else 0, 0, 0]) + bytes(self.bytes)


def cdr_of(kind, m, order):
    out = Cdr(order)
    if kind == "tf2_msgs/TFMessage":
        out.put("I", len(m["transforms"]))
        for link in m["transforms"]:
            out.header(link["header"])
            out.text(link["child_frame_id"])
            out.all(link["transform"]["translation"], "xyz")
            out.all(link["transform"]["rotation"], "xyzw")
        return out.message()
    if kind == "std_msgs/String":
        out.text(m["data"])
        return out.message()
    out.header(m["header"])
    if kind == "sensor_msgs/Image":
        out.put("I", m["height"], m["width"])
        out.text(m["encoding"])
        out.put("B", m["is_bigendian"])
        out.put("I", m["step"])
        out.sequence("B", m["data"])
    elif kind == "sensor_msgs/CompressedImage":
        out.text(m["format"])
        out.sequence("B", m["data"])
    elif kind == "sensor_msgs/CameraInfo":
        out.put("I", m["height"], m["width"])
        out.text(m["distortion_model"])
        out.sequence("d", m["D"])
        out.put("d", *m["K"], *m["R"], *m["P"])
        out.put("I", 0, 0, 0, 0, 0, 0)
        out.put("B", 0)
    elif kind == "sensor_msgs/LaserScan":
        out.put("f", *(m[n] for n in ("angle_min", "angle_max", "angle_increment", "time_increment", "scan_time", "range_min", "range_max")))
        out.sequence("f", m["ranges"])
        out.sequence("f", m["intensities"])
    elif kind == "nav_msgs/Odometry":
        out.text(m["child_frame_id"])
        out.pose(m["pose"]["pose"])
        out.put("d", *m["pose"]["covariance"])
        out.all(m["twist"]["twist"]["linear"], "xyz")
        out.all(m["twist"]["twist"]["angular"], "xyz")
        out.put("d", *m["twist"]["covariance"])
    elif kind == "sensor_msgs/Imu":
        out.all(m["orientation"], "xyzw")
        out.put("d", *m["orientation_covariance"])
        out.all(m["angular_velocity"], "xyz")
        out.put("d", *m["angular_velocity_covariance"])
        out.all(m["linear_acceleration"], "xyz")
        out.put("d", *m["linear_acceleration_covariance"])
    elif kind == "geometry_msgs/PoseStamped":
        out.pose(m["pose"])
    else:
        raise SystemExit(f"no CDR for {kind}")
    return out.message()


def write_ros2(out, options, order, index):
    pathlib.Path(out).unlink(missing_ok=True)
    database = sqlite3.connect(out)
    database.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,"
                     " serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)")
    database.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, data BLOB NOT NULL)")
    if index:
        database.execute("CREATE INDEX timestamp_idx ON messages (timestamp ASC)")
    ids = {}
    for topic, kind, t, fields in bag_content.messages(options):
        if topic not in ids:
            ids[topic] = len(ids) + 1
            package, name = kind.split("/")
            database.execute("INSERT INTO topics VALUES (?, ?, ?, 'cdr', '')", (ids[topic], topic, f"{package}/msg/{name}"))
        database.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)", (ids[topic], t, cdr_of(kind, fields, order)))
    database.commit()
    database.close()


if __name__ == "__main__":
    chosen = json.loads(sys.argv[2])
    ros2, compression, indexed = chosen.pop("ros2", None), chosen.pop("compression", "none"), chosen.pop("index", True)
    if ros2:
        write_ros2(sys.argv[1], chosen, ros2, indexed)
    else:
        write_ros1(sys.argv[1], chosen, compression)
