"""cfepy works without features that other systems lack: all modules are imported, and the demonstration is the same.

The tests remove the features that Windows' or macOS's Python lacks. Replacements on those systems are missing here,
too. So the tests only find code that cannot do without a feature. docs/how_to/install.md lists runs on real systems.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from cfepy.mission import Mission
from cfepy.reading.resources import import_path
from cfepy.writing.console import Console

pytestmark = pytest.mark.slow
WITHOUT = Path(__file__).with_name("without.py")


@pytest.mark.parametrize("system", ["windows", "macos"])
def test_modules_are_importable_and_the_demonstration_has_the_same_trace(system: str) -> None:
    environment = {**os.environ, "PYTHONPATH": import_path()}
    command = [sys.executable, "-P", str(WITHOUT), system, "capture", "1"]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    with Mission("capture", console=Console(quiet=True)) as mission:
        mission.run_for(1)
        mission.shut_down_nodes()
        assert done.stdout.splitlines()[-1] == mission.trace.digest()
