# SPDX-License-Identifier: BSD-3-Clause
"""Parts of the report's page in a browser that need a run of their own: paper, and the list of events."""
import collections
import json
import pathlib
import re
import shutil
import subprocess
import unittest

SCALES = """return [...document.querySelectorAll('.map')].map((map) => {
  const bar = map.parentElement.querySelector('.scale-bar');
  const [, number, unit] = bar.textContent.match(/^([\\d.,]+) (cm|m)$/);
  return [bar.lastChild.getBoundingClientRect().width / map.querySelector('.world').getScreenCTM().a,
          Number(number.replace(',', '')) * (unit === 'cm' ? 0.01 : 1)]; })"""
OUTSIDE = """const m = document.querySelector('main').getBoundingClientRect();
  return [...document.querySelectorAll('main *')].filter((e) => !e.closest('.map .world, .map .labels, .hidden-text') && e.getClientRects().length)
    .filter((e) => { const b = e.getBoundingClientRect(); return b.width && (b.right > m.right + 1.5 || b.left < m.left - 1.5); })
    .map((e) => `${e.tagName}.${e.getAttribute('class')} ${e.textContent.slice(0, 30)}`)"""
DRAWN = """return [...document.querySelectorAll('.map .world, .chart .curve')]
  .map((e) => e.getAttribute('transform') || e.getAttribute('points').slice(0, 200)).join(' ')"""

TICKS = "return [...document.querySelectorAll('.chart text')].map((text) => text.textContent)"


def words_of(pdf):
    """Text, left, right and width of its page of every word, as another program reads them."""
    done = subprocess.run(["pdftotext", "-bbox", str(pdf), "-"], check=True, capture_output=True, text=True)
    words, width = [], 0
    for line in done.stdout.splitlines():
        if match := re.search(r'<page width="([\d.]+)"', line):
            width = float(match.group(1))
        elif match := re.search(r'<word xMin="([-\d.]+)".*xMax="([-\d.]+)".*>(.*)</word>', line):
            words.append((match.group(3), float(match.group(1)), float(match.group(2)), width))
    return words


class Paper:
    """Mixed into the test case that has a run."""

    @unittest.skipUnless(shutil.which("pdftotext"), "pdftotext (poppler-utils) is not installed")
    def test_a_printed_page_is_whole(self):
        for width, paper in ((1440, (8.27, 11.69)), (390, (8.5, 11)), (1440, (5.83, 8.27))):
            with self.subTest(window=width, paper=paper):
                one = self.open(width=width, dark=True)
                one.wait("return document.querySelectorAll('.map image').length === 2")
                pdf = self.folder / "page.pdf"
                one.print(pdf, *paper)
                words = words_of(pdf)
                for word, left, right, page in words:
                    self.assertGreater(left, 20, word)
                    self.assertLess(right, page - 20, word)
                texts = [word for word, *_ in words]
                one.run("dispatchEvent(new Event('beforeprint'))")
                times = collections.Counter(t for t in one.run(TICKS) if re.fullmatch(r"\d+:\d\d", t))
                self.assertGreater(times.total(), 12)
                self.assertEqual(times - collections.Counter(texts), collections.Counter(), "times below charts that are cut off")
                self.assertIn("max_features", texts, "what was changed is shown")
                self.assertIn("roomgraph", texts, "the command of the run is shown")
                self.assertEqual([t for t in texts if t in ("Drag", "Close", "Grid")], [], "nothing that can be pressed")

    def test_a_sheet_is_drawn_for_itself_and_the_window_comes_back(self):
        one = self.open(dark=True)
        one.wait("return document.querySelectorAll('.map image').length === 2")
        x, y = one.place(".map")
        one.wheel(x, y, -240)
        before, folds = one.run(DRAWN), "return document.querySelectorAll('details[open]').length"
        opened = one.run(folds)
        for length, metres in one.run(SCALES):
            self.assertAlmostEqual(length, metres, delta=0.01 * metres)
        one.run("dispatchEvent(new Event('beforeprint'))")
        one.devtools("Emulation.setEmulatedMedia", media="print")
        one.devtools("Emulation.setDeviceMetricsOverride", width=600, height=900, deviceScaleFactor=1, mobile=False)
        one.run("dispatchEvent(new Event('beforeprint'))")  # as the window has told of its new width by now
        self.assertEqual(one.run(OUTSIDE), [])
        self.assertNotEqual(one.run(DRAWN), before)
        self.assertEqual(one.run("return getComputedStyle(document.body).color"), "rgb(26, 31, 36)", "dark on light")
        for length, metres in one.run(SCALES):
            self.assertAlmostEqual(length, metres, delta=0.01 * metres)
        one.devtools("Emulation.setEmulatedMedia", media="", features=[{"name": "prefers-color-scheme", "value": "dark"}])
        one.devtools("Emulation.setDeviceMetricsOverride", width=1440, height=900, deviceScaleFactor=1, mobile=False)
        one.run("dispatchEvent(new Event('afterprint'))")
        self.assertEqual(one.run(DRAWN), before)
        self.assertEqual(one.run(folds), opened, "folds are as they were")


class Events:
    """Mixed into the test case that has a run."""

    def run_with_events(self):
        folder = self.folder / "events"
        if folder.exists():
            return folder
        shutil.copytree(self.out, folder)
        start = float((folder / "trajectory.tum").read_text(encoding="utf-8").split()[0])
        spans = [{"sensor": "camera" if i % 2 else "lidar", "from": start + 0.1 * i, "to": start + 0.1 * i + 0.01 * (i * 7 % 12 + 1),
                  "records": i % 3, "why": f"cause <b>{i}</b>"} for i in range(12)]
        (folder / "lost.jsonl").write_text("".join(json.dumps(s) + "\n" for s in spans), encoding="utf-8")
        summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
        summary["counts"].update(frames=50, scans=60, loop_closures=7)
        with open(folder / "graph.g2o", "a", encoding="utf-8") as graph:
            graph.write("EDGE_SE3:QUAT 0 8 1 0 0 0 0 0 1 " + " ".join("1" if i in (0, 6, 11, 15, 18, 20) else "0" for i in range(21)) + "\n")
        summary["findings"] = [{"severity": "note" if i == 0 else "warning", "place": f"P{i}", "what": f"what {i}", "hint": "a hint" if i == 1 else ""}
                               for i in range(7)]
        (folder / "summary.json").write_text(json.dumps(summary), encoding="utf-8")
        return folder

    def test_events_are_listed(self):
        page = self.folder / "events.html"
        self.roomgraph("report", self.run_with_events(), "-o", page)
        one = self.open(page)
        marks = one.run("return [...document.querySelectorAll('#lost .lane')].map((l) => [...l.children].map((m) => m.className))")
        self.assertEqual([len(lane) for lane in marks], [6, 6], "camera and lidar")
        self.assertEqual(marks[0], ["lost" if i % 3 else "silent" for i in range(1, 12, 2)])
        causes = "return [...document.querySelectorAll('#lost {} tbody tr')].map((r) => r.lastChild.textContent)"
        longest = sorted(range(12), key=lambda i: -(i * 7 % 12))[:8]
        shown = one.run(causes.format("> .scroll"))
        self.assertEqual(shown, [f"cause <b>{i}</b>" for i in longest])
        self.assertEqual(one.run(causes.format("details")), [], "filled when it opens")
        one.click("#lost summary")
        one.wait("return document.querySelector('#lost details table')")
        self.assertEqual(one.run(causes.format("details")), [f"cause <b>{i}</b>" for i in range(12)])
        one.click("#lost summary")
        one.click("#lost summary")
        self.assertEqual(one.run("return document.querySelectorAll('#lost details table').length"), 1, "filled once")
        head = one.run("return [...document.querySelectorAll('.notes .note')].map((n) => n.textContent)")
        self.assertEqual([n for n in head if n.startswith("P")], [f"P{i}: what {i}" for i in range(1, 5)], "the note is not grave")
        self.assertIn("2 more are listed under Events.", head)
        rows = one.run("return [...document.querySelectorAll('#findings tbody tr')].map((r) => r.textContent)")
        self.assertEqual(len(rows), 7)
        self.assertEqual(rows[:2], ["noteP0what 0", "warningP1what 1a hint"])

    def test_figures_of_axes_differ(self):
        one = self.open()
        axes = one.run("return [...document.querySelectorAll('.chart')].map((c) => "
                       "[...c.querySelectorAll('text[text-anchor=end]')].map((t) => t.textContent))")
        self.assertGreater(len(axes), 3)
        for figures in axes:
            self.assertGreater(len(figures), 1)
            self.assertEqual(len(set(figures)), len(figures), figures)

    def test_closures_that_share_a_tie_are_counted(self):
        page = self.folder / "events.html"
        self.roomgraph("report", self.run_with_events(), "-o", page)
        one = self.open(page)
        self.assertEqual(one.run("return document.querySelector('#closures h3').textContent"), "Loop closures (1 tie of 7)")
        self.assertIn("one tie for all closures", one.run("return document.querySelector('#closures').textContent"))
