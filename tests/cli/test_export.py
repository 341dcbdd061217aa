"""`cfepy export xtce`; what is in the document is tested in tests/mission/test_xtce.py."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import pytest

from cfepy.cli.main import main
from tests.cli.conftest import Write


def test_to_a_file_and_to_standard_output(
    make_mission: Write, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder, file = str(make_mission("Quiet")), tmp_path / "mission.xml"
    assert main(["export", "xtce", folder, "-o", str(file)]) == 0
    assert capsys.readouterr().out == ""
    assert main(["export", "xtce", folder]) == 0
    assert capsys.readouterr().out == file.read_text()
    assert ElementTree.parse(file).getroot().attrib["name"] == "mission"


def test_topics_are_found_by_flying(make_mission: Write, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export", "xtce", "rx64m_pubsub"]) == 0
    assert 'SequenceContainer name="counter"' in capsys.readouterr().out


def test_bad_usage(make_mission: Write, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export", "xtce", "no_such_mission"]) == 2
    assert main(["export", "xtce", str(make_mission("Quiet")), "-o", "/no/such/x.xml"]) == 2
    assert "/no/such/x.xml: --output: cannot be written" in capsys.readouterr().err
