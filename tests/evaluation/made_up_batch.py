# SPDX-License-Identifier: BSD-3-Clause
"""Beginning of a program that takes the place of `roomgraph batch JOBS -o DIR` in tests: reads the jobs and makes an empty catalogue."""

BEGINNING = """#!{python}
import json, pathlib, sqlite3, sys
a = sys.argv[1:]
with open({log!r}, "a") as log:
    log.write(" ".join(a) + "\\n")
if a[0] != "batch" or not pathlib.Path(a[1]).exists():
    sys.exit(2)
jobs, out = json.loads(pathlib.Path(a[1]).read_text()), pathlib.Path(a[3])
out.mkdir(parents=True, exist_ok=True)
(out / "catalogue.sqlite").unlink(missing_ok=True)
db = sqlite3.connect(out / "catalogue.sqlite")
db.execute("CREATE TABLE inputs(id INTEGER PRIMARY KEY, input_group, seed)")
db.execute("CREATE TABLE runs(name, input_id, variant, status, reason, revision)")
db.execute("CREATE TABLE figures(run, figure, value)")
failed = 0
"""
