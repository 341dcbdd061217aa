"""`--faults` of the commands that run missions, `cfepy new faults`, and `cfepy check --faults`."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import yaml

from cfepy.cli.main import main

PLAN = """
faults:
  - crash: SAMPLE_APP
    at: 2
  - drop: CFE_TIME_ONEHZ_CMD
    count: 7
  - drop: /nothing
"""


@pytest.fixture
def plan(tmp_path: Path) -> Path:
    path = tmp_path / "plan.yaml"
    path.write_text(PLAN, encoding="utf-8")
    return path


def test_a_run_with_faults_reports_them(plan: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    numbers = tmp_path / "numbers.json"
    assert (
        main(["run", "lab", "--for", "10", "--faults", str(plan), "--json", str(numbers)]) == 0
    )  # an injected crash is not a problem
    out, err = capsys.readouterr()
    assert "cfepy fault crash-1: crashes SAMPLE_APP" in out
    assert "SAMPLE_APP: task SAMPLE_APP died of an exception" in out
    assert out.count("cfepy fault drop-1: ") == 5
    assert "(later ones are in the trace and in the report)" in out
    table = out[out.index("\nFaults\n") :]
    assert "crash SAMPLE_APP" in table
    assert "never happened: no matching message was delivered" in table
    assert "cfepy: fault drop-2 (drop /nothing) never happened: no matching message was delivered" in err
    rows = {row["name"]: row for row in json.loads(numbers.read_text(encoding="utf-8"))["faults"]}
    assert rows["crash-1"]["at_s"] == [2.0]
    assert rows["crash-1"]["never"] is None
    assert rows["drop-1"]["times"] == 7 == len(rows["drop-1"]["at_s"])
    assert rows["drop-2"]["times"] == 0


def test_every_fault_is_in_the_trace(plan: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "trace.txt"
    main(["run", "lab", "--for", "10", "--no-console", "--faults", str(plan), "--trace", str(file)])
    lines = [line for line in file.read_text(encoding="utf-8").splitlines() if "cfepy fault" in line]
    assert sum("fault drop-1: drops CFE_TIME_ONEHZ_CMD" in line for line in lines) == 7
    assert sum("fault crash-1: crashes SAMPLE_APP" in line for line in lines) == 1


def test_a_run_without_faults_has_no_table(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    numbers = tmp_path / "numbers.json"
    assert main(["run", "lab", "--for", "2", "--no-console", "--json", str(numbers)]) == 0
    assert "Faults" not in capsys.readouterr().out
    assert json.loads(numbers.read_text(encoding="utf-8"))["faults"] == []


def test_bad_plans_are_bad_usage(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "bad.yaml"
    path.write_text("- drop: /a\n  cuont: 3\n", encoding="utf-8")
    assert main(["run", "lab", "--faults", str(path)]) == 2
    assert f"{path}:2: [0].cuont: unknown option of drop; did you mean count?" in capsys.readouterr().err
    assert main(["run", "lab", "--faults", "seed:x"]) == 2
    assert "--faults: invalid value 'seed:x'" in capsys.readouterr().err
    assert main(["run", "lab", "--faults", str(tmp_path / "none.yaml")]) == 2


def test_an_unknown_application_is_told_before_the_run(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "plan.yaml"
    path.write_text("- crash: SAMPLE_AP\n  at: 1\n", encoding="utf-8")
    assert main(["run", "lab", "--for", "1", "--no-console", "--faults", str(path)]) == 0
    assert "unknown application SAMPLE_AP; did you mean SAMPLE_APP?" in capsys.readouterr().err


def test_a_command_of_a_script_gets_lost(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    script, path = tmp_path / "checks.txt", tmp_path / "plan.yaml"
    noop = "send CFE_ES_NOOP\nexpect event CFE_ES 3 within 1\n"
    script.write_text(f"at 2 {noop}after 1 {noop}", encoding="utf-8")
    path.write_text("- {drop: CFE_ES_NOOP, from: host, number: 1}\n", encoding="utf-8")
    assert main(["run", "lab", "--no-console", "--script", str(script), "--faults", str(path)]) == 1
    out, err = capsys.readouterr()
    assert "drops CFE_ES_NOOP #0 sent by host" in out
    assert "no application" not in err
    assert [line.split()[0] for line in out.splitlines() if "CFE_ES 3" in line] == ["FAILED", "ok"]


@pytest.mark.slow
def test_check_compares_a_plan_with_the_mission(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "plan.yaml"
    path.write_text(
        "- drop: /motor_comand\n- {crash: HKK, at: 1}\n- {fill: HK_CMD_PIP, at: 1}\n"
        "- {corrupt_table: HK.CopyTabl, at: 1}\n- {corrupt_file: /cf/hk_cpy.tbl}\n"
        "- {drop: /phase, to: ARMM}\n- {fail: os.write, app: HKX}\n- {drop: [0x0911, CFE_ES_NOOP, '/joint*']}\n",
        encoding="utf-8",
    )
    assert main(["check", "capture", "--faults", str(path)]) == 1
    out = capsys.readouterr().out
    for line, meant in enumerate(
        ("/motor_command", "HK", "HK_CMD_PIPE", "HK.CopyTable", "/cf/hk_cpy_tbl.tbl", "ARM", "HK"), start=1
    ):
        assert f"plan.yaml:{line}: " in out
        assert f"did you mean {meant}?" in out
    assert "7 problems found" in out
    path.write_text("- drop: /phase\n  every: x\n", encoding="utf-8")
    assert main(["check", "capture", "--faults", str(path)]) == 1
    assert "plan.yaml:2: [0].every: " in capsys.readouterr().out


@pytest.mark.slow
def test_the_command_lists_targets_and_makes_plans(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert main(["new", "faults", "lab"]) == 0
    out = capsys.readouterr().out
    assert "SAMPLE_APP_HK_TLM" in out
    assert "HK.CopyTable" in out
    assert "SAMPLE_APP" in out
    assert main(["new", "faults", "lab", "--seed", "7", "--intensity", "high"]) == 0
    text = capsys.readouterr().out
    assert len(yaml.safe_load(text)["faults"]) == 12
    path = tmp_path / "seven.yaml"
    path.write_text(text, encoding="utf-8")
    traces = []
    for faults in (str(path), "seed:7:high"):
        main(["run", "lab", "--for", "11", "--no-console", "--faults", faults])
        traces.append(capsys.readouterr().out.splitlines()[-2])
    assert traces[0] == traces[1]


def test_a_single_node_with_faults(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    node = tmp_path / "beat.py"
    node.write_text(
        "import rospy\nrospy.init_node('beat')\nprint('begins', flush=True)\nrospy.spin()\n", encoding="utf-8"
    )
    plan = tmp_path / "plan.yaml"
    plan.write_text("- crash: BEAT\n  at: 2\n- drop: /none\n", encoding="utf-8")
    assert main(["node", "--for", "5", "--faults", str(plan), str(node)]) == 139
    out, err = capsys.readouterr()
    assert "begins" in out
    assert "cfepy fault crash-1: crashes BEAT" in err
    assert "fault drop-1 (drop /none) never happened" in err


@pytest.mark.slow
def test_a_launch_file_with_faults(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "beat.py").write_text(
        "#!/usr/bin/env python3\nimport rospy\nrospy.init_node('beat')\nrospy.spin()\n", encoding="utf-8"
    )
    (tmp_path / "beat.py").chmod(0o755)
    (tmp_path / "package.xml").write_text("<package><name>beats</name></package>", encoding="utf-8")
    launch = tmp_path / "beat.launch"
    launch.write_text(
        '<launch><node pkg="beats" type="beat.py" name="beat" respawn="true"/></launch>', encoding="utf-8"
    )
    plan = tmp_path / "plan.yaml"
    plan.write_text("- crash: /beat\n  at: 2\n", encoding="utf-8")
    main(["launch", "--for", "4", "--faults", str(plan), str(launch)])
    out = capsys.readouterr().out
    assert "cfepy fault crash-1: crashes BEAT" in out
    assert "/beat  running         1" in out
    assert "crash /beat" in out[out.index("\nFaults\n") :]


def test_a_recorded_run_with_faults_replays(plan: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    journal = tmp_path / "run.cfepy"
    main(["run", "lab", "--for", "5", "--no-console", "--faults", str(plan), "--record", str(journal)])
    first = capsys.readouterr().out.splitlines()[-2]
    main(["replay", str(journal), "--no-console"])
    assert first in capsys.readouterr().out
