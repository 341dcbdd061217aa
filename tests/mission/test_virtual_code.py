"""Applications whose code is on the virtual file system only."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.console import Console
from cfepy.es.packets import START_APP
from cfepy.mission import Mission
from cfepy.mission.virtual_code import find_virtual_code
from cfepy.osal import FileSystem
from tests.mission.flights import write_mission


@pytest.mark.parametrize("written", ["/ram/x.py", "/ram/x.so", "/cf/x.o"])
def test_source_is_found_with_and_without_its_suffix(written: str) -> None:
    files = FileSystem()
    files.write_file(written, b"A = 1\n")
    found = find_virtual_code(written.replace(".py", ".so"), files)
    assert found is not None
    assert (found.path, found.source) == (written, b"A = 1\n")
    assert find_virtual_code("/ram/y.so", files) is None


@pytest.mark.parametrize(
    ("source", "said"),
    [
        (b"def late_main(cfe):\n    raise ValueError('too late')\n", "    raise ValueError('too late')"),
        (b"def late_main(cfe)\n", "SyntaxError: expected ':'"),
        (b"\xff\x00", "SyntaxError"),
    ],
)
def test_a_traceback_shows_its_lines(tmp_path: Path, source: bytes, said: str) -> None:
    with Mission(write_mission(tmp_path, "!"), console=Console(quiet=True)) as mission:
        mission.run(2)
        mission.files.write_file("/ram/late.py", source)
        start = START_APP.packet(Application="LATE", AppEntryPoint="late_main", AppFileName="/ram/late.so")
        mission.cfe.sb.transmit_msg(start, is_origination=False)
        mission.run(2)
        assert any(line.startswith(said) for line in mission.console.lines), mission.console.lines
        assert any('"/ram/late.py"' in line for line in mission.console.lines) or source == b"\xff\x00"
