"""The pictures of the documentation, made by the commands that they show: `python -m dev.pages.pictures`.

They need the extras `dev` and a browser (Debian's package `chromium`), which renders the pages.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

from cfepy.cli.main import main
from dev.pages.browser import Browser
from dev.pages.console_picture import save_console

FOLDER = Path(__file__).parents[2] / "docs" / "pictures"
CONSOLE_PX = (1200, 760)
PAGE_PX = (1200, 900)
SWITCH = "moves:ODOMETER.left_tic@670/on_ticks.publish/4=ODOMETER.right_ti"


def curves() -> None:
    """`cfepy plot`: the joints of `capture`, with the phases of the mission."""
    words = ["/joint_states.position", "/phase"]
    main(["plot", "capture", *words, "--for", "20", "-o", str(FOLDER / "plot.png")])


def graph() -> None:
    """Draw `cfepy graph` of `capture`: which nodes talk to each other."""
    main(["graph", "capture", "--svg", str(FOLDER / "graph.svg")])


def report(folder: Path, browser: Browser) -> None:
    """`cfepy report`: the top of the page of a run that fails."""
    page = folder / "report.html"
    main(["report", "tests/quality/missions/lost_update", "--for", "1.3", "--schedule", SWITCH, "-o", str(page)])
    _look_at(browser, page, PAGE_PX, FOLDER / "report.png")


def console(folder: Path, browser: Browser) -> None:
    """`cfepy console` with `lab`."""
    drawing = folder / "console.svg"
    save_console(drawing)
    _look_at(browser, drawing, CONSOLE_PX, FOLDER / "console.png")


def _look_at(browser: Browser, page: Path, size: tuple[int, int], file: Path) -> None:
    browser.resize(*size)
    browser.open(page)
    browser.screenshot(file)


def make_all() -> None:
    """Make all pictures."""
    FOLDER.mkdir(exist_ok=True)
    curves()
    graph()
    with tempfile.TemporaryDirectory() as folder, Browser(Path(folder) / "profile") as browser:
        report(Path(folder), browser)
        console(Path(folder), browser)


if __name__ == "__main__":
    argparse.ArgumentParser(prog="python -m dev.pages.pictures", description=__doc__).parse_args()
    make_all()
