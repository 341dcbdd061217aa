"""The stop button of a notebook: it ends a run that would take days, and leaves the kernel usable."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from tempfile import TemporaryDirectory
from typing import Any

import pytest

from dev.pages.notebook import kernel_sockets

jupyter_client = pytest.importorskip("jupyter_client")

pytestmark = pytest.mark.slow

LONGEST_S = 120  # limit for a test that hangs
Cell = Callable[..., dict[str, Any]]


@pytest.fixture(scope="module")
def cell() -> Iterator[Cell]:
    """Return a function that executes code in a kernel and gives its last output.

    `stop` presses the button after output.
    """
    sockets = TemporaryDirectory()
    manager = jupyter_client.KernelManager(kernel_name="python3", **kernel_sockets(sockets.name))
    manager.start_kernel()
    client = manager.client()
    client.start_channels()
    client.wait_for_ready(LONGEST_S)

    def execute(code: str, stop: bool = False) -> dict[str, Any]:
        request, last = client.execute(code), {}
        while True:
            message = client.get_iopub_msg(timeout=LONGEST_S)
            content = message["content"]
            if message["parent_header"].get("msg_id") != request:
                continue
            if message["msg_type"] == "stream" and stop:
                manager.interrupt_kernel()
            if message["msg_type"] in ("execute_result", "error"):
                last = content
            if content.get("execution_state") == "idle":
                return last

    yield execute
    client.stop_channels()
    manager.shutdown_kernel(now=True)
    sockets.cleanup()


@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_stop_button_interrupts_the_run(cell: Cell, tasks: str) -> None:
    cell(f"""
import cfepy

class Tell(cfepy.Attachment):
    def begin(self, mission):
        print("it flies", flush=True)

usual = cfepy.run("capture", seconds=1, tasks={tasks!r}).trace
""")
    stopped = cell(f"cfepy.run('capture', seconds=1e6, tasks={tasks!r}, attachments=[Tell()])", stop=True)
    assert stopped["ename"] == "KeyboardInterrupt"
    again = cell(f"cfepy.run('capture', seconds=1, tasks={tasks!r}).trace == usual")
    assert again["data"]["text/plain"] == "True"
    cell(f"flight = cfepy.boot('capture', tasks={tasks!r})")
    assert cell("print('on', flush=True); flight.run_for(1e6)", stop=True)["ename"] == "KeyboardInterrupt"
    went_on = cell("before = flight.now; flight.run_for(1); flight.close(); flight.now > before")
    assert went_on["data"]["text/plain"] == "True"
