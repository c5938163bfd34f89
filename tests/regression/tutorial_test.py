#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# Part of roomgraph, object-level semantic SLAM.
"""Every command of docs/tutorial.md runs, and prints what the page quotes.

Usage: tutorial_test.py PROGRAM ROOT

Commands are lines indented by four blanks that begin with roomgraph, or with "! roomgraph" when they must fail. The lines of a
block of text must be in the output of the last command before it.
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

PROGRAM, ROOT = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
STEP = re.compile(r"^    (?P<fails>! )?(?P<command>roomgraph [^\n]*)$|^```text\n(?P<quote>.*?)^```$",
                  re.MULTILINE | re.DOTALL)


class Tutorial(unittest.TestCase):
    def test_commands_and_quotes(self):
        page = (ROOT / "docs/tutorial.md").read_text(encoding="utf-8")
        output, commands, quotes = "", 0, 0
        with tempfile.TemporaryDirectory() as folder:
            os.symlink(ROOT / "rawlogs", pathlib.Path(folder, "rawlogs"))
            variables = {**os.environ, "PATH": f"{PROGRAM.parent}:{os.environ['PATH']}", "XDG_DATA_HOME": folder}
            for step in STEP.finditer(page):
                if step["command"]:
                    done = subprocess.run(step["command"], shell=True, cwd=folder, env=variables, text=True,
                                          capture_output=True, check=False)
                    output = done.stdout + done.stderr
                    self.assertEqual(done.returncode, 2 if step["fails"] else 0, step["command"] + "\n" + output)
                    commands += 1
                else:
                    for line in step["quote"].splitlines():
                        self.assertIn(line, output)
                    quotes += 1
        self.assertEqual(commands, len(re.findall(r"^    (?:! )?roomgraph ", page, re.MULTILINE)))
        self.assertEqual(quotes, page.count("```text"))
        self.assertGreater(commands, 10)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
