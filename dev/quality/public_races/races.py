"""The list of public races (races.yaml), and the mission that flies each of them.

A mission of ours stimulates the public code: a folder in `missions` with a startup script. The public files are copied
into it unmodified, once as they were before the fix and once with it.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

import yaml

from cfepy.status import UsageError
from dev.corpus.sources import Sources

FILE = Path(__file__).with_name("races.yaml")
MISSIONS = Path(__file__).with_name("missions")
FETCH = "python -m dev.quality.public_races fetch FOLDER"
BEFORE, AFTER = "before", "after"
_NOTHING: Mapping[str, str] = {}


@dataclass(frozen=True, slots=True)
class PublicRace:
    """A race of public software.

    Attributes:
        name: its name here.
        repo: its repository, "owner/name" on GitHub.
        report: the issue, pull request or ticket, or else the subject of the commit that mends it.
        text: the mistake.
        before: the last commit with the mistake.
        after: the commit without it.
        files: the files that the fix changes.
        places: where in the mission's folder the files and folders of the repository go.
        mission: name of the mission's folder; the race's name if empty.
        build: arguments of `cfepy build`, executed in the mission's folder; empty if nothing is compiled.
        seconds: virtual seconds of a flight.
        options: options of `cfepy explore` to try if the defaults find nothing.
        reason: why it cannot be flown, or which decision the search lacks.
    """

    name: str
    repo: str
    report: str
    text: str
    before: str
    after: str
    files: tuple[str, ...]
    places: Mapping[str, str] = field(default_factory=lambda: _NOTHING)
    mission: str = ""
    build: tuple[str, ...] = ()
    seconds: float = 3
    options: tuple[str, ...] = ()
    reason: str = ""

    @property
    def flies(self) -> bool:
        """Whether there is a mission for it."""
        return bool(self.places)

    def commit(self, form: str) -> str:
        """Return the commit of a form, BEFORE or AFTER."""
        return self.before if form == BEFORE else self.after

    def lay_out(self, sources: Path, form: str, target: Path, missions: Path = MISSIONS) -> Path:
        """Write the mission with the public files of one form, and compile them if they are in C.

        Args:
            sources: the folder of `fetch`.
            form: BEFORE or AFTER.
            target: a folder in which the mission's folder is made.
            missions: the folder with all missions.

        Raises:
            UsageError: the sources are missing, or do not compile.
        """
        folder = target / self.name
        shutil.copytree(missions / (self.mission or self.name), folder)
        root = snapshot(sources, self.commit(form)).folder(self.repo)
        if not root.is_dir():
            raise UsageError(f"no sources of {self.repo}; run `{FETCH}`", file=str(root))
        for source, place in self.places.items():
            (folder / place).parent.mkdir(parents=True, exist_ok=True)
            if (root / source).is_dir():
                shutil.copytree(root / source, folder / place, dirs_exist_ok=True)
            else:
                shutil.copy(root / source, folder / place)
        if self.build:
            command = [sys.executable, "-m", "cfepy", "build", *self.build]
            done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
            if done.returncode:
                raise UsageError(
                    f"{self.name} does not compile: {(done.stdout + done.stderr)[-500:]}", file=str(folder)
                )
        return folder


class PublicRaces(NamedTuple):
    """All races by name, and the licence of each repository."""

    races: Mapping[str, PublicRace]
    licences: Mapping[str, str]

    def chosen(self, names: list[str]) -> list[PublicRace]:
        """Return the races with these names, or all if none are given.

        Raises:
            UsageError: there is no such race.
        """
        for name in names:
            if name not in self.races:
                raise UsageError(f"unknown race {name}; expected a name in {FILE.name}", file=str(FILE))
        return [each for each in self.races.values() if not names or each.name in names]

    def fetch(self, folder: Path, mirrors: Path | None) -> list[str]:
        """Fetch each form of all races that fly. Returns the repositories and commits that were missing."""
        wanted = {
            (each.repo, each.commit(form)): None
            for each in self.races.values()
            if each.flies
            for form in (BEFORE, AFTER)
        }
        return [f"{repo} {commit}" for repo, commit in wanted if snapshot(folder, commit).fetch(repo, commit, mirrors)]


def snapshot(folder: Path, commit: str) -> Sources:
    """Return the sources at a commit: each has a folder of its own, since a race has two of one repository."""
    return Sources(folder / commit[:10])


def read_races(file: Path = FILE) -> PublicRaces:
    """Read a list of races."""
    root: dict[str, Any] = yaml.safe_load(file.read_text(encoding="utf-8"))
    found = [
        PublicRace(**{**each, **{key: tuple(each.get(key, ())) for key in ("files", "build", "options")}})
        for each in root["races"]
    ]
    return PublicRaces({each.name: each for each in found}, root["licences"])
