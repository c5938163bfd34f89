#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""bench/foreign_maps.py with a program of known answers in place of roomgraph."""
import contextlib
import io
import json
import pathlib
import stat
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
import foreign_maps  # noqa: E402

# A recording and a map hold the number of their flat. Flats whose numbers are the same modulo {alike} cannot be told apart.
FAKE = """#!{python}
import json, pathlib, sys
a = sys.argv[1:]
out = pathlib.Path(a[a.index("-o") + 1])
out.mkdir(parents=True, exist_ok=True)
if a[0] == "simulate":
    (out / "flat.rawlog").write_text(a[a.index("--flat") + 1])
else:
    driven = pathlib.Path(a[1]).read_text()
    if driven == "13":
        sys.exit("the run of 13 fails")
    (out / "map.rgmap").write_text(driven)
    earlier = pathlib.Path(a[a.index("--map") + 1]).read_text() if "--map" in a else ""
    found = earlier and int(driven) % {alike} == int(earlier) % {alike}
    said = {{"relocalised": "yes", "after_s": 1.25, "by": "scans"}} if found else {{"relocalised": "no"}}
    (out / "summary.json").write_text(json.dumps({{"earlier_map": said, "until": a[a.index("--until") + 1] if earlier else None}}))
"""


class ForeignMaps(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_maps(self, alike, *arguments):
        program = self.folder / "roomgraph"
        program.write_text(FAKE.format(python=sys.executable, alike=alike))
        program.chmod(program.stat().st_mode | stat.S_IXUSR)
        out = io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(io.StringIO()):
            code = foreign_maps.main(["--out", str(self.folder / "out"), "--program", str(program), *arguments])
        return code, out.getvalue()

    def test_only_the_own_map_is_accepted(self):
        code, text = self.run_maps(100, "--flats", "3-5", "--seconds", "7")
        self.assertEqual(code, 0)
        self.assertEqual(text.count("refused"), 6)
        self.assertIn("| 4 | refused | after 1.2 s, by scans | refused |", text)
        said = json.loads((self.folder / "out/foreign.json").read_text())
        self.assertEqual([(s["driven"], s["mapped"]) for s in said if s["relocalised"] == "yes"], [(n, n) for n in (3, 4, 5)])
        self.assertEqual(json.loads((self.folder / "out/flat_3_in_5/summary.json").read_text())["until"], "7.0")

    def test_a_foreign_place_is_a_failure(self):
        code, text = self.run_maps(2, "--flats", "3-5")
        self.assertEqual(code, 1)
        self.assertIn("| 3 | after 1.2 s, by scans | refused | after 1.2 s, by scans |", text)

    def test_a_failed_run_is_told(self):
        with self.assertRaisesRegex(RuntimeError, "the run of 13 fails"):
            self.run_maps(100, "--flats", "12-13")


if __name__ == "__main__":
    unittest.main()
