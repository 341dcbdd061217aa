"""Files that a program opens by descriptor."""

from __future__ import annotations

import os
from pathlib import Path

from cfepy.nodes import Universe
from cfepy.rtos import Kernel


def test_closing_the_standard_streams_leaves_the_hosts_open(tmp_path: Path) -> None:
    script = tmp_path / "program.py"
    script.write_text("for number in (1, 2):\n    open(number, 'ab').close()\n", encoding="utf-8")

    before = [os.fstat(number).st_ino for number in (1, 2)]
    kernel = Kernel()
    universe = Universe(kernel, name="program", script=script)
    universe.spawn()
    kernel.run()
    assert (universe.exit_status, [os.fstat(number).st_ino for number in (1, 2)]) == (0, before)
