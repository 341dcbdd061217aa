"""The help of each command: one screen, examples that the command accepts, and one place for options that all share."""

from __future__ import annotations

import shlex

import pytest

from cfepy.cli.main import ALIASES, main, parser_for
from cfepy.cli.parser import CommandParser, parsers_below
from tests.cli.parsers import whole

SCREEN = 45  # lines
WIDTH = 80
MOST_COMMANDS = 31
ELSEWHERE = ("rosbag record", "rosbag play", "rosbag fix")  # they only name another command
HELPS = {each.prog.removeprefix("cfepy").strip(): each for each in parsers_below(whole())}
COMMANDS = {words: each for words, each in HELPS.items() if words and words not in ELSEWHERE}


@pytest.fixture(autouse=True)
def _wide_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", str(WIDTH))


@pytest.mark.parametrize("words", COMMANDS)
def test_help_fits_one_screen(words: str) -> None:
    assert len(COMMANDS[words].format_help().splitlines()) <= SCREEN


@pytest.mark.parametrize("words", COMMANDS)
def test_help_begins_with_examples(words: str) -> None:
    shown = COMMANDS[words].format_help()
    places = [shown.index(f"\n  {example}\n") for example in COMMANDS[words].examples]
    assert len(places) >= (1 if " " in words else 2)
    assert max(places) < shown.index("options:")


@pytest.mark.parametrize(
    ("words", "example"), [(words, example) for words, each in COMMANDS.items() for example in each.examples]
)
def test_example_is_accepted(words: str, example: str) -> None:
    program, *given = shlex.split(example.partition(" > ")[0])
    assert program == "cfepy"
    assert given[: len(words.split())] == words.split()
    parser_for(given).parse_args(given)


def test_number_of_commands() -> None:
    top = {words for words in HELPS if words and " " not in words}
    assert len(top - ALIASES.keys()) <= MOST_COMMANDS


def test_help_of_cfepy_names_ros_names(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["help", "flying"]) == 0
    with pytest.raises(SystemExit):
        main(["--help"])
    shown = capsys.readouterr().out
    assert all(alias in shown for alias in ALIASES)


@pytest.mark.parametrize("alias", ALIASES)
def test_alias_takes_the_words_of_its_command(alias: str) -> None:
    words = COMMANDS[ALIASES[alias]].examples[0].split()[2:] if alias != "rossrv" else ["show", "std_srvs/SetBool"]
    chosen = parser_for([alias, *words]).parse_args([alias, *words])
    assert chosen.module == parser_for([ALIASES[alias], *words]).parse_args([ALIASES[alias], *words]).module


def test_shared_options_are_explained_in_one_place(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["help", "flying"]) == 0
    explained = capsys.readouterr().out
    for words, parser in COMMANDS.items():
        shown = parser.format_help()
        for group in parser.shared:
            for action in group._group_actions:
                assert f"\n  {action.option_strings[-1]}" in explained, words
                assert action.option_strings[-1] in shown, words


@pytest.mark.parametrize("words", ["run", "rostopic echo", "new faults"])
def test_help_command_prints_the_help_of_a_command(words: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["help", *words.split()])
    assert ended.value.code == 0
    assert capsys.readouterr().out == COMMANDS[words].format_help()


def test_help_command_alone_lists_the_commands(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["help"])
    assert capsys.readouterr().out == whole().format_help()


def test_help_command_suggests_a_command(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["help", "exlpore"])
    assert "did you mean explore?" in capsys.readouterr().err


def test_option_of_a_node_with_a_value_that_is_an_option_of_the_command() -> None:
    parser = CommandParser(prog="x")
    parser.add_argument("words", nargs="+")
    parser.add_argument("--list", nargs="?")
    parser.add_argument("--seed", type=int)
    parser.is_for_nodes = bool
    found = parser.parse_args(["n.py", "--seed", "-3", "--list", "-v", "--level=9", "a", "--", "--seed", "4"])
    assert (found.seed, found.list) == (-3, None)
    assert found.words == ["n.py", "-v", "--level=9", "a", "--seed", "4"]
