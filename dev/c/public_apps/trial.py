"""A trial of a mission: build it at once and with its options, and fly each of its applications alone."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

from cfepy.es import CFE_LIB, StartupEntry, entries
from cfepy.extra.c.trees import is_tree
from cfepy.extra.c.trees.mission_folder import functions_of
from cfepy.extra.c.trees.startup_scripts import made_startup
from dev.c.public_apps.flight import SCRIPT, fly
from dev.c.public_apps.missions import PublicMission
from dev.c.public_apps.results import ANSWERS, AT_ONCE, LIBRARY, NOT_BUILT, NOT_FLOWN, RUNS, WITH_OPTION, Result
from dev.corpus.sources import Sources

BUILT, STANDS_IN = "built", "stands in"
FIRST_PORT = 15000
_NOT_MODULES = (".c", ".scr", ".yaml", ".tbl", ".py", ".json", ".txt", ".ini")


class Trial(NamedTuple):
    """An application or library of a mission after its build.

    Attributes:
        mission: its mission.
        app: its name.
        built: one of the words for the build.
        folder: a mission folder in which it is the last application, after the libraries of its mission; None if it
            cannot fly.
        flown: `LIBRARY` for a library, which does not fly alone, otherwise `NOT_FLOWN`.
        reason: why it cannot fly.
    """

    mission: PublicMission
    app: str
    built: str
    folder: Path | None = None
    flown: str = NOT_FLOWN
    reason: str = ""


def try_mission(mission: PublicMission, sources: Sources) -> Iterator[Result]:
    """Build a mission and fly its applications.

    Yields:
        A result for each application and library of it that counts.
    """
    with tempfile.TemporaryDirectory() as folder:
        for each in build_mission(mission, sources, Path(folder)):
            yield _flight(each, Path(folder))


def build_mission(
    mission: PublicMission, sources: Sources, scratch: Path, environment: Mapping[str, str] | None = None
) -> Iterator[Trial]:
    """Build a mission.

    Args:
        mission: the mission.
        sources: the folder with its sources.
        scratch: an empty folder for sources and results.
        environment: more variables of `cfepy build`, such as CC.

    Yields:
        A trial for each application and library of it that counts.
    """
    source = mission.lay_out(sources, scratch)
    build = _Build(environment or {})
    options = [*mission.place_options(scratch), *mission.options]
    if is_tree(source, str(scratch / mission.repo.rpartition("/")[2] / mission.defs) if mission.defs else None):
        yield from _build_tree(build, mission, source, options, scratch)
    else:
        yield _build_app(build, mission, source, options, scratch)


class _Build(NamedTuple):
    """Runs `cfepy build` with more variables in its environment."""

    environment: Mapping[str, str]

    def run(self, source: Path, target: Path, options: list[str]) -> tuple[int, str]:
        """Build a folder. Returns the exit status and the output."""
        command = [sys.executable, "-m", "cfepy", "build", str(source), "-o", str(target), *options]
        done = subprocess.run(command, capture_output=True, text=True, env={**os.environ, **self.environment})
        return done.returncode, done.stdout + done.stderr

    def tree(self, source: Path, target: Path, options: list[str]) -> dict[str, tuple[str, str]]:
        """Build a tree. Returns the result and the text of each module."""
        report = target.with_suffix(".json")
        _, said = self.run(source, target, [*options, "--json", str(report)])
        if not report.is_file():
            print(f"{source.name}: {said.strip()[-300:]}", file=sys.stderr)
            return {}
        lines = json.loads(report.read_text(encoding="utf-8"))["entries"]
        return {
            each["name"]: (each["result"], each["text"])
            for each in lines
            if not each["name"].endswith(_NOT_MODULES) and "file of the tree" not in each["text"]
        }


def _build_app(build: _Build, mission: PublicMission, source: Path, options: list[str], scratch: Path) -> Trial:
    name = source.name if source.name != "fsw" else source.parent.name
    made = scratch / "made"
    built = AT_ONCE
    made.mkdir()
    status, said = build.run(source, made / f"{name}.so", [])
    if status and options:
        built = WITH_OPTION
        status, said = build.run(source, made / f"{name}.so", options)
    if status:
        return Trial(mission, name, NOT_BUILT, reason=_reason(said, scratch))
    others = [scratch / mission.repo.rpartition("/")[2] / each for each in mission.libraries]
    for each in others:
        build.run(each, made / f"{each.name}.so", options)
    tables = [f"{each.stem}" for each in made.glob("*.tbl")]
    libraries = [(each.name, functions_of(made / f"{each.name}.so"), list[str]()) for each in others]
    script = made_startup([*libraries, (name, functions_of(made / f"{name}.so"), _owners(made, tables))])
    (made / SCRIPT).write_bytes(script.text)
    (made / "apps").mkdir()
    for table in made.glob("*.tbl"):  # applications of cFS 6 open them in /cf/apps
        shutil.copy(table, made / "apps")
    return _alone(mission, name, built, made, entries(script.text), scratch)


def _owners(made: Path, tables: list[str]) -> list[str]:
    """Return the full names of the tables in a folder."""
    from cfepy.tbl import read

    return [read((made / f"{each}.tbl").read_bytes()).name for each in tables]


def _build_tree(
    build: _Build, mission: PublicMission, source: Path, options: list[str], scratch: Path
) -> Iterator[Trial]:
    places = mission.place_options(scratch)
    first, last = scratch / "first", scratch / "last"
    at_once = build.tree(source, first, places)
    found = build.tree(source, last, options) if mission.options else at_once
    folder = last if mission.options else first
    script = entries((folder / SCRIPT).read_bytes()) if (folder / SCRIPT).is_file() else []
    libraries = _libraries(script, folder)
    for name, (result, text) in found.items():
        if not mission.counts(name):
            continue
        if result != BUILT:
            reason = "not in the tree" if result == STANDS_IN else _reason(text, scratch)
            yield Trial(mission, name, NOT_BUILT, reason=reason)
            continue
        is_first = at_once.get(name, ("", ""))[0] == BUILT and not places
        built = AT_ONCE if is_first else WITH_OPTION
        own = [each for each in script if Path(_file(each)).stem == name]
        library = next(iter(folder.rglob(f"{name}.so")))
        if not own:
            own = in_definitions(scratch / mission.repo.rpartition("/")[2] / mission.defs, name) if mission.defs else []
        if not own:
            own = entries(made_startup([(name, functions_of(library), [])]).text)
        used = [each for each in libraries if Path(_file(each)).stem != name]
        yield _alone(mission, name, built, folder, [*used, *own[:1]], scratch)


def in_definitions(folder: Path, name: str) -> list[StartupEntry]:
    """Return the entries of an application in the startup scripts of a folder, also those behind the end of a script.

    NOS3 moves some of them before the end when it is configured. An entry that is made up may have the name of a task.
    """
    found = []
    for file in sorted(folder.rglob("*.scr")):
        lines = [each for each in file.read_bytes().splitlines() if each.startswith(b"CFE_")]
        found += [each for each in entries(b"\n".join(lines)) if Path(_file(each)).stem == name]
    return found


def _libraries(script: list[StartupEntry], folder: Path) -> list[StartupEntry]:
    """Return the libraries of a startup script that were built, then those that it does not name."""
    named = [each for each in script if each.kind == CFE_LIB and (folder / _file(each)).is_file()]
    others: list[tuple[str, list[str], list[str]]] = [
        (each.stem, functions_of(each), []) for each in sorted(folder.glob("*.so"))
    ]
    known = {Path(_file(each)).stem for each in named}
    made = entries(made_startup(others).text)
    return [*named, *(each for each in made if each.kind == CFE_LIB and Path(_file(each)).stem not in known)]


def _alone(
    mission: PublicMission, name: str, built: str, folder: Path, script: list[StartupEntry], scratch: Path
) -> Trial:
    """Return an application in a copy of a mission folder with this startup script."""
    if not script:
        return Trial(mission, name, built, reason="no entry point was found")
    if script[-1].kind == CFE_LIB:
        return Trial(mission, name, built, flown=LIBRARY)
    alone = scratch / "alone" / name
    shutil.copytree(folder, alone)
    lines = [
        f"{each.kind}, {each.file}, {each.symbol}, {each.name}, {each.priority}, {each.stack_size}, 0x0, 0;"
        for each in script
    ]
    (alone / SCRIPT).write_text("\n".join((*lines, "!", "")), encoding="utf-8")
    return Trial(mission, name, built, alone)


def _flight(trial: Trial, scratch: Path) -> Result:
    mission, name, built = trial.mission, trial.app, trial.built
    if trial.folder is None:
        return Result(mission.name, name, built, trial.flown, trial.reason)
    if mission.devices:
        with (trial.folder / "mission.yaml").open("a", encoding="utf-8") as text:
            text.write("devices:\n")
            for port, each in enumerate(mission.devices, FIRST_PORT):
                text.write(f"  {each}: {{udp: {port}, to: 127.0.0.1:{port + len(mission.devices)}}}\n")
    flown = fly(trial.folder)
    if not flown.runs:
        return Result(mission.name, name, built, NOT_FLOWN, _plain(flown.reason, scratch) or "it ended")
    if flown.answers:
        return Result(mission.name, name, built, ANSWERS, _plain(flown.answers[0], scratch))
    return Result(mission.name, name, built, RUNS, "")


def _file(entry: StartupEntry) -> str:
    return entry.path.removeprefix("/cf/")


def _reason(said: str, scratch: Path) -> str:
    lines = said.splitlines()
    first = next((each for each in lines if "error" in each or "cfepy: " in each), lines[0] if lines else "")
    return _plain(first, scratch)


def _plain(text: str, scratch: Path) -> str:
    text = text.replace(f"{scratch}/", "").removeprefix("cfepy: ")
    text = re.sub(r"^\d{4}-\d{3}-[\d:.]+ |^EVS Port1 \S+ \S+ ", "", text)
    return re.sub(r"\s+", " ", re.sub(r"0x[0-9a-f]{6,}", "0x...", text)).strip()[:160]
