"""The output of a paced run appears at the time of its event, also in a pipe."""

from __future__ import annotations

import os
import sys

from tests.extra.ros_host.graphs import started, wait_for_line


def test_paced_run_shows_its_lines_in_a_pipe_as_they_come() -> None:
    environ = {name: value for name, value in os.environ.items() if name != "PYTHONUNBUFFERED"}
    with started([sys.executable, "-m", "cfepy", "run", "lab", "--realtime", "--for", "3600"], environ) as process:
        assert wait_for_line(process, "CFE_ES_Main entering OPERATIONAL state")
        assert process.poll() is None
