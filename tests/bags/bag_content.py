# SPDX-License-Identifier: BSD-3-Clause
"""What the test bags hold, as (topic, type, time of reception in ns, fields): a robot that drives straight ahead for two seconds.

The fields are nested dictionaries and lists named as in the message definitions; a writer for ROS 1 and one for ROS 2 make the same
records of them, so the C++ tests expect the same of both.
"""
import math
import struct
import zlib

START = 1_700_000_000_000_000_000
WIDTH, HEIGHT = 16, 12
FRAMES = 20  # at 10 Hz
DEFAULTS = {"color": "rgb8", "depth": "16UC1", "info": True, "tf": True, "truth": "tf", "depth_delay": 0.0, "scan_offset": 0.0,
            "stamps": True, "extrinsics": "static", "odometry": True, "scan": True, "big_endian_depth": False, "seconds": FRAMES / 10,
            "depth_frame": "camera_rgb_optical_frame", "depth_focal": 20.0, "model": "plumb_bob", "distortion": [0.0] * 5,
            "depth_every": 1, "small_depth_at": -1, "info_change": {}, "odometry_child": "base_footprint", "bad_transform": False, "back": 0.0, "back_received": True}
# x right, y down, z forward, seen from x forward, y left, z up.
OPTICAL = {"x": -0.5, "y": 0.5, "z": -0.5, "w": 0.5}
UNIT = {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}
QUARTER_TURN = {"x": 0.0, "y": 0.0, "z": math.sqrt(0.5), "w": math.sqrt(0.5)}  # to the left
SET_BACK = START + 1_010_000_000  # between two frames; what was measured in the first of them is received behind it


def stamp(t_ns):
    return {"secs": t_ns // 10**9, "nsecs": t_ns % 10**9}


def header(t_ns, frame, options=DEFAULTS):
    return {"seq": 0, "stamp": stamp(t_ns if options["stamps"] else 0), "frame_id": frame}


def png(rows, bits, channels):
    """A PNG of rows of sample values; of 16 bit grey or 8 bit colour."""
    colour = {1: 0, 3: 2}[channels]
    raw = b"".join(b"\0" + b"".join(struct.pack(">H" if bits == 16 else "B", v) for v in row) for row in rows)
    width = len(rows[0]) // channels

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, len(rows), bits, colour, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b""))


def rgb(u, v, k):
    return 200, 100 + u, 20 + v


def millimetres(u, v, k):
    return 0 if u == 0 and v == 0 else 1000 + 10 * u + k


def color_message(k, t, options):
    head = header(t, "camera_rgb_optical_frame", options)
    encoding = options["color"]
    pixels = [[rgb(u, v, k) for u in range(WIDTH)] for v in range(HEIGHT)]
    if encoding == "png":
        data = png([[c for p in row for c in p] for row in pixels], 8, 3)
        return "/camera/rgb/image_raw/compressed", "sensor_msgs/CompressedImage", {"header": head, "format": "rgb8; png compressed bgr8", "data": data}
    make = {"rgb8": lambda p: bytes(p), "bgr8": lambda p: bytes(p[::-1]), "rgba8": lambda p: bytes(p) + b"\xff",
            "mono8": lambda p: bytes(p[1:2]), "martian8": lambda p: bytes(p)}[encoding]
    rows = [b"".join(make(p) for p in row) + b"\0\0" for row in pixels]  # rows may be padded
    return "/camera/rgb/image_raw", "sensor_msgs/Image", {
        "header": head, "height": HEIGHT, "width": WIDTH, "encoding": encoding, "is_bigendian": 0, "step": len(rows[0]), "data": b"".join(rows)}


def rvl(values):
    """Runs of zeros, then of values as differences; both in nibbles, 32 bits at a time."""
    nibbles = []

    def emit(number):
        while True:
            number, low = number >> 3, number & 7
            nibbles.append(low | (8 if number else 0))
            if not number:
                return

    at, previous = 0, 0
    while at < len(values):
        start = at
        while at < len(values) and values[at] == 0:
            at += 1
        emit(at - start)
        start = at
        while at < len(values) and values[at] != 0:
            at += 1
        emit(at - start)
        for value in values[start:at]:
            delta = value - previous
            emit((delta << 1) ^ (delta >> 31))
            previous = value
    nibbles += [0] * (-len(nibbles) % 8)
    words = [sum(n << (28 - 4 * i) for i, n in enumerate(nibbles[j:j + 8])) for j in range(0, len(nibbles), 8)]
    return b"".join(struct.pack("<I", word & 0xffffffff) for word in words)


def depth_message(k, t, options):
    kind, every = options["depth"], 2 if k == options["small_depth_at"] else options["depth_every"]
    head = header(t, options["depth_frame"], options)
    rows = [[millimetres(u, v, k) for u in range(0, WIDTH, every)] for v in range(0, HEIGHT, every)]
    topic = "/camera/depth/image_raw"
    if kind == "compressedDepth":
        data = struct.pack("<Iff", 0, 0, 0) + png(rows, 16, 1)
        return topic + "/compressedDepth", "sensor_msgs/CompressedImage", {"header": head, "format": "16UC1; compressedDepth png", "data": data}
    if kind == "rvl":
        data = struct.pack("<IffII", 0, 0, 0, WIDTH, HEIGHT) + rvl([v for row in rows for v in row])
        return topic + "/compressedDepth", "sensor_msgs/CompressedImage", {"header": head, "format": "16UC1; compressedDepth rvl", "data": data}
    if kind == "compressedDepth32":  # value = a / metres + b
        a, b = 5000.0, 100.0
        stored = [[0 if mm == 0 else round(a / (mm / 1000) + b) for mm in row] for row in rows]
        data = struct.pack("<Iff", 0, a, b) + png(stored, 16, 1)
        return topic + "/compressedDepth", "sensor_msgs/CompressedImage", {"header": head, "format": "32FC1; compressedDepth png", "data": data}
    order = ">" if options["big_endian_depth"] else "<"
    if kind == "32FC1":
        data = b"".join(struct.pack(order + "f", mm / 1000 if mm else math.nan) for row in rows for mm in row)
    else:
        data = b"".join(struct.pack(order + "H", mm) for row in rows for mm in row)
    return topic, "sensor_msgs/Image", {"header": head, "height": len(rows), "width": len(rows[0]), "encoding": kind,
                                        "is_bigendian": int(options["big_endian_depth"]), "step": len(data) // len(rows), "data": data}


def info_message(t, frame, focal, options):
    k = [focal, 0.0, 7.5, 0.0, focal, 5.5, 0.0, 0.0, 1.0]
    return {"header": header(t, frame, options), "height": HEIGHT, "width": WIDTH, "distortion_model": options["model"],
            "D": options["distortion"], "K": k, "R": [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
            "P": [focal, 0.0, 7.5, 0.0, 0.0, focal, 5.5, 0.0, 0.0, 0.0, 1.0, 0.0], "binning_x": 0, "binning_y": 0,
            "roi": {"x_offset": 0, "y_offset": 0, "height": 0, "width": 0, "do_rectify": False}, **options["info_change"]}


def transform(t, parent, child, xyz, q=UNIT):
    return {"header": {"seq": 0, "stamp": stamp(t), "frame_id": parent}, "child_frame_id": child,
            "transform": {"translation": dict(zip("xyz", xyz)), "rotation": q}}


def sensor_transforms(t, options):
    tilt = math.radians(10) if options["extrinsics"] == "moving" and t >= START + 10**9 else 0.0
    down = {"x": 0.0, "y": math.sin(tilt / 2), "z": 0.0, "w": math.cos(tilt / 2)}
    links = [transform(t, "base_footprint", "base_link", (0.0, 0.0, 0.1)),
             transform(t, "/base_link", "/camera_link", (0.2, 0.0, 0.7), down),
             transform(t, "camera_link", "camera_rgb_optical_frame", (0.0, 0.0, 0.0), OPTICAL),
             # Turned by a quarter to the left.
             transform(t, "base_link", "laser_link", (0.1, 0.0, 0.15), {"x": 0.0, "y": 0.0, "z": math.sqrt(0.5), "w": math.sqrt(0.5)})]
    if options["odometry_child"] == "side":
        links.append(transform(t, "base_link", "side", (-0.2, 0.0, 0.3), QUARTER_TURN))
    if options["bad_transform"]:
        links.insert(1, transform(t, "base_link", "gps", (0.0, 0.0, 1.0), {"x": 0.0, "y": 0.0, "z": 0.0, "w": 0.0}))
    if options["depth_frame"] == "camera_depth_optical_frame":
        links.append(transform(t, "camera_link", "camera_depth_optical_frame", (0.0, 0.025, 0.0), OPTICAL))
    return links


def position(t):
    return 0.5 * (t - START) * 1e-9


def scan_message(t, options):
    ranges = [math.inf, 0.05, 20.0] + [1.0 + 0.1 * i for i in range(3, 9)]
    return {"header": header(t + int(options["scan_offset"] * 1e9), "laser_link", options), "angle_min": -0.5, "angle_max": 1.5,
            "angle_increment": 0.25, "time_increment": 0.002, "scan_time": 0.1, "range_min": 0.1, "range_max": 8.0,
            "ranges": ranges, "intensities": [float(10 * i) for i in range(9)]}


def twist(v, left=0.0):
    return {"linear": {"x": v, "y": left, "z": 0.0}, "angular": {"x": 0.0, "y": 0.0, "z": 0.0}}


def pose(x):
    return {"position": {"x": x, "y": 0.0, "z": 0.0}, "orientation": UNIT}


def odometry_message(t, frame, x, options):
    side = options["odometry_child"] == "side"
    here = {"position": {"x": x - 0.2, "y": 0.0, "z": 0.4}, "orientation": QUARTER_TURN} if side else pose(x)
    return {"header": header(t, frame, options), "child_frame_id": options["odometry_child"],
            "pose": {"pose": here, "covariance": [0.0] * 36}, "twist": {"twist": twist(0.0, -0.5) if side else twist(0.5), "covariance": [0.0] * 36}}


def moving(k, t, options):
    """What comes with frame k, without the images."""
    x = position(t)
    if options["odometry"]:
        yield "/odom", "nav_msgs/Odometry", t, odometry_message(t, "odom", x, options)
    if options["scan"]:
        yield "/scan", "sensor_msgs/LaserScan", t + 20_000_000, scan_message(t, options)
    yield "/imu/data", "sensor_msgs/Imu", t, {
        "header": header(t, "base_link", options), "orientation": UNIT, "orientation_covariance": [-1.0] + [0.0] * 8,
        "angular_velocity": {"x": 0.1, "y": 0.2, "z": 0.3}, "angular_velocity_covariance": [0.0] * 9,
        "linear_acceleration": {"x": 1.0, "y": 2.0, "z": 9.8}, "linear_acceleration_covariance": [0.0] * 9}
    if options["truth"] == "odometry":
        yield "/mocap/odom", "nav_msgs/Odometry", t, odometry_message(t, "world", 1 + x, options)
    if options["truth"] == "topic":
        yield "/mocap/robot/pose", "geometry_msgs/PoseStamped", t, {"header": header(t, "world", options), "pose": pose(1 + x)}


def transforms(k, t, options):
    if not options["tf"]:
        return
    links = [transform(t, "odom", "base_footprint", (position(t), 0.0, 0.0))]
    if options["truth"] == "tf":  # odometry drifts against it
        links.append(transform(t, "mocap", "odom", (1.0 + 0.01 * k, 0.0, 0.0)))
    if options["extrinsics"] != "static":
        links += sensor_transforms(t, options)
    yield "/tf", "tf2_msgs/TFMessage", t, {"transforms": links}


def with_stamps(fields, change):
    """A message whose stamps, in ns, are changed."""
    if isinstance(fields, list):
        return [with_stamps(entry, change) for entry in fields]
    if not isinstance(fields, dict):
        return fields
    if set(fields) == {"secs", "nsecs"}:
        return stamp(change(fields["secs"] * 10**9 + fields["nsecs"]))
    return {name: with_stamps(value, change) for name, value in fields.items()}


def messages(choice):
    """All messages in the order of reception."""
    unknown = set(choice) - set(DEFAULTS)
    if unknown:
        raise SystemExit(f"unknown options: {unknown}")
    options = {**DEFAULTS, **choice}
    back = int(options["back"] * 1e9)

    def change(t):
        return t - back if t >= SET_BACK else t

    for topic, kind, t, fields in straight(options):
        received = change(t) if options["back_received"] else t
        yield topic, kind, received, with_stamps(fields, change) if back else fields


def straight(options):
    """The same, on clocks that nobody sets back."""
    if options["tf"] and options["extrinsics"] == "static":
        yield "/tf_static", "tf2_msgs/TFMessage", START, {"transforms": sensor_transforms(START, options)}
    yield "/rosout", "std_msgs/String", START, {"data": "not imported"}
    for k in range(round(options["seconds"] * 10)):
        t = START + k * 100_000_000
        yield from transforms(k, t, options)
        yield from moving(k, t, options)
        if options["color"]:
            topic, kind, fields = color_message(k, t, options)
            yield topic, kind, t + 30_000_000, fields
            if options["info"]:
                yield "/camera/rgb/camera_info", "sensor_msgs/CameraInfo", t + 30_000_000, info_message(t, "camera_rgb_optical_frame", 20.0, options)
        if options["depth"]:
            late = t + int(options["depth_delay"] * 1e9)
            topic, kind, fields = depth_message(k, late, options)
            yield topic, kind, t + 40_000_000, fields
            if options["info"]:
                yield "/camera/depth/camera_info", "sensor_msgs/CameraInfo", t + 40_000_000, info_message(late, options["depth_frame"], options["depth_focal"], options)
