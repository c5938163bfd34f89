#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""HTTP server for tests: serves a folder and misbehaves as the first part of the path says. Ends when its input does.

Usage: file_server.py FOLDER LOG

Prints its port. LOG gets one line per request: the address asked for, a blank, its Range or "-". Asked as a proxy (with a whole
address) it serves the path of the address. /plain/FILE knows ranges, /norange/FILE does not; /half/FILE closes the connection
in the middle unless a range is asked for; /nolength/FILE does so without having announced a length; /held/FILE waits in the
middle until the folder holds a file `release`; /damaged/FILE has one bit changed; /redirect/FILE sends to /plain/FILE; /refused/FILE answers 403, but not in folders below.
"""
import http.server
import pathlib
import re
import sys
import threading
import time
import urllib.parse

FOLDER, LOG = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])


class Handler(http.server.BaseHTTPRequestHandler):
    def do_GET(self):
        asked = self.headers.get("Range")
        with open(LOG, "a", encoding="utf-8") as log:
            log.write(f"{self.path} {asked or '-'}\n")
        mode, _, name = urllib.parse.urlparse(self.path).path.lstrip("/").partition("/")
        file = FOLDER / name
        if mode == "refused" and "/" not in name:
            return self.send_error(403)
        if mode == "redirect":
            return self.redirect(f"/plain/{name}")
        if not file.is_file():
            return self.send_error(404)
        data = file.read_bytes()
        if mode == "damaged":
            data = data[:-1] + bytes([data[-1] ^ 1])
        match = re.fullmatch(r"bytes=(\d+)-", asked or "") if mode != "norange" else None
        first = int(match.group(1)) if match else 0
        if match and first >= len(data):
            return self.send_error(416)
        self.begin(mode, data, first, match)
        self.body(mode, data[first:], match)

    def redirect(self, place):
        self.send_response(302)
        self.send_header("Location", place)
        self.send_header("Content-Length", "0")
        self.end_headers()

    def begin(self, mode, data, first, match):
        self.send_response(206 if match else 200)
        if match:
            self.send_header("Content-Range", f"bytes {first}-{len(data) - 1}/{len(data)}")
        if mode != "nolength":
            self.send_header("Content-Length", str(len(data) - first))
        self.end_headers()

    def body(self, mode, data, match):
        if mode in ("half", "nolength") and not match:
            data = data[:len(data) // 2]
        if mode == "held":
            self.wfile.write(data[:len(data) // 2])
            data = data[len(data) // 2:]
            while not (FOLDER / "release").exists():
                time.sleep(0.02)
        self.wfile.write(data)
        self.close_connection = True

    def log_message(self, *_):
        pass


if __name__ == "__main__":
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    server.daemon_threads = True
    threading.Thread(target=server.serve_forever, daemon=True).start()
    print(server.server_address[1], flush=True)
    sys.stdin.read()
