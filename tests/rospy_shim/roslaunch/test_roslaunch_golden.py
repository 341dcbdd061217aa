"""Launch files have the same meaning as in roslaunch: parameters, nodes, tests, and refused files.

The results of roslaunch 1.15 for each file were recorded with its own XmlLoader (tests/data/roslaunch_golden.json).
"""

from __future__ import annotations

import json
from pathlib import Path
from random import Random
from typing import Any

import pytest

from cfepy.reading.mistakes import Mistakes
from cfepy.status import UsageError
from rospy_shim.roslaunch.model import Launch, LaunchNode
from rospy_shim.roslaunch.reader import read
from rospy_shim.types.msgs import Packages

GOLDEN = json.loads((Path(__file__).parents[2] / "data/roslaunch_golden.json").read_text(encoding="utf-8"))
CASES = {case["name"]: case for case in GOLDEN["cases"]}
ENVIRON = {"LAUNCH_TEST": "out there"}


def read_case(case: dict[str, Any], folder: Path, mistakes: Mistakes | None = None) -> Launch:
    for name, text in GOLDEN["files"].items():
        (folder / name).write_bytes(text.encode())
    file = folder / "main.launch"
    file.write_text(case["text"], encoding="utf-8")
    args = dict(arg.split(":=") for arg in case["args"])
    return read(file, args, Packages(file, ENVIRON), ENVIRON, mistakes)


def as_recorded(launch: Launch, folder: Path) -> dict[str, Any]:
    """Return the read data in the form of the recording."""
    tests = [
        {**node_of(test.node), "tn": test.test_name, "tl": test.time_limit, "retry": test.retry}
        for test in launch.tests
    ]
    found = {
        "params": [[name, value_of(value)] for name, value in sorted(launch.params.items())],
        "nodes": [without_defaults(node_of(node)) for node in launch.nodes],
        "tests": [without_defaults(test) for test in tests],
    }
    return dict(json.loads(json.dumps(found).replace(str(folder), "DIR")))


def value_of(value: Any) -> Any:
    return {"bytes": value.hex()} if isinstance(value, bytes) else value


def node_of(node: LaunchNode) -> dict[str, Any]:
    return {
        "name": node.name,
        "ns": node.namespace,
        "args": node.args,
        "remaps": [list(remap) for remap in node.remaps],
        "env": dict(node.env),
        "output": node.output,
        "cwd": node.cwd,
        "respawn": node.respawn,
        "delay": node.respawn_delay,
        "required": node.required,
    }


def without_defaults(fields: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in fields.items() if value}


@pytest.mark.parametrize("name", [name for name, case in CASES.items() if case["expected"] is not None])
def test_launch_file_has_the_recorded_meaning(name: str, tmp_path: Path) -> None:
    assert as_recorded(read_case(CASES[name], tmp_path), tmp_path) == CASES[name]["expected"]


@pytest.mark.parametrize("name", [name for name, case in CASES.items() if case["expected"] is None])
def test_invalid_launch_file_is_refused_with_its_line(name: str, tmp_path: Path) -> None:
    with pytest.raises(UsageError) as raised:
        read_case(CASES[name], tmp_path)
    assert raised.value.file is not None
    assert raised.value.line == 1
    assert raised.value.text


def test_findings_of_a_check_include_the_error_of_a_run(tmp_path: Path) -> None:
    """This includes damaged files. Files that a run accepts have no mistake."""
    random = Random(3)
    seen = {True: 0, False: 0}
    for case in (damaged(case, random) for case in GOLDEN["cases"][::2]):
        kept = Mistakes()
        read_case(case, tmp_path, kept)
        refused = error_of(case, tmp_path)
        assert refused in (list(map(str, kept.errors)) or [None]), case["text"]
        seen[refused is None] += 1
    assert min(seen.values()) > 5


def damaged(case: dict[str, Any], random: Random) -> dict[str, Any]:
    """Return a case whose text lacks one or two characters, or none."""
    text = case["text"]
    for _ in range(random.randrange(3)):
        at = random.randrange(len(text))
        text = text[:at] + text[at + 1 :]
    return {**case, "text": text}


def error_of(case: dict[str, Any], folder: Path) -> str | None:
    try:
        read_case(case, folder)
    except UsageError as error:
        return str(error)
    return None
