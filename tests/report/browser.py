# SPDX-License-Identifier: BSD-3-Clause
"""A headless Chromium driven through WebDriver's HTTP interface (W3C), with the standard library only."""
import base64
import contextlib
import json
import pathlib
import re
import shutil
import subprocess
import tempfile
import time
import urllib.error
import urllib.request

ELEMENT = "element-6066-11e4-a52e-4f735466cecf"  # key of an element in answers, as the standard says
START_S, ANSWER_S = 60, 120


class BrowserError(Exception):
    pass


def available():
    return bool(shutil.which("chromium") and shutil.which("chromedriver"))


def request(url, method="GET", body=None):
    data = None if body is None else json.dumps(body).encode()
    call = urllib.request.Request(url, data, {"Content-Type": "application/json"}, method=method)
    opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
    try:
        with opener.open(call, timeout=ANSWER_S) as answer:
            return json.load(answer)["value"]
    except urllib.error.HTTPError as error:
        raise BrowserError(f"{method} {url}: {error.read().decode(errors='replace')[:600]}") from None


class Browser:
    """One window of a size, with its log of messages and of requests."""

    def __init__(self, driver, profile, width, height, dark):
        arguments = ["--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
                     "--hide-scrollbars", f"--window-size={width},{height}", f"--user-data-dir={profile}"]
        if dark:
            arguments.append("--force-dark-mode")
        answer = request(f"{driver}/session", "POST", {"capabilities": {"alwaysMatch": {
            "browserName": "chrome", "goog:chromeOptions": {"args": arguments, "binary": shutil.which("chromium")},
            "goog:loggingPrefs": {"browser": "ALL", "performance": "ALL"}}}})
        self.session = f"{driver}/session/{answer['sessionId']}"
        self.devtools("Emulation.setEmulatedMedia",
                      features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])
        self.devtools("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)

    def call(self, path, body=None, method=None):
        return request(f"{self.session}/{path}", method or ("GET" if body is None else "POST"), body)

    def devtools(self, command, **parameters):
        return self.call("goog/cdp/execute", {"cmd": command, "params": parameters})

    def open(self, page):
        self.call("url", {"url": pathlib.Path(page).resolve().as_uri()})

    def run(self, script, *arguments):
        return self.call("execute/sync", {"script": script, "args": list(arguments)})

    def wait(self, script, seconds=10):
        """Until the script returns something true; that."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if value := self.run(script):
                return value
            time.sleep(0.05)
        raise BrowserError(f"still not so after {seconds} s: {script}")

    def place(self, selector):
        """Middle of an element in the window, which is scrolled to it."""
        return self.run("const e = document.querySelector(arguments[0]);"
                        "e.scrollIntoView({block: 'center', behavior: 'instant'});"
                        "const b = e.getBoundingClientRect();"
                        "return [Math.round(b.x + b.width / 2), Math.round(b.y + b.height / 2)]", selector)

    def pointer(self, *steps):
        self.call("actions", {"actions": [{"type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"},
                                           "actions": list(steps)}]})

    def move(self, x, y):
        self.pointer({"type": "pointerMove", "duration": 50, "x": x, "y": y})

    def hover(self, selector):
        self.move(*self.place(selector))

    def click(self, selector):
        x, y = self.place(selector)
        self.pointer({"type": "pointerMove", "duration": 0, "x": x, "y": y}, {"type": "pointerDown", "button": 0},
                     {"type": "pointerUp", "button": 0})

    def drag(self, x, y, dx, dy):
        self.pointer({"type": "pointerMove", "duration": 0, "x": x, "y": y}, {"type": "pointerDown", "button": 0},
                     {"type": "pointerMove", "duration": 100, "x": x + dx, "y": y + dy}, {"type": "pointerUp", "button": 0})

    def wheel(self, x, y, delta):
        self.call("actions", {"actions": [{"type": "wheel", "id": "wheel", "actions": [
            {"type": "scroll", "x": x, "y": y, "deltaX": 0, "deltaY": delta, "duration": 0}]}]})

    def keys(self, text):
        steps = [{"type": kind, "value": key} for key in text for kind in ("keyDown", "keyUp")]
        self.call("actions", {"actions": [{"type": "key", "id": "keys", "actions": steps}]})

    def messages(self):
        """Errors and warnings of the console since the last call."""
        return [entry["message"] for entry in self.call("se/log", {"type": "browser"})
                if entry["level"] in ("SEVERE", "WARNING")]

    def requests(self):
        """Addresses that were asked for since the last call, those inside the page left out."""
        found = []
        for entry in self.call("se/log", {"type": "performance"}):
            message = json.loads(entry["message"])["message"]
            if message["method"] == "Network.requestWillBeSent":
                found.append(message["params"]["request"]["url"])
        return [url for url in found if not url.startswith(("data:", "blob:"))]

    def screenshot(self, file):
        height = self.run("return document.documentElement.scrollHeight")
        width = self.run("return document.documentElement.clientWidth")
        picture = self.devtools("Page.captureScreenshot", captureBeyondViewport=True,
                                clip={"x": 0, "y": 0, "width": width, "height": height, "scale": 1})
        pathlib.Path(file).write_bytes(base64.b64decode(picture["data"]))

    def print(self, file, width_in=8.27, height_in=11.69):
        """The page as PDF; A4 unless told."""
        done = self.devtools("Page.printToPDF", printBackground=True, paperWidth=width_in, paperHeight=height_in)
        pathlib.Path(file).write_bytes(base64.b64decode(done["data"]))

    def close(self):
        with contextlib.suppress(BrowserError):
            self.call("", method="DELETE")


@contextlib.contextmanager
def driver():
    """Address of a chromedriver that runs as long as this."""
    process = subprocess.Popen([shutil.which("chromedriver"), "--port=0"], stdout=subprocess.PIPE,
                               stderr=subprocess.DEVNULL, text=True)
    try:
        port, end = None, time.monotonic() + START_S
        while port is None and time.monotonic() < end:
            line = process.stdout.readline()
            if not line:
                raise BrowserError("chromedriver does not start")
            if match := re.search(r"started successfully on port (\d+)", line):
                port = match.group(1)
        yield f"http://127.0.0.1:{port}"
    finally:
        process.terminate()
        process.wait()
        process.stdout.close()


@contextlib.contextmanager
def window(address, width=1440, height=900, dark=False):
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        browser = Browser(address, profile, width, height, dark)
        try:
            yield browser
        finally:
            browser.close()
            # On a busy machine the browser may not have heard of it; nothing else has this name in its words.
            with contextlib.suppress(FileNotFoundError):
                subprocess.run(["pkill", "-KILL", "-f", profile], check=False)
