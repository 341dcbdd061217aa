"""`cfepy rosparam`: the ROS parameters of a mission, and the table files that hold them."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from cfepy.cli.json_output import write_text
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS
from cfepy.cli.options import plan_of, refuse_run_options
from cfepy.cli.text_table import print_lines
from cfepy.cli.user_notes import tell, tell_briefly, writing
from cfepy.ground.parameters import Parameters, at_start, changed, is_source_of_files, of_files, present, table_files
from cfepy.pilot import never_happened, takeoff
from cfepy.reading.plain_yaml import YamlError, plain_yaml
from cfepy.reading.suggestions import did_you_mean
from cfepy.status import UsageError


def run(arguments: argparse.Namespace) -> int:
    """Carry out the action on parameters that the command line names.

    Returns:
        The exit status: 1 if there is no such parameter.

    Raises:
        UsageError: there is no such mission, it cannot boot, or a file is wrong.
    """
    action: Callable[[argparse.Namespace], int] = ACTIONS[arguments.action]
    return action(arguments)


# -- show --------------------------------------------------------------------------------------------------------------


def _parameters(arguments: argparse.Namespace) -> Parameters:
    source: str = arguments.source
    if is_source_of_files(source):
        problems: list[str] = []
        refuse_run_options(arguments, f"only valid for a mission, and {source} is a parameter file; leave it out")
        found = of_files(Path(source), problems)
        tell(problems)
        return found
    plan = plan_of(arguments, [source])
    if plan.seconds is not None or plan.script is not None:
        with takeoff(plan) as run:
            tell_briefly(run.notes)
            run.run_until(run.course.until_ns)
            tell([*run.problems(), *never_happened(run.mission)])
            return present(run.mission)
    refuse_run_options(arguments, "requires a mission that runs; say how long, such as --for 5", but=["launch_args"])
    unknown: list[str] = []
    found = at_start(plan.spec(), unknown)
    tell([f"{app} sets parameters under a name that only a run shows; add --for SECONDS" for app in unknown])
    return found


def _list(arguments: argparse.Namespace) -> int:
    parameters = _parameters(arguments)
    names = parameters.names(_full(arguments.name))
    print_lines(names)
    return ENDED_WELL if names or arguments.name is None else _missing(arguments.name, parameters)


def _get(arguments: argparse.Namespace) -> int:
    parameters = _parameters(arguments)
    value = parameters.find(_full(arguments.name))
    if value is None:
        return _missing(arguments.name, parameters)
    sys.stdout.write(_yaml(value))
    return ENDED_WELL


def _dump(arguments: argparse.Namespace) -> int:
    parameters = _parameters(arguments)
    value = parameters.find(_full(arguments.name))
    if value is None:
        return _missing(arguments.name, parameters)
    write_text(arguments.output, _yaml(value), "--output", arguments)
    return ENDED_WELL


def _full(name: str | None) -> str:
    return "/" + (name or "").strip("/")


def _missing(name: str, parameters: Parameters) -> int:
    names = parameters.names()
    others = f"there are {len(names)} others, which `cfepy rosparam list` shows" if names else "there is none"
    tell([f"unknown parameter {_full(name)}{did_you_mean(_full(name), names, others, before='; ')}"])
    return FOUND_PROBLEMS


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
    """Change table files in place. With --output, write the changed ones there and keep the originals."""
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
    """Parse a value as `rosparam set` does."""
    from cfepy.mission.parameter_files import checked

    try:
        return checked(plain_yaml(text))
    except YamlError as error:
        raise UsageError(f"{text!r} {error}", field="VALUE") from None


def _write(path: Path, data: bytes) -> None:
    with writing(path, "--output"):
        path.write_bytes(data)
    print(f"{path}: {len(data)} bytes")


ACTIONS = {"list": _list, "get": _get, "dump": _dump, "set": _set, "delete": _delete, "build": _build}
