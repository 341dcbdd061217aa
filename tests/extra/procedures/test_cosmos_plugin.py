"""`cfepy export cosmos MISSION -o FOLDER/`: the plugin folder, and a mission script that flies as a procedure.

These are the steps of docs/how_to/procedures.md.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.cli.main import main
from tests.extra.procedures.demo import fly, verdicts

SCRIPT = """\
at 2    send SAMPLE_APP_DISPLAY_PARAM ValU32=10 ValStr="two words"
        expect event SAMPLE_APP * INFORMATION "ValU32=10" within 1
        expect tlm SAMPLE_APP_HK_TLM CommandCounter == 1 within 5
after 1 reset processor
after 3 send CFE_ES_NOOP
        expect tlm CFE_ES_HK_TLM ProcessorResets == 1 and CommandCounter == 1 within 10
        expect tlm CFE_ES_HK_TLM until 30
"""


def test_script_flies_as_a_procedure_with_the_exported_definitions(tmp_path: Path) -> None:
    (tmp_path / "steps.txt").write_text(SCRIPT, encoding="utf-8")
    folder = tmp_path / "plugin"
    assert main(["export", "cosmos", "lab", "--script", str(tmp_path / "steps.txt"), "-o", f"{folder}/"]) == 0
    names = sorted(each.relative_to(folder).as_posix() for each in folder.rglob("*") if each.is_file())
    assert names == [
        "openc3-cosmos-lab.gemspec",
        "plugin.txt",
        "targets/LAB/cmd_tlm/lab.txt",
        "targets/LAB/procedures/steps.py",
        "targets/LAB/target.txt",
    ]
    procedure = folder / "targets" / "LAB" / "procedures" / "steps.py"
    assert verdicts(fly(procedure, through_lab=False)) == [("steps::steps", "PASS")]
    text = procedure.read_text(encoding="utf-8").replace("PROCESSORRESETS == 1", "PROCESSORRESETS == 2")
    procedure.write_text(text, encoding="utf-8")
    assert verdicts(fly(procedure, through_lab=False)) == [("steps::steps", "FAIL")]


@pytest.mark.parametrize(
    ("line", "text"),
    [
        ("expect no event * ERROR", "an expectation of nothing has no counterpart"),
        ('expect console "x"', "this expectation has no counterpart"),
        ("set /a 1", "a step of ROS has no counterpart"),
    ],
)
def test_step_without_a_counterpart_is_refused_with_its_line(
    line: str, text: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "steps.txt"
    file.write_text(f"after 1 send CFE_ES_NOOP\n{line}\n", encoding="utf-8")
    assert main(["export", "cosmos", "lab", "--script", str(file), "-o", f"{tmp_path}/out/"]) == 2
    assert f"steps.txt:2: {text}" in capsys.readouterr().err
