"""The list of public missions and applications (missions.json): repositories with commits, folders and options."""

from __future__ import annotations

import json
import shutil
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from cfepy.status import UsageError
from dev.corpus.sources import Sources

FILE = Path(__file__).with_name("missions.json")
NASA_FIFTEEN = frozenset(
    ("cf", "ci_lab", "cs", "ds", "fm", "hk", "hs", "lc", "md", "mm", "sample_app", "sample_lib", "sc", "sch_lab")
) | {"to_lab"}
"""NASA's fifteen applications. Copies of them in other missions do not count."""
_NOTHING: Mapping[str, str] = {}
_LISTS = ("modules", "options", "apps", "libraries", "devices", "host", "events_only")


class Repository(NamedTuple):
    """A repository: the commit and the licence of its files."""

    commit: str
    licence: str


@dataclass(frozen=True, slots=True)
class PublicMission:
    """A mission tree, or an application.

    Attributes:
        name: its name here.
        repo: its repository, "owner/name" on GitHub.
        folder: the folder in it that is built.
        parts: repositories that belong into it, such as git submodules, by their place beside or below the folder.
        defs: a folder of definitions; empty for the mission's own.
        modules: more folders with modules.
        options: options of `cfepy build` that it needs, besides those for these folders.
        apps: applications to count; all but NASA's fifteen when empty.
        libraries: folders of libraries in the repository that an application needs; built with the same options.
        devices: names of devices that are there in a flight, and send nothing.
        host: libraries of this computer that applications need on NASA's cFE, such as "socketcan".
        events_only: applications whose telemetry is not compared with NASA's cFE, because it counts steps of real
            time.
        blank: a regular expression for times in texts of events, which are not compared.
        explained: why applications behave differently on NASA's cFE.
    """

    name: str
    repo: str
    folder: str = "."
    parts: Mapping[str, str] = field(default_factory=lambda: _NOTHING)
    defs: str = ""
    modules: tuple[str, ...] = ()
    options: tuple[str, ...] = ()
    apps: tuple[str, ...] = ()
    libraries: tuple[str, ...] = ()
    devices: tuple[str, ...] = ()
    host: tuple[str, ...] = ()
    events_only: tuple[str, ...] = ()
    blank: str = ""
    explained: Mapping[str, str] = field(default_factory=lambda: _NOTHING)

    def counts(self, app: str) -> bool:
        """Return whether an application is one of those that are counted."""
        return app in self.apps if self.apps else app.lower() not in NASA_FIFTEEN

    def lay_out(self, sources: Sources, scratch: Path) -> Path:
        """Copy the mission and its parts into an empty folder.

        Returns:
            The folder to build.

        Raises:
            UsageError: a repository was not fetched.
        """
        root = scratch / self.repo.rpartition("/")[2]
        for place, repo in (("", self.repo), *self.parts.items()):
            source = sources.folder(repo)
            if not source.is_dir():
                how = "python -m dev.c.public_apps fetch FOLDER"
                raise UsageError(f"no sources of {repo}; run `{how}`", file=str(source))
            shutil.copytree(source, root / place, symlinks=True, dirs_exist_ok=True)
        return root / self.folder

    def place_options(self, scratch: Path) -> list[str]:
        """Return the options for its folders of definitions and modules."""
        root = scratch / self.repo.rpartition("/")[2]
        found = ["--defs", str(root / self.defs)] if self.defs else []
        return [*found, *(word for each in self.modules for word in ("--modules", str(root / each)))]


class PublicMissions(NamedTuple):
    """All missions by name, and their repositories."""

    missions: Mapping[str, PublicMission]
    repositories: Mapping[str, Repository]

    @property
    def commits(self) -> dict[str, str]:
        """The commit of each repository, by its name."""
        return {name: each.commit for name, each in self.repositories.items()}

    def chosen(self, names: list[str]) -> list[PublicMission]:
        """Return the missions with these names, or all if none are given.

        Raises:
            UsageError: there is no such mission.
        """
        for name in names:
            if name not in self.missions:
                raise UsageError(f"unknown mission {name}; expected a name in {FILE.name}", file=str(FILE))
        return [each for each in self.missions.values() if not names or each.name in names]


def read_missions(file: Path = FILE) -> PublicMissions:
    """Read a list of missions."""
    root = json.loads(file.read_text(encoding="utf-8"))
    found = [
        PublicMission(
            **{
                **each,
                **{key: tuple(each.get(key, ())) for key in _LISTS},
            }
        )
        for each in root["missions"]
    ]
    repositories = {name: Repository(**each) for name, each in root["repositories"].items()}
    return PublicMissions({each.name: each for each in found}, repositories)
