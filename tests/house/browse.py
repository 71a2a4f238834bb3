#!/usr/bin/env python3
"""A page as a browser without a window shows it, once it says that it has drawn (`data-drawn` of its body):
browse.py URL WIDTHxHEIGHT[@SCALE] shot FILE.png | ask SCRIPT.js. `ask` prints what the expression in the file yields.

The browser is spoken to through two pipes (the Chrome DevTools protocol), and waited for in real time: its virtual time
runs out on a busy machine before a page has drawn anything. Exit status 77 where there is no Chromium."""

import base64
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

PATIENCE = 90  # seconds until a page must have drawn; an idle machine needs one

browser = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
if not browser:
    sys.exit(77)
url, window, action, file = sys.argv[1:]
size, _, scale = window.partition("@")
width, height = map(int, size.split("x"))


class Browser:
    """Commands go down one pipe and answers come up the other, each a JSON text that ends with a zero byte."""

    def __init__(self, folder):
        down, up = os.pipe(), os.pipe()
        # The software OpenGL of the browser itself: what a machine without a screen has. The browser reads descriptor 3 and
        # writes descriptor 4.
        command = [browser, "--headless=new", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader",
                   "--enable-unsafe-swiftshader", f"--user-data-dir={folder}/profile", "--hide-scrollbars",
                   "--remote-debugging-pipe", "about:blank"]
        self.log = open(f"{folder}/log", "w")
        shell = f'exec 3<&{down[0]} 4>&{up[1]}; exec "$@"'
        self.process = subprocess.Popen(["bash", "-c", shell, "browser", *command], pass_fds=[down[0], up[1]],
                                        stdout=self.log, stderr=self.log)
        os.close(down[0])
        os.close(up[1])
        self.commands, self.answers, self.count, self.session, self.rest = down[1], up[0], 0, None, b""
        target = self.ask("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]

    def ask(self, method, **parameters):
        self.count += 1
        message = {"id": self.count, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        text = json.dumps(message).encode() + b"\0"
        while text:
            text = text[os.write(self.commands, text):]
        while True:
            answer = json.loads(self.read())
            if answer.get("id") != self.count:
                continue  # an event
            if "error" in answer:
                raise RuntimeError(f"{method}: {answer['error']['message']}")
            return answer["result"]

    def read(self):
        parts = self.rest
        while b"\0" not in parts:
            more = os.read(self.answers, 1 << 16)
            if not more:
                raise RuntimeError(f"the browser ended:\n{Path(self.log.name).read_text()}")
            parts += more
        text, self.rest = parts.split(b"\0", 1)
        return text

    def evaluate(self, expression):
        result = self.ask("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise RuntimeError(result["exceptionDetails"]["exception"]["description"])
        return result["result"].get("value")

    def close(self):
        self.process.kill()
        self.process.wait()
        self.log.close()


# Two frames after the first drawing nothing is under way any more.
SETTLED = """(document.body && document.body.dataset.drawn !== undefined)
  ? new Promise(settled => requestAnimationFrame(() => requestAnimationFrame(() => settled("drawn"))))
  : (document.getElementById("message") || { hidden: true }).hidden ? "waits" : document.getElementById("message").textContent"""

with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
    page = Browser(folder)
    try:
        page.ask("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=float(scale or 1), mobile=False)
        page.ask("Page.navigate", url=url)
        latest = time.monotonic() + PATIENCE
        while True:
            try:
                state = page.evaluate(SETTLED)
            except RuntimeError as error:  # between two documents there is nothing to ask
                state = "waits" if "context" in str(error) else sys.exit(f"browse.py: {error}")
            if state == "drawn":
                break
            if state != "waits":
                sys.exit(f"browse.py: the page says: {state}")
            if time.monotonic() > latest:
                sys.exit(f"browse.py: {url} has drawn nothing in {PATIENCE} s")
            time.sleep(0.05)
        if action == "shot":
            picture = page.ask("Page.captureScreenshot", format="png")["data"]
            Path(file).write_bytes(base64.b64decode(picture))
        else:
            print(page.evaluate(Path(file).read_text()))
    finally:
        page.close()
