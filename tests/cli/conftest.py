"""Small missions for the tests of the command."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

APPS = '''
def Quiet(cfe):
    cfe.evs.register()
    while cfe.es.run_loop(1):
        cfe.os.task_delay(100)


def Chatty(cfe):
    """Ten messages a second, to itself; takes none out, so that the fifth meets the message limit."""
    cfe.evs.register()
    pipe = cfe.sb.create_pipe(10, "CHATTY")
    cfe.sb.subscribe(0x0890, pipe)
    while cfe.es.run_loop(1):
        cfe.sb.transmit_msg(cfe.msg.telemetry(0x0890, bytes(4)))
        cfe.os.task_delay(100)


def Dies(cfe):
    cfe.evs.register()
    cfe.es.run_loop(1)
    cfe.os.task_delay(500)
    raise ValueError("boom")


def Complains(cfe):
    cfe.evs.register()
    cfe.evs.send_err(5, "something is wrong")
    while cfe.es.run_loop(1):
        cfe.os.task_delay(100)


def GivesUp(cfe):
    cfe.evs.register()
    cfe.es.exit_app(3)


def Endless(cfe):
    while True:
        pass
'''

Write = Callable[..., Path]


@pytest.fixture
def make_mission(tmp_path: Path) -> Write:
    """Writes a mission of the functions above and returns its folder: `make_mission("Quiet", "Dies", yaml="...")`."""

    def write(*entry_points: str, yaml: str | None = None, action: int = 0) -> Path:
        folder = tmp_path / "mission"
        folder.mkdir(exist_ok=True)
        (folder / "apps.py").write_text(APPS, encoding="utf-8")
        lines = [f"CFE_APP, apps, {name}, {name.upper()}, 50, 8192, 0, {action};\n" for name in entry_points]
        (folder / "startup.scr").write_text("".join(lines) + "!\n", encoding="utf-8")
        if yaml is not None:
            (folder / "mission.yaml").write_text(yaml, encoding="utf-8")
        return folder

    return write
