#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs in odd surroundings: too few file handles, too little memory, folders that may not be written, a clock that is set
back, a locale with a decimal comma, odd paths, no home, closed streams, a narrow terminal.

Usage: surroundings_test.py PROGRAM RAWLOG CLOCK
RAWLOG: a short recording. CLOCK: a library to be preloaded under which the clock of the day goes back; "" where none can be.
Whatever happens, a run ends with the results of an undisturbed one, or with one line and none.
"""
import fcntl
import os
import pathlib
import pty
import resource
import shutil
import struct
import subprocess
import sys
import tempfile
import termios
import unittest

PROGRAM, RAWLOG, CLOCK = sys.argv[1:4]
del sys.argv[1:4]
SPAN = ("--until", "1", "--no-report", "--no-snapshot")
SAME = ("trajectory.tum", "trajectory_camera.tum", "live.tum", "landmarks.json", "associations.jsonl", "detections.jsonl",
        "map.pgm", "map.yaml", "map.rgmap", "graph.g2o", "config.ini")
# Root may write everywhere, unless it has not this capability.
UNPRIVILEGED = ["setpriv", "--bounding-set=-dac_override,-dac_read_search", "--inh-caps=-all"] if os.geteuid() == 0 else []
CLOSED = ["sh", "-c", 'exec "$@" <&- >&-', "sh"]


def limited(kind, value):
    def limit():
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(kind, (value, value))
    return limit


def contents(folder):
    return {name: (folder / name).read_bytes() for name in SAME}


class Surroundings(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.top = pathlib.Path(cls.scratch.name)
        subprocess.run([PROGRAM, "run", RAWLOG, "-o", str(cls.top / "usual"), "--quiet", *SPAN], check=True, capture_output=True)
        cls.usual = contents(cls.top / "usual")

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def call(self, *words, before=(), **more):
        return subprocess.run([*before, PROGRAM, *map(str, words)], capture_output=True, text=True, check=False, cwd=self.top, **more)

    def run_into(self, name, recording=RAWLOG, **more):
        out = self.top / name
        shutil.rmtree(out, ignore_errors=True)
        return out, self.call("run", recording, "-o", out, "--quiet", *SPAN, **more)

    def assert_one_line(self, done, exit_code, *parts):
        self.assertEqual(done.returncode, exit_code, done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertTrue(done.stderr.startswith("roomgraph: "), done.stderr)
        for part in parts:
            self.assertIn(part, done.stderr)

    def assert_usual(self, out, done):
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(contents(out), self.usual)

    def assert_all_or_nothing(self, kind, values, reasons):
        """Every limit gives the usual results, or one of the reasons and none; both happen. Limits under which
        the libraries of the system cannot be loaded, so that the program never begins, do not count."""
        good = bad = 0
        for value in values:
            if self.call("--version", preexec_fn=limited(kind, value)).returncode != 0:
                continue
            out, done = self.run_into("limited", preexec_fn=limited(kind, value))
            if done.returncode == 0:
                good += 1
                self.assert_usual(out, done)
                continue
            bad += 1
            self.assertIn(done.returncode, (1, 3), (value, done.stderr))
            self.assert_one_line(done, done.returncode)
            self.assertTrue(any(reason in done.stderr for reason in reasons), (value, done.stderr))
            self.assertNotIn("internal error", done.stderr)
            self.assertFalse((out / "trajectory.tum").exists(), value)
        self.assertGreater(good, 0)
        self.assertGreater(bad, 0)

    def test_too_few_file_handles(self):
        self.assert_all_or_nothing(resource.RLIMIT_NOFILE, range(4, 12), ["Too many open files"])

    @unittest.skipIf(CLOCK == "", "sanitizers need more addresses")
    def test_too_little_memory(self):
        self.assert_all_or_nothing(resource.RLIMIT_AS, [mb << 20 for mb in range(360, 440, 8)] + [1 << 30],
                                   ["not enough memory", "no thread can be started", "Cannot allocate memory"])

    @unittest.skipUnless(not UNPRIVILEGED or shutil.which("setpriv"), "root without setpriv")
    def test_folders_that_may_not_be_written(self):
        place = self.top / "read_only"
        place.mkdir()
        place.chmod(0o555)
        world = pathlib.Path(RAWLOG).with_suffix(".json")
        for words in (["run", RAWLOG, "-o", place], ["run", RAWLOG, "-o", place / "out"], ["batch", RAWLOG, "-o", place],
                      ["simulate", world, "-o", place / "world"], ["export", "tum", RAWLOG, "-o", place / "tum"],
                      ["snapshot", self.top / "usual/map.rgmap", "-o", place / "x.png"],
                      ["map", "export", self.top / "usual/map.rgmap", "-o", place / "map"],
                      ["damage", RAWLOG, "-o", place / "x.rawlog", "--drop-lidar", "0:1"],
                      ["report", self.top / "usual", "-o", place / "x.html"],
                      ["optimize", self.top / "usual/graph.g2o", "-o", place / "x.g2o", "--quiet"]):
            self.assert_one_line(self.call(*words, before=UNPRIVILEGED), 1, str(place), "Permission denied")
        self.assertEqual(list(place.iterdir()), [])
        hidden = self.top / "hidden.rawlog"
        shutil.copy(RAWLOG, hidden)
        hidden.chmod(0)
        self.assert_one_line(self.run_into("hidden", hidden, before=UNPRIVILEGED)[1], 3, str(hidden), "Permission denied")

    @unittest.skipIf(CLOCK == "", "sanitizers want to be loaded first")
    def test_a_clock_that_is_set_back(self):
        env = {**os.environ, "LD_PRELOAD": CLOCK}
        look = [sys.executable, "-c", "import time; print(max(-time.time() + t for t in [time.time()] for _ in range(30)))"]
        self.assertGreater(float(subprocess.run(look, env=env, check=True, capture_output=True, text=True).stdout), 3000)
        self.assert_usual(*self.run_into("back", env=env))
        batch = ["batch", RAWLOG, "-o", self.top / "batch"]
        self.assertIn("1 runs done, 0 unchanged", self.call(*batch, env=env).stdout)
        self.assertIn("0 runs done, 1 unchanged", self.call(*batch, env=env).stdout)
        self.assertIn("0 runs done, 1 unchanged", self.call(*batch).stdout)

    @unittest.skipUnless(shutil.which("localedef"), "no localedef (package libc-bin)")
    def test_a_decimal_comma(self):
        place = self.top / "locales"
        place.mkdir()
        made = subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", str(place / "de_DE.UTF-8")], capture_output=True, check=False)
        if made.returncode != 0:
            self.skipTest("no source of the locale de_DE (package locales)")
        env = {**os.environ, "LOCPATH": str(place), "LC_ALL": "de_DE.UTF-8", "LANG": "de_DE.UTF-8"}
        look = [sys.executable, "-c", "import locale; locale.setlocale(locale.LC_ALL, ''); print(locale.str(1.5))"]
        self.assertEqual(subprocess.run(look, env=env, check=True, capture_output=True, text=True).stdout, "1,5\n")
        self.assert_usual(*self.run_into("comma", env=env))
        for words in (["info", RAWLOG], ["map", "info", "usual/map.rgmap"], ["config-reference"],
                      ["evaluate", "trajectory", "usual/trajectory.tum", "usual/live.tum"],
                      ["evaluate", "objects", "usual/landmarks.json", "usual/landmarks.json"],
                      ["optimize", "usual/graph.g2o", "-o", "comma.g2o", "--quiet"]):
            here, usually = self.call(*words, env=env), self.call(*words)
            self.assertEqual((here.returncode, here.stdout, here.stderr), (0, usually.stdout, usually.stderr))

    def test_odd_paths(self):
        place = self.top / "mit Leerzeichen, Größe ☃ 'q\" $x"
        place.mkdir()
        # Results name the recording: its folder is odd here, its own name is below.
        shutil.copy(RAWLOG, place)
        self.assert_usual(*self.run_into(place / "Aus gabe ö", place / pathlib.Path(RAWLOG).name))
        exported = self.call("map", "export", place / "Aus gabe ö" / "map.rgmap", "-o", place / "Karte ü")
        self.assertEqual(exported.returncode, 0, exported.stderr)
        self.assertTrue((place / "Karte ü" / "map.yaml").is_file())
        recording = place / "Raum ä.rawlog"
        shutil.copy(RAWLOG, recording)
        batch = self.call("batch", recording, "-o", place / "Stapel ß")
        self.assertEqual(batch.returncode, 0, batch.stderr)
        self.assertEqual(len(list((place / "Stapel ß" / "runs").iterdir())), 1)
        self.assert_one_line(self.call("run", place / "fehlt é.rawlog", "-o", place / "x"), 3, "fehlt é.rawlog: no such file")

    def test_no_home(self):
        self.assert_usual(*self.run_into("homeless", env={}))
        self.assert_usual(*self.run_into("homeless", env={"HOME": "/nonexistent", "PATH": "/usr/bin:/bin"}))

    def test_closed_streams(self):
        out, done = self.run_into("closed", before=CLOSED)
        self.assert_usual(out, done)
        self.assertEqual(done.stdout + done.stderr, "")
        batch = self.call("batch", RAWLOG, "-o", self.top / "closed_batch", "--quiet", before=CLOSED)
        self.assertEqual((batch.returncode, batch.stderr), (0, ""))

    def lines_on_terminal(self, columns, *words):
        """What a terminal of that width gets, cut where a line begins anew or goes up."""
        outer, inner = pty.openpty()
        fcntl.ioctl(inner, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
        child = subprocess.Popen([PROGRAM, *map(str, words)], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=inner)
        os.close(inner)
        said = b""
        try:
            while chunk := os.read(outer, 4096):
                said += chunk
        except OSError:  # the other side is closed
            pass
        os.close(outer)
        self.assertEqual(child.wait(), 0, said)
        return said.decode().replace("\r\n", "\n").replace("\r", "\n").split("\n")

    def test_a_narrow_terminal(self):
        slow = ("--no-report", "--no-snapshot")
        lines = [line for line in self.lines_on_terminal(20, "run", RAWLOG, "-o", self.top / "narrow", *slow) if line.strip()]
        self.assertTrue(any(line.startswith("replay ") for line in lines), lines)
        self.assertLess(max(map(len, lines)), 20, "what fills the last column goes on in the next row")
        wide = self.lines_on_terminal(120, "run", RAWLOG, "-o", self.top / "narrow", *slow)
        self.assertGreater(max(map(len, wide)), 20)


if __name__ == "__main__":
    unittest.main()
