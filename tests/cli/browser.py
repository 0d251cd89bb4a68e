# SPDX-License-Identifier: Apache-2.0
"""Headless Chromium through chromedriver's HTTP interface: real clicks and keys, pixels, what it asked of the network."""
import base64
import json
import re
import shutil
import struct
import subprocess
import time
import urllib.error
import urllib.request
import zlib

ELEMENT = "element-6066-11e4-a52e-4f735466cecf"
OPENER = urllib.request.build_opener(urllib.request.ProxyHandler({}))


def available():
    return bool(shutil.which("chromedriver") and shutil.which("chromium"))


class Browser:
    def __init__(self, width, height):
        self.driver = subprocess.Popen(["chromedriver", "--port=0"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        for line in self.driver.stdout:
            found = re.search(r"successfully on port (\d+)", line)
            if found:
                self.root = "http://127.0.0.1:" + found[1]
                break
        # No sandbox: continuous integration runs as root, and the page is our own. No name is ever looked up.
        arguments = ["--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--force-device-scale-factor=1",
                     f"--window-size={width},{height}", "--host-resolver-rules=MAP * ~NOTFOUND , EXCLUDE 127.0.0.1"]
        options = {"browserName": "chrome", "goog:chromeOptions": {"args": arguments, "binary": shutil.which("chromium")},
                   "goog:loggingPrefs": {"browser": "ALL", "performance": "ALL"}}
        self.root += "/session/" + self.call("/session", {"capabilities": {"alwaysMatch": options}})["sessionId"]

    def call(self, path, body=None, method=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.root + path, data, {"Content-Type": "application/json"}, method=method)
        try:
            with OPENER.open(request, timeout=60) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(f"{path}: {error.read().decode()[:500]}") from None

    def close(self):
        try:
            self.call("", method="DELETE")
        finally:
            self.driver.terminate()
            self.driver.wait()

    def open(self, path):
        self.call("/url", {"url": "file://" + path})

    def script(self, text, *arguments):
        return self.call("/execute/sync", {"script": text, "args": list(arguments)})

    def wait(self, text, seconds=30):
        end = time.time() + seconds
        while not self.script("return !!(" + text + ")"):
            if time.time() > end:
                raise RuntimeError("this did not become true: " + text)
            time.sleep(0.05)

    def find(self, selector):
        return self.call("/element", {"using": "css selector", "value": selector})[ELEMENT]

    def find_all(self, selector):
        return [e[ELEMENT] for e in self.call("/elements", {"using": "css selector", "value": selector})]

    def click(self, selector):
        self.script("document.querySelector(arguments[0]).scrollIntoView({block: 'center'})", selector)
        self.call(f"/element/{self.find(selector)}/click", {})

    def keys(self, selector, text):
        self.call(f"/element/{self.find(selector)}/value", {"text": text})

    def press(self, text):
        """Keys to whatever has the focus."""
        steps = [{"type": kind, "value": c} for c in text for kind in ("keyDown", "keyUp")]
        self.call("/actions", {"actions": [{"type": "key", "id": "keys", "actions": steps}]})

    def pointer(self, selector, fractions, hold=True):
        """Presses at the first of (x, y) fractions of an element, goes to the others and lets go."""
        box = self.script("const e = document.querySelector(arguments[0]); e.scrollIntoView({block: 'center'});"
                          "const b = e.getBoundingClientRect(); return [b.left, b.top, b.width, b.height]", selector)
        at = [{"type": "pointerMove", "duration": 0, "x": round(box[0] + x * box[2]), "y": round(box[1] + y * box[3])} for x, y in fractions]
        steps = [at[0], {"type": "pointerDown", "button": 0}] + at[1:] + [{"type": "pointerUp", "button": 0}] if hold else at
        self.call("/actions", {"actions": [{"type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"}, "actions": steps}]})

    def text(self, selector):
        return self.script("return document.querySelector(arguments[0]).textContent", selector)

    def canvas(self, selector):
        """Width, height and the red, green, blue, alpha bytes of a canvas."""
        width, height, data = self.script(
            "const c = document.querySelector(arguments[0]), d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;"
            "let s = ''; for (let i = 0; i < d.length; i += 8192) s += String.fromCharCode(...d.subarray(i, i + 8192));"
            "return [c.width, c.height, btoa(s)]", selector)
        return width, height, base64.b64decode(data)

    def screenshot(self, selector):
        return decode_png(base64.b64decode(self.call(f"/element/{self.find(selector)}/screenshot")))

    def label(self, element):
        return self.call(f"/element/{element}/computedlabel")

    def resize(self, width, height):
        self.call("/window/rect", {"width": width, "height": height})

    def console_errors(self):
        return [e["message"] for e in self.call("/se/log", {"type": "browser"}) if e["level"] in ("SEVERE", "WARNING")]

    def requests(self):
        """Addresses that the page asked for since the last call."""
        messages = [json.loads(e["message"])["message"] for e in self.call("/se/log", {"type": "performance"})]
        return [m["params"]["request"]["url"] for m in messages if m["method"] == "Network.requestWillBeSent"]


def decode_png(data):
    """Width, height and red, green, blue, alpha bytes of a PNG with 8 bits and no interlacing."""
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height, depth, color = struct.unpack(">IIBB", body[:10])
            assert depth == 8 and color in (2, 6)
        packed += body if kind == b"IDAT" else b""
        at += 12 + size
    n, rows = 3 if color == 2 else 4, zlib.decompress(packed)
    before, out = bytearray(width * n), bytearray()
    for y in range(height):
        filter_kind, line = rows[y * (width * n + 1)], bytearray(rows[y * (width * n + 1) + 1:(y + 1) * (width * n + 1)])
        for i in range(width * n):
            a, b, c = line[i - n] if i >= n else 0, before[i], before[i - n] if i >= n else 0
            if filter_kind == 1:
                line[i] = line[i] + a & 255
            elif filter_kind == 2:
                line[i] = line[i] + b & 255
            elif filter_kind == 3:
                line[i] = line[i] + (a + b) // 2 & 255
            elif filter_kind == 4:
                p = a + b - c
                nearest = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
                line[i] = line[i] + nearest & 255
        before = line
        for i in range(0, width * n, n):
            out += line[i:i + 3] + (b"\xff" if n == 3 else line[i + 3:i + 4])
    return width, height, bytes(out)
