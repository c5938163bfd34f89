#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What bench/faults_files.py says of folders and processes after a signal or on a full disk.

Usage: faults_test.py BENCH_FOLDER
"""
import json
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import unittest

BENCH = sys.argv.pop(1)
sys.path.insert(0, BENCH)
import faults_files  # noqa: E402  (in that folder)


class Verdict(unittest.TestCase):
    OLD = {"a": b"1", "b": b"1", "summary.json": b"old", "same": b"x"}
    NEW = {"a": b"2", "b": b"2", "summary.json": b"new", "same": b"x", "c": b"2"}

    def test_old_new_and_some_of_each(self):
        def said(after, exact=True):
            return faults_files.verdict(self.OLD, after, self.NEW, exact)
        self.assertEqual(said(dict(self.OLD)), "old")
        self.assertEqual(said(dict(self.NEW)), "new")
        self.assertEqual(said(self.NEW | {"summary.json": b"newer"}), "new")  # differs each time
        self.assertEqual(said(self.NEW | {"a": b"1"}), "mixture")
        self.assertEqual(said(self.OLD | {"c": b"2"}), "mixture")
        self.assertEqual(said(self.NEW | {"a": b"3"}), "mixture")
        self.assertEqual(said(self.NEW | {"a": b"3"}, exact=False), "new")
        self.assertEqual(said({}), "mixture")


class Words(unittest.TestCase):
    def test_a_good_end_an_interruption_and_a_signal_are_right(self):
        for code in 0, 4, -2, -15:
            self.assertEqual(faults_files.words_of(code, "roomgraph: interrupted", False), [])
        self.assertEqual(faults_files.words_of(3, "", True), ["exit code 3"])
        self.assertEqual(faults_files.words_of(1, "internal error: x", True), ["internal error", "exit code 1"])
        self.assertEqual(faults_files.words_of(-15, "", True), ["ended at once"])  # with a handler for it


class Signals(unittest.TestCase):
    def test_what_nohup_ignores_reaches_the_programs(self):
        script = ("import signal, subprocess, sys; sys.path.insert(0, sys.argv[1]); import faults_files as f;"
                  "signal.signal(signal.SIGHUP, signal.SIG_IGN); heeded = sys.argv[2] == 'yes';"
                  "f.heed([signal.SIGHUP, signal.SIGKILL]) if heeded else None;"
                  "c = subprocess.Popen(['sleep', '1']); c.send_signal(signal.SIGHUP); print(c.wait())")
        for heeded, code in (("yes", "-1"), ("no", "0")):
            done = subprocess.run([sys.executable, "-c", script, str(BENCH), heeded], capture_output=True, text=True, check=True)
            self.assertEqual(done.stdout.strip(), code)


class Handlers(unittest.TestCase):
    def test_a_process_with_a_handler_is_told_from_one_without(self):
        script = "import signal, time; signal.signal(signal.SIGTERM, lambda *_: None); print('ready', flush=True); time.sleep(30)"
        child = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True)
        try:
            child.stdout.readline()
            self.assertTrue(faults_files.catches(child.pid, signal.SIGTERM))
            self.assertFalse(faults_files.catches(child.pid, signal.SIGHUP))
        finally:
            child.kill()
            child.communicate()
        self.assertFalse(faults_files.catches(child.pid, signal.SIGTERM))

    def test_the_signal_is_sent_once_it_is_heeded(self):
        script = "import signal, sys, time; time.sleep(0.3); signal.signal(signal.SIGTERM, lambda *_: sys.exit(7)); time.sleep(30)"

        class Always(random.Random):
            def random(self):
                return 0.0
        child = subprocess.Popen([sys.executable, "-c", script])
        self.assertTrue(faults_files.send_at_random(child, signal.SIGTERM, 0, Always()))
        self.assertEqual(child.wait(), 7)


class Batch(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name).resolve()

    def run_folder(self, name, status, program="p", bits=b"1"):
        run = self.folder / "runs" / name
        run.mkdir(parents=True)
        (run / "result.json").write_text(json.dumps({"status": status, "program": program}))
        (run / "live.tum").write_bytes(bits)

    def test_complete_runs_alone_are_read(self):
        self.run_folder("a", "complete")
        self.run_folder("b", "failed")
        (self.folder / "runs" / "c").mkdir()
        self.assertEqual(faults_files.runs_in(self.folder), {"a": {"live.tum": b"1"}})
        self.assertEqual(faults_files.runs_in(self.folder / "nothing"), {})

    def test_a_program_that_was_replaced_is_seen(self):
        self.run_folder("a", "complete", "one")
        self.run_folder("b", "complete", "other")
        self.run_folder("c", "failed", "third")
        self.assertEqual(faults_files.programs_in(self.folder), {"one", "other"})

    def test_other_bits_and_lost_runs_are_found(self):
        whole = {"a": {"live.tum": b"1"}, "b": {"live.tum": b"2"}}
        good = (4, "roomgraph: interrupted", True)
        self.assertEqual(faults_files.batch_verdict(set(), {}, whole, good, self.folder), [])
        self.assertEqual(faults_files.batch_verdict({"a"}, dict(whole), whole, good, self.folder), [])
        self.assertEqual(faults_files.batch_verdict({"a"}, {"b": whole["b"]}, whole, good, self.folder), ["a complete run is gone"])
        self.assertEqual(faults_files.batch_verdict(set(), {"a": {"live.tum": b"3"}}, whole, good, self.folder), ["other bits"])
        self.assertEqual(faults_files.batch_verdict(set(), {"a": {}}, whole, good, self.folder), ["other bits"])

    def test_a_process_that_is_left_is_found_until_it_ends(self):
        child = subprocess.Popen([sys.executable, "-c", "import time; print('ready', flush=True); time.sleep(30)", str(self.folder)],
                                 stdout=subprocess.PIPE)
        try:
            child.stdout.readline()
            self.assertEqual(faults_files.processes_of(self.folder, 0.2), [str(child.pid)])
        finally:
            child.kill()
            child.communicate()
        self.assertEqual(faults_files.processes_of(self.folder, 0.2), [])


if __name__ == "__main__":
    unittest.main()
