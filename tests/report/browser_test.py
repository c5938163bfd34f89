#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The report of a run in headless Chromium: selection, map, themes, widths, paper, events, no message and no request.

Usage: browser_test.py PROGRAM [--pictures FOLDER]    exits with 77 where there is no browser
"""
import argparse
import json
import math
import pathlib
import random
import re
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import browser  # noqa: E402
import browser_pages  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
START = 1700000000
SETTINGS = {"program": "", "pictures": None}
SHAPE = "return document.querySelector('.map .world').getAttribute('transform')"


def roomgraph(*arguments):
    done = subprocess.run([SETTINGS["program"], *map(str, arguments)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise AssertionError(f"{arguments}: {done.stderr}")


HOUR_OBJECTS = 300


def write_hour(folder):
    """Poses and associations of an hour at 20 Hz, 300 objects, and a grid of 40 m x 25 m."""
    noise, poses, lines = random.Random(5), [], []
    for i in range(3600 * 20):
        t, a = START + i / 20, i / 160
        x, y = 6 * math.sin(a) + noise.gauss(0, 0.01), 4 * math.sin(2 * a) + noise.gauss(0, 0.01)
        poses.append(f"{t:.3f} {x:.4f} {y:.4f} 0 0 0 {math.sin(a / 2):.6f} {math.cos(a / 2):.6f}\n")
        if i % 2 == 0:
            lines.append(json.dumps({"timestamp": t, "measurements": [
                {"landmark": i % HOUR_OBJECTS, "new": False, "posterior": [{"landmark": i % HOUR_OBJECTS, "p": 0.9}]}]}) + "\n")
    for name, text in (("trajectory.tum", poses), ("live.tum", poses), ("associations.jsonl", lines)):
        (folder / name).write_text("".join(text), encoding="utf-8")
    objects = []
    for i in range(HOUR_OBJECTS):
        x, y = 1.9 * (i % 20) - 19, 1.6 * (i // 20) - 12
        objects.append({"id": i, "class": "sofa", "shape": "cuboid", "x": x, "y": y, "z": 0, "yaw": 0, "size_wdh": [.8, .6, .9],
                        "footprint": [[x, y], [x + .8, y], [x + .8, y + .6], [x, y + .6]], "existence": .9, "class_posterior": {"sofa": 1},
                        "covariance": [[.01 if r == c else 0 for c in range(4)] for r in range(4)]})
    (folder / "landmarks.json").write_text(json.dumps({"landmarks": objects}), encoding="utf-8")
    width, height = 800, 500
    (folder / "map.yaml").write_text("image: map.pgm\nresolution: 0.05\norigin: [-20, -12.5, 0]\nnegate: 0\n"
                                     "occupied_thresh: 0.65\nfree_thresh: 0.196\n", encoding="utf-8")
    (folder / "map.pgm").write_bytes(b"P5\n%d %d\n255\n" % (width, height) + noise.randbytes(width * height))


class Report(browser_pages.Paper, browser_pages.Events, unittest.TestCase):
    roomgraph = staticmethod(roomgraph)

    @classmethod
    def setUpClass(cls):
        cls.files = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.files.cleanup)
        cls.folder = pathlib.Path(cls.files.name)
        cls.out = cls.folder / "out"
        roomgraph("run", ROOT / "rawlogs" / "tiny_room.rawlog", "-o", cls.out, "--quiet", "--no-snapshot", "--set", "tracking.max_features=900")
        cls.page = cls.folder / "run.html"
        roomgraph("report", cls.out, "--truth", cls.out / "live.tum", "-o", cls.page)
        cls.address = cls.enterClassContext(browser.driver())
        cls.objects = json.loads((cls.out / "landmarks.json").read_text(encoding="utf-8"))["landmarks"]

    def open(self, page=None, **window):
        one = self.enterContext(browser.window(self.address, **window))
        one.open(page or self.page)
        one.wait("return document.documentElement.dataset.ready")
        self.addCleanup(self.expect_silence, one, page or self.page)
        return one

    def expect_silence(self, one, page):
        self.assertEqual(one.messages(), [], "messages on the console")
        asked = [url for url in one.requests() if not url.startswith("chrome")]
        self.assertEqual(asked, [pathlib.Path(page).resolve().as_uri()], "requests besides the page itself")

    def keep(self, one, name):
        if SETTINGS["pictures"]:
            one.screenshot(pathlib.Path(SETTINGS["pictures"]) / f"{name}.png")

    def test_both_themes_and_both_widths(self):
        for dark in (False, True):
            for width, height in ((1440, 900), (390, 844)):
                with self.subTest(dark=dark, width=width):
                    one = self.open(width=width, height=height, dark=dark)
                    one.wait("return document.querySelectorAll('.map image').length === 2")
                    paper = one.run("return getComputedStyle(document.body).backgroundColor")
                    self.assertEqual(sum(map(int, paper[4:-1].split(","))) < 200, dark, paper)
                    self.assertLessEqual(one.run("return document.documentElement.scrollWidth"), width, "it scrolls sideways")
                    shown = one.run("return [...document.querySelectorAll('.map image')].filter(i => getComputedStyle(i).display !== 'none')"
                                    ".map(i => i.classList[0])")
                    self.assertEqual(shown, ["dark" if dark else "light"])
                    self.keep(one, f"{width}_{'dark' if dark else 'light'}")
        one.click("#theme")
        self.assertEqual(one.run("return document.documentElement.dataset.theme"), "light")

    def test_texts_can_be_read(self):
        """Contrast of muted text and accent against paper and card: 4.5 at least (WCAG AA)."""
        script = """const s = getComputedStyle(document.documentElement), c = (n) => s.getPropertyValue(n).trim();
          const light = (h) => [1, 3, 5].map((i) => parseInt(h.slice(i, i + 2), 16) / 255)
            .map((v) => v <= .04045 ? v / 12.92 : ((v + .055) / 1.055) ** 2.4).reduce((sum, v, i) => sum + v * [.2126, .7152, .0722][i], 0);
          const ratio = (a, b) => (Math.max(light(a), light(b)) + .05) / (Math.min(light(a), light(b)) + .05);
          return [['--muted', '--paper'], ['--muted', '--card'], ['--accent', '--card'], ['--ink', '--paper'], ['--accent', '--accent-soft'],
                  ['--warn', '--warn-soft'], ['--on-accent', '--accent'], ['--muted', '--soft']].map(([a, b]) => [a, b, ratio(c(a), c(b))])"""
        one = self.open()
        for _ in range(2):
            for text, ground, ratio in one.run(script):
                self.assertGreaterEqual(ratio, 4.5, f"{text} on {ground}")
            one.click("#theme")

    def test_objects_of_map_and_list_are_selected_together(self):
        one = self.open()
        listed = one.run("return [...document.querySelectorAll('[aria-label=\"Objects in the map\"] button')].map(b => +b.dataset.id)")
        self.assertEqual(sorted(listed), sorted(o["id"] for o in self.objects))
        chosen = self.objects[0]
        shape = f".map .object[data-id='{chosen['id']}']"
        one.hover(f"{shape} .shape")
        self.assertIn(f"{chosen['class'].replace('_', ' ')} {chosen['id']}", one.wait("return !document.getElementById('tip').hidden && document.getElementById('tip').textContent"))
        one.click(f"{shape} .shape")
        detail = one.wait("return document.querySelector('#detail')?.textContent")
        # In whole centimetres, of what the page holds in tenths of millimetres.
        centimetres = r"(-?\d+\.\d\d)"
        size = re.search(rf"{centimetres} × {centimetres} × {centimetres}\u00a0m", detail)
        place = re.search(rf"Place x, y, z{centimetres}, {centimetres}, {centimetres}\u00a0m", detail)
        for seen, value in zip(size.groups() + place.groups(), [*chosen["size_wdh"], chosen["x"], chosen["y"], chosen["z"]]):
            self.assertAlmostEqual(float(seen), value, delta=0.0051)
        self.assertEqual(one.run(f"return document.querySelector(\"{shape}\").classList.contains('selected')"), True)
        other = self.objects[1]["id"]
        one.click(f".object-list button[data-id='{other}']")
        self.assertEqual(one.run("return [...document.querySelectorAll('.map .selected')].map(e => +e.dataset.id)"), [other])
        self.assertEqual(one.run("return [...document.querySelectorAll('.object-list [aria-pressed=true]')].map(e => +e.dataset.id)"), [other])
        one.run("document.querySelector('.map').focus({preventScroll: true})")
        one.keys("\ue00c")
        self.assertIsNone(one.run("return document.querySelector('#detail')"))

    def test_details_fit_a_narrow_window(self):
        one = self.open(width=360, height=740)
        for button in range(len(self.objects)):
            one.run("document.querySelectorAll('.object-list button')[arguments[0]].click();"
                    "document.querySelectorAll('#detail details').forEach((fold) => fold.open = true)", button)
            broken = one.run("return [...document.querySelectorAll('.facts dd')].filter((d) => d.getBoundingClientRect().height >"
                             "3.5 * parseFloat(getComputedStyle(d).lineHeight)).map((d) => d.textContent)")
            self.assertEqual(broken, [], "values in more than three lines")
            facts = one.run("return [...document.querySelectorAll('.facts dd')].map((d) => d.textContent)")
            self.assertGreater(len(facts), 20)
            self.assertEqual([fact for fact in facts if "-0.00" in fact], [])

    def test_map_moves_by_wheel_drag_and_keys(self):
        one = self.open()
        x, y = one.place(".map")
        seen = [one.run(SHAPE)]
        for action in (lambda: one.wheel(x, y, -240), lambda: one.drag(x + 40, y + 150, 80, 20),
                       lambda: one.run("document.querySelector('.map').focus({preventScroll: true})") or one.keys("\ue012+")):
            action()
            seen.append(one.run(SHAPE))
        self.assertEqual(len(set(seen)), 4, seen)
        self.assertIsNone(one.run("return document.querySelector('#detail')"), "a drag selects nothing")
        one.keys("0")
        fitted = one.run(SHAPE)
        one.click(".map-tools button:last-child")
        self.assertEqual(one.run(SHAPE), fitted)

    def test_layers_and_charts(self):
        one = self.open()
        self.assertEqual(one.run("return getComputedStyle(document.querySelector('.map .path')).display"), "inline")
        one.click("[data-layer=path]")
        self.assertEqual(one.run("return getComputedStyle(document.querySelector('.map .path')).display"), "none")
        one.hover("#accuracy .chart")
        self.assertRegex(one.run("return document.querySelector('#accuracy .readout').textContent"), r"^\d+:\d\d  ·  final .* live ")
        self.assertNotEqual(one.run("return document.querySelector('.map .cursor').style.display"), "none")
        changed = one.run("return [...document.querySelectorAll('#config tr.changed')].map(r => [...r.cells].map(c => c.firstChild.data))")
        self.assertEqual(changed, [["max_features", "900", "1000"]])

    def test_everything_has_a_name(self):
        one = self.open()
        nameless = one.run("return [...document.querySelectorAll('button, a, [role=img], [role=button], [role=group], nav, section, input')]"
                           ".filter(e => !(e.getAttribute('aria-label') || e.getAttribute('aria-labelledby') || e.textContent.trim())).map(e => e.outerHTML)")
        self.assertEqual(nameless, [])
        read_out = [(node["role"]["value"], node.get("name", {}).get("value", ""))
                    for node in one.devtools("Accessibility.getFullAXTree")["nodes"] if not node.get("ignored")]
        self.assertEqual([node for node in read_out if "›" in node[1] or node == ("table", "")], [], "what a screen reader says")
        self.assertEqual(one.run("return [document.documentElement.lang, document.querySelectorAll('main, nav, header').length, document.querySelectorAll('h1').length]"), ["en", 3, 1])

    def test_several_runs(self):
        page = self.folder / "two.html"
        roomgraph("report", self.out, self.out, self.out, "-o", page)
        one = self.open(page)
        self.assertEqual(one.run("return document.querySelectorAll('.maps .map').length"), 3)
        x, y = one.place(".maps .map")
        one.wheel(x, y, -240)
        shapes = one.run("return [...document.querySelectorAll('.maps .world')].map(w => w.getAttribute('transform'))")
        self.assertEqual(shapes[0], shapes[1], "they move together")
        narrow = self.open(page, width=360, height=740)
        narrow.run("document.querySelectorAll('#compare td:last-child').forEach((cell) => cell.append("
                   "Object.assign(document.createElement('span'), {className: 'hidden-text', textContent: '(best)'})))")
        self.assertLessEqual(narrow.run("return document.documentElement.scrollWidth"), 360, "it scrolls sideways")
        self.keep(one, "two")

    def test_an_hour_in_a_thousand_square_metres_opens_in_two_seconds(self):
        folder = self.folder / "hour"
        folder.mkdir()
        write_hour(folder)
        page = self.folder / "hour.html"
        begun = time.monotonic()
        roomgraph("report", folder, "-o", page)
        made_s = time.monotonic() - begun
        self.assertLess(made_s, 15, "a few seconds, on a machine that does other things beside")
        self.assertLess(page.stat().st_size, 15e6)
        one = self.open(page)
        ready_ms = int(one.run("return document.documentElement.dataset.ready"))
        print(f"hour: made in {made_s:.1f} s, {page.stat().st_size / 1e6:.2f} MB, ready after {ready_ms} ms")
        self.assertLess(ready_ms, 2000)
        self.assertEqual(one.run("return document.querySelectorAll('.map .object').length"), HOUR_OBJECTS)
        self.keep(one, "hour")


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--pictures")
    arguments, rest = parser.parse_known_args()
    SETTINGS.update(program=arguments.program, pictures=arguments.pictures)
    if not browser.available():
        print("no chromium and chromedriver here: skipped")
        sys.exit(77)
    unittest.main(argv=[sys.argv[0], *rest])
