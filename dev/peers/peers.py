"""The test files: their origin, how to run them, and their results on ROS (peers.json)."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from cfepy.status import UsageError

FILE = Path(__file__).with_name("peers.json")
UNIT, ROSTEST = "unit", "rostest"
SHARE = 0.95  # of the tests that pass on ROS, the share that must pass here
_NOTHING: Mapping[str, str] = {}


@dataclass(frozen=True, slots=True)
class Peer:
    """One test file.

    Attributes:
        name: its name here.
        repo: its repository, "owner/name" on GitHub.
        path: the file in it.
        kind: UNIT, a Python file with tests, or ROSTEST, a launch file with tests.
        tests, passed: how many tests it has on ROS, and how many of them pass there; None if that is not known.
        packages: folders "owner/name:path" whose packages it can use; a library in one of them replaces cfepy's. Empty
            for the tests of a library that cfepy brings along itself.
        aside: tests that are not counted, with the reasons, by name; they depend on intended differences of cfepy.
        note: a remark for the reader of the results.
    """

    name: str
    repo: str
    path: str
    kind: str
    tests: int | None
    passed: int | None
    packages: tuple[str, ...] = ()
    aside: Mapping[str, str] = field(default_factory=lambda: _NOTHING)
    note: str = ""

    @property
    def repos(self) -> tuple[str, ...]:
        """All repositories that it takes."""
        return tuple(dict.fromkeys([self.repo, *(each.partition(":")[0] for each in self.packages)]))

    def enough(self, passed: int) -> bool:
        """Return whether enough tests passed: 95 % of those that pass on ROS, without those that are not counted."""
        return passed >= ((self.passed or 0) - len(self.aside)) * SHARE


class Peers(NamedTuple):
    """All test files by name, the commit of each repository, and the excluded files with the reasons."""

    files: Mapping[str, Peer]
    commits: Mapping[str, str]
    left_out: tuple[tuple[str, str], ...] = ()

    def chosen(self, names: list[str]) -> list[Peer]:
        """Return the files with these names or prefixes, or all if none are given.

        Raises:
            UsageError: the file does not exist.
        """
        found = [peer for peer in self.files.values() if not names or peer.name.startswith(tuple(names))]
        for name in names:
            if not any(peer.name.startswith(name) for peer in found):
                raise UsageError(f"unknown test file {name}; expected a name in {FILE.name}", file=str(FILE))
        return found


def read_peers(file: Path = FILE) -> Peers:
    """Read a list of test files."""
    root = json.loads(file.read_text(encoding="utf-8"))
    found = [Peer(**{**entry, "packages": tuple(entry.get("packages", ()))}) for entry in root["files"]]
    left_out = tuple((each["what"], each["why"]) for each in root["left_out"])
    return Peers({peer.name: peer for peer in found}, root["repositories"], left_out)
