"""`cfepy param`: the ROS parameters of a mission, and the table files that hold them."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from cfepy.cli.failures import booting, writing
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS
from cfepy.mission import read_mission
from cfepy.mission.parameters import Parameters, after, at_start, changed, is_source_of_files, of_files, table_files
from cfepy.status import UsageError


def run(arguments: argparse.Namespace) -> int:
    """Do what the command line asks of parameters.

    Returns:
        The exit status: 1 when there is no such parameter.

    Raises:
        UsageError: no such mission, a mission that cannot boot, or a wrong file.
    """
    action: Callable[[argparse.Namespace], int] = ACTIONS[arguments.action]
    return action(arguments)


# -- show --------------------------------------------------------------------------------------------------------------


def _parameters(arguments: argparse.Namespace) -> Parameters:
    source: str = arguments.source
    if is_source_of_files(source):
        problems: list[str] = []
        found = of_files(Path(source), problems)
        _tell(problems)
        return found
    spec = read_mission(source, dict(arguments.launch_args))
    if arguments.seconds is not None:
        with booting(spec.script):
            return after(spec, arguments.seconds, arguments.board)
    unknown: list[str] = []
    found = at_start(spec, unknown)
    _tell([f"{app} has parameters of its own, under a name that it gives itself; see --for" for app in unknown])
    return found


def _list(arguments: argparse.Namespace) -> int:
    names = _parameters(arguments).names(_full(arguments.name))
    for name in names:
        print(name)
    return ENDED_WELL if names or arguments.name is None else _missing(arguments.name)


def _get(arguments: argparse.Namespace) -> int:
    value = _parameters(arguments).find(_full(arguments.name))
    if value is None:
        return _missing(arguments.name)
    sys.stdout.write(_yaml(value))
    return ENDED_WELL


def _dump(arguments: argparse.Namespace) -> int:
    value = _parameters(arguments).find(_full(arguments.name))
    if value is None:
        return _missing(arguments.name)
    if arguments.output is None:
        sys.stdout.write(_yaml(value))
        return ENDED_WELL
    with writing(arguments.output, "--output"):
        Path(arguments.output).write_text(_yaml(value), encoding="utf-8")
    return ENDED_WELL


def _full(name: str | None) -> str:
    return "/" + (name or "").strip("/")


def _missing(name: str) -> int:
    _tell([f"there is no parameter {_full(name)}"])
    return FOUND_PROBLEMS


def _tell(problems: list[str]) -> None:
    sys.stdout.flush()
    for problem in problems:
        print(f"cfepy: {problem}", file=sys.stderr)


def _yaml(value: Any) -> str:
    import yaml

    text: str = yaml.safe_dump(value, default_flow_style=False, sort_keys=False, allow_unicode=True, width=120)
    return text.removesuffix("...\n")


# -- table files -------------------------------------------------------------------------------------------------------


def _set(arguments: argparse.Namespace) -> int:
    return _change(arguments, _value(arguments.value))


def _delete(arguments: argparse.Namespace) -> int:
    return _change(arguments, None)


def _change(arguments: argparse.Namespace, value: Any) -> int:
    """Change table files in place, or with --output leave them alone and write those that change there."""
    files = changed(Path(arguments.file), _full(arguments.name), value)
    for path, data in files.items():
        target = path if arguments.output is None else _folder(arguments.output) / path.name
        _write(target, data)
    if not files:
        print("nothing changes")
    return ENDED_WELL


def _build(arguments: argparse.Namespace) -> int:
    source = Path(arguments.file)
    folder = source.parent if arguments.output is None else _folder(arguments.output)
    for name, data in table_files(source, arguments.mission).items():
        _write(folder / name, data)
    return ENDED_WELL


def _folder(name: str) -> Path:
    with writing(name, "--output"):
        Path(name).mkdir(parents=True, exist_ok=True)
    return Path(name)


def _value(text: str) -> Any:
    """A value as `rosparam set` reads it."""
    import yaml

    from cfepy.mission.parameter_files import checked

    try:
        value = yaml.safe_load(text)
    except yaml.YAMLError as error:
        raise UsageError(f"{text!r} is not YAML: {error}", field="VALUE") from None
    return checked(value)


def _write(path: Path, data: bytes) -> None:
    with writing(path, "--output"):
        path.write_bytes(data)
    print(f"{path}: {len(data)} bytes")


ACTIONS = {"list": _list, "get": _get, "dump": _dump, "set": _set, "delete": _delete, "build": _build}
