# SPDX-License-Identifier: BSD-3-Clause
"""A virtual X display with OpenGL: programs on it, keys and clicks for them, and what is on the screen."""
import os
import pathlib
import struct
import subprocess
import tempfile
import zlib


class Picture:
    """Pixels of a screen, (r, g, b) from the upper left corner."""

    def __init__(self, width, height, rows):
        self.width, self.height, self.rows = width, height, rows

    def at(self, x, y):
        return tuple(self.rows[y][3 * x:3 * x + 3])

    def part(self, x0, y0, x1, y1):
        """The bytes of a rectangle."""
        return b"".join(row[3 * x0:3 * x1] for row in self.rows[y0:y1])

    def near(self, color, within=12, area=None):
        """Pixels of about that colour in the area (x0, y0, x1, y1)."""
        x0, y0, x1, y1 = area or (0, 0, self.width, self.height)
        ranges = [range(max(0, c - within), c + within + 1) for c in color]
        return {(x, y) for y in range(y0, y1) for x in range(x0, x1)
                if all(value in allowed for value, allowed in zip(self.at(x, y), ranges))}

    def save(self, file):
        def chunk(tag, data):
            return struct.pack(">I", len(data)) + tag + data + struct.pack(">I", zlib.crc32(tag + data))
        header = struct.pack(">IIBBBBB", self.width, self.height, 8, 2, 0, 0, 0)
        data = zlib.compress(b"".join(b"\0" + row for row in self.rows))
        pathlib.Path(file).write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", data)
                                       + chunk(b"IEND", b""))


def read_xwd(file):
    """A dump of a screen (X11/XWDFile.h): 32 bits a pixel, blue first."""
    data = pathlib.Path(file).read_bytes()
    header = struct.unpack(">25I", data[:100])
    header_size, width, height, order, bits, line, colors = (header[i] for i in (0, 4, 5, 7, 11, 12, 19))
    if order != 0 or bits != 32:
        raise AssertionError(f"{file}: byte order {order}, {bits} bits a pixel")
    start, rows = header_size + 12 * colors, []
    for y in range(height):
        source, row = data[start + y * line:start + y * line + 4 * width], bytearray(3 * width)
        row[0::3], row[1::3], row[2::3] = source[2::4], source[1::4], source[0::4]
        rows.append(bytes(row))
    return Picture(width, height, rows)


def blobs(pixels, least):
    """Connected sets of at least that many pixels, the largest first."""
    left, found = set(pixels), []
    while left:
        blob, edge = set(), [left.pop()]
        while edge:
            x, y = edge.pop()
            blob.add((x, y))
            for neighbour in ((x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)):
                if neighbour in left:
                    left.remove(neighbour)
                    edge.append(neighbour)
        found.append(blob)
    return sorted((b for b in found if len(b) >= least), key=len, reverse=True)


def center(blob):
    return tuple(sum(p[i] for p in blob) / len(blob) for i in (0, 1))


class Display:
    def __init__(self, width, height):
        self.files = tempfile.TemporaryDirectory()
        read, write = os.pipe()
        command = ["Xvfb", "-displayfd", str(write), "-screen", "0", f"{width}x{height}x24", "-fbdir", self.files.name,
                   "-nolisten", "tcp"]
        try:
            self.server = subprocess.Popen(command, pass_fds=(write,), stderr=subprocess.DEVNULL)
        except FileNotFoundError:
            raise SystemExit("Xvfb is not there: install the packages xvfb and xdotool") from None
        os.close(write)
        with os.fdopen(read) as number:
            name = number.readline().strip()
        self.environment = {**os.environ, "DISPLAY": f":{name}", "LIBGL_ALWAYS_SOFTWARE": "1"}

    def close(self):
        self.server.terminate()
        self.server.wait()
        self.files.cleanup()

    def start(self, words, **more):
        return subprocess.Popen([str(w) for w in words], env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                text=True, **more)

    def xdotool(self, *words):
        return subprocess.run(["xdotool", *map(str, words)], env=self.environment, capture_output=True, text=True, check=False)

    def key(self, *names):
        self.xdotool("key", "--delay", "80", *names)

    def click(self, x, y):
        self.xdotool("mousemove", int(x), int(y), "sleep", "0.15", "mousedown", 1, "sleep", "0.1", "mouseup", 1)

    def drag(self, x0, y0, x1, y1):
        self.xdotool("mousemove", int(x0), int(y0), "sleep", "0.1", "mousedown", 1, "sleep", "0.1", "mousemove", int(x1), int(y1),
                     "sleep", "0.1", "mouseup", 1)

    def picture(self):
        return read_xwd(pathlib.Path(self.files.name) / "Xvfb_screen0")
