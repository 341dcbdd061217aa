"""A real browser for pictures and tests: headless Chromium, driven by the DevTools protocol over a pipe.

It needs only the standard library. It records the page's log, its errors and its network requests.
"""

from __future__ import annotations

import base64
import fcntl
import itertools
import json
import os
import select
import shutil
import subprocess
from pathlib import Path
from types import TracebackType
from typing import Any

COMMANDS = ("chromium", "chromium-browser", "google-chrome")
FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--remote-debugging-pipe",
    "--hide-scrollbars",
)
PATIENCE_S = 60  # for an answer, and for its end
FIRST_FREE = 10  # descriptors below are for the browser's end of the pipes, which must be 3 and 4


def find_browser() -> str | None:
    """Return the browser's command, or None if no browser is installed."""
    return next((path for path in map(shutil.which, COMMANDS) if path is not None), None)


class Browser:
    """One browser with one page; use as a context manager.

    Args:
        folder: an empty folder for its profile.

    Attributes:
        errors: errors that were logged or thrown.
    """

    def __init__(self, folder: Path) -> None:
        self.errors: list[str] = []
        self._requests: list[tuple[str, str]] = []  # the loader of a page, and the URL
        self._loader = ""
        self._numbers = itertools.count(1)
        self._session: str | None = None
        self._rest = b""
        command = find_browser()
        assert command is not None
        theirs_in, self._out = _high_pipe()
        self._in, theirs_out = _high_pipe()

        def take_descriptors() -> None:
            os.dup2(theirs_in, 3)
            os.dup2(theirs_out, 4)

        self._process = subprocess.Popen(
            [command, *FLAGS, f"--user-data-dir={folder}", "about:blank"],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            preexec_fn=take_descriptors,
            close_fds=False,  # Python marks all other descriptors to be closed; these two must stay open
        )
        os.close(theirs_in)
        os.close(theirs_out)

    def __enter__(self) -> Browser:
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self._session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, where: TracebackType | None
    ) -> None:
        self._session = None
        try:
            self.call("Browser.close")
            self._process.wait(PATIENCE_S)
        finally:
            self._process.kill()
            self._process.wait()
        os.close(self._in)
        os.close(self._out)

    def call(self, method: str, **parameters: Any) -> Any:
        """Call a method of the protocol and wait for its result."""
        number = next(self._numbers)
        message: dict[str, Any] = {"id": number, "method": method, "params": parameters}
        if self._session is not None:
            message["sessionId"] = self._session
        os.write(self._out, json.dumps(message).encode() + b"\0")
        while True:
            answer = self._next()
            if answer.get("id") == number:
                assert "error" not in answer, answer["error"]
                return answer["result"]
            self._note(answer)

    def _next(self) -> dict[str, Any]:
        while b"\0" not in self._rest:
            assert select.select([self._in], [], [], PATIENCE_S)[0], "the browser does not answer"
            more = os.read(self._in, 1 << 20)
            assert more, "the browser has ended"
            self._rest += more
        message, _, self._rest = self._rest.partition(b"\0")
        found: dict[str, Any] = json.loads(message)
        return found

    def _note(self, event: dict[str, Any]) -> None:
        method, about = event.get("method"), event.get("params", {})
        if method == "Runtime.exceptionThrown":
            self.errors.append(str(about["exceptionDetails"]))
        elif method == "Runtime.consoleAPICalled" and about["type"] in ("error", "warning", "assert"):
            self.errors.append(str(about["args"]))
        elif method == "Log.entryAdded" and about["entry"]["level"] in ("error", "warning"):
            self.errors.append(about["entry"]["text"])
        elif method == "Network.requestWillBeSent":
            self._requests.append((about["loaderId"], about["request"]["url"]))

    def open(self, page: Path) -> float:
        """Load a file and wait until it has loaded. Returns the load time in s, as the page measures it."""
        self._loader = self.call("Page.navigate", url=page.as_uri())["loaderId"]
        wait = "new Promise(done => document.readyState === 'complete' ? done() : addEventListener('load', done))"
        self.evaluate(wait)
        assert (self._loader, page.as_uri()) in self._requests
        took_ms = self.evaluate("performance.getEntriesByType('navigation')[0].domComplete")
        return float(took_ms) / 1000

    @property
    def requests(self) -> list[str]:
        """URLs that the page requested after its own, without late requests of the page before it."""
        return [url for loader, url in self._requests if loader == self._loader][1:]

    def evaluate(self, expression: str) -> Any:
        """Return the value of a JavaScript expression, or of the promise that it returns."""
        answer = self.call("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        assert "exceptionDetails" not in answer, answer["exceptionDetails"]
        return answer["result"].get("value")

    def wheel(self, x: int, y: int, delta: int) -> None:
        """Turn the mouse's wheel at a place of the window."""
        self.call("Input.dispatchMouseEvent", type="mouseWheel", x=x, y=y, deltaX=0, deltaY=delta)

    def resize(self, width: int, height: int) -> None:
        """The size of the window."""
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)

    def prefer(self, scheme: str) -> None:
        """The color scheme that the reader prefers: "light" or "dark"."""
        self.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])

    def screenshot(self, file: Path) -> None:
        """Save a screenshot of the window as a PNG file."""
        file.write_bytes(base64.b64decode(self.call("Page.captureScreenshot")["data"]))


def _high_pipe() -> tuple[int, int]:
    """Return a pipe whose descriptors do not collide with 3 and 4."""
    ends = os.pipe()
    high = [fcntl.fcntl(each, fcntl.F_DUPFD_CLOEXEC, FIRST_FREE) for each in ends]
    for each in ends:
        os.close(each)
    return high[0], high[1]
