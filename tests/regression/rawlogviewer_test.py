#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""RawLogViewer of MRPT in a virtual display: it lists detections and draws the boxes of the one that is clicked.

Usage: rawlogviewer_test.py LIBRARY RAWLOG [PICTURE.png]
RAWLOG has records of the class CObservationDetections with boxes labelled "chair". The screen's memory is searched for
the chairs' colour, which nothing else in the window has. Exit code 77: a program that this needs is not installed.
"""
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import time

CHAIR_BGR = bytes((0, 159, 230))  # of the label "chair" in libs/observations/src/detection_scene.cpp
FEWEST_PIXELS = 40
DISPLAY = f":{200 + os.getpid() % 500}"


def tool(*words):
    return subprocess.run(["xdotool", *map(str, words)], env=os.environ | {"DISPLAY": DISPLAY}, capture_output=True, text=True,
                          check=False).stdout.split()


def wait_for(what, seconds, step=0.5):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if found := what():
            return found
        time.sleep(step)
    return None


def pixels(screen):
    """Width, height and rows of bytes (blue, green, red, unused) of a screen in Xvfb's file, an X window dump."""
    data = screen.read_bytes()
    words = struct.unpack(">25I", data[:100])
    header, width, height, row, colours = words[0], words[4], words[5], words[12], words[19]
    start = header + 12 * colours
    return width, height, [data[start + y * row:start + y * row + 4 * width] for y in range(height)]


def chair_pixels(screen):
    count = 0
    for row in pixels(screen)[2]:
        at = row.find(CHAIR_BGR)
        while at >= 0:
            count += at % 4 == 0
            at = row.find(CHAIR_BGR, at + 1)
    return count


def save_picture(screen, file):
    import cv2  # only for making the picture of the documentation
    import numpy
    width, height, rows = pixels(screen)
    window = numpy.frombuffer(b"".join(rows), numpy.uint8).reshape(height, width, 4)[96:720, :, :3]
    cv2.imwrite(file, window, [cv2.IMWRITE_PNG_COMPRESSION, 9, cv2.IMWRITE_PNG_STRATEGY, 0])


def look(screen):
    """Clicks down the list until boxes are drawn; whether they were."""
    if not wait_for(lambda: tool("search", "--name", "Tip of the Day"), 60):
        return "no window"
    time.sleep(2)
    for window in tool("search", "--name", "Tip of the Day"):
        tool("windowfocus", window, "key", "--window", window, "Escape")  # it is modal
    for window in tool("search", "--name", "RawlogViewer"):
        tool("windowsize", window, 1280, 880)
        tool("windowmove", window, 0, 0)
    time.sleep(3)
    if chair_pixels(screen) >= FEWEST_PIXELS:
        return "the colour of chairs is on the screen before any was chosen"
    for y in range(120, 260, 9):
        tool("mousemove", 180, y, "click", 1)
        if wait_for(lambda: chair_pixels(screen) >= FEWEST_PIXELS, 2):
            return ""
    return "no record in the list shows boxes of chairs"


def main():
    library, rawlog = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    for program in ("Xvfb", "xdotool", "RawLogViewer"):
        if not shutil.which(program):
            print(f"{program} is not installed")
            return 77
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        server = subprocess.Popen(["Xvfb", DISPLAY, "-screen", "0", "1280x900x24", "-fbdir", name], **quiet)
        screen = folder / "Xvfb_screen0"
        viewer = None
        try:
            if not wait_for(screen.exists, 20):
                print("Xvfb does not start")
                return 1
            time.sleep(1)
            viewer = subprocess.Popen(["RawLogViewer", "-l", str(library), rawlog.name], cwd=rawlog.parent,
                                      env=os.environ | {"DISPLAY": DISPLAY, "HOME": name}, **quiet)
            problem = look(screen)
            if len(sys.argv) > 3:
                save_picture(screen, sys.argv[3])
        finally:
            for process in (viewer, server):
                if process:
                    process.terminate()
                    try:
                        process.wait(10)
                    except subprocess.TimeoutExpired:
                        process.kill()
                        process.wait()
    if problem:
        print(problem)
    return 1 if problem else 0


if __name__ == "__main__":
    sys.exit(main())
