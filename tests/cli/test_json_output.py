"""`--json -`: only JSON on standard output, whatever a command prints; with a file, both."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from cfepy.cli.main import main
from dev.convert.ping import ping_package
from tests.cli.parsers import options, parsers
from tests.extra.c.trees.small_trees import write_tree

DATA = Path(__file__).parents[1] / "data"
EXAMPLES = Path(__file__).parents[2] / "examples"
LAB = ["lab", "--for", "0.7"]
LINES = ("tlm", "rostopic echo")  # an object a line
COMMANDS: dict[str, list[str]] = {
    "run": ["run", *LAB],
    "sweep": ["sweep", *LAB, "--quiet", "--jobs", "1"],
    "board report": ["board", "report", *LAB],
    "explore": ["explore", *LAB, "--seeds", "1", "--jobs", "1", "--no-stuck"],
    "procedures": ["procedures", "{examples}/procedures/lab_suite.py", "lab"],
    "graph --mids": ["graph", "--mids", *LAB],
    "build": ["build", "{tree}", "-o", "{made}"],
    "check": ["check", "lab"],
    "convert": ["convert", "{ping}/launch/ping.launch", "--no-check", "-o", "{made}"],
    "graph": ["graph", *LAB],
    "tlm": ["tlm", *LAB],
    "log": ["log", "{data}/cfe_evs.log"],
    "tbl show": ["tbl", "show", "{data}/sample_app_tbl.tbl"],
    "board list": ["board", "list"],
    "rosbag verify": ["rosbag", "verify", "{data}/bags/golden_api_bz2.bag"],
    "rosbag recover": ["rosbag", "recover", "{data}/bags/golden_api_bz2.bag", "-o", "{made}.bag"],
    "rosbag convert": ["rosbag", "convert", "{data}/bags/golden_api_bz2.bag", "-o", "{made}.mcap"],
    "rostopic list": ["rostopic", "list", *LAB],
    "rosservice list": ["rosservice", "list", *LAB],
}
FLOWN_ALIKE = (
    "launch",
    "roslaunch",
    "node",
    "rosrun",
    "replay",
    "rostopic ",
    "rosservice ",
)  # for nodes; they print and write as those above


@pytest.mark.parametrize("command", COMMANDS)
def test_nothing_else_is_on_standard_output(command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    ping = ping_package(tmp_path) if command == "convert" else None
    tree = tmp_path / "tree"
    if command == "build":
        write_tree(tree)
    places = {"data": DATA, "examples": EXAMPLES, "ping": ping, "tree": tree, "made": tmp_path / "made"}
    main([word.format(**places) for word in COMMANDS[command]] + ["--json", "-"])
    out = capsys.readouterr().out
    for text in out.splitlines() if command in LINES else [out]:
        json.loads(text)


@pytest.mark.parametrize("command", ["tlm", "log", "graph --mids"])
def test_with_a_file_the_text_is_shown_as_well(
    command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "found.json"
    main([word.format(data=DATA) for word in COMMANDS[command]] + ["--json", str(file)])
    assert json.loads(
        file.read_text(encoding="utf-8").splitlines()[0] if command in LINES else file.read_text(encoding="utf-8")
    )
    assert capsys.readouterr().out


def test_every_command_that_writes_json_is_here() -> None:
    writers = {words for words, parser in parsers().items() if any(each.dest == "json" for each in options(parser))}
    assert {words for words in writers if not words.startswith(FLOWN_ALIKE)} <= set(COMMANDS)
