"""The scenarios: a node of a public repository, its environment, and the expected results (scenarios.json)."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from cfepy.status import UsageError

FILE = Path(__file__).with_name("scenarios.json")


class Program(NamedTuple):
    """A node's program: a repository ("owner/name"), the script's path in it, its arguments."""

    repo: str
    path: str
    argv: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Scenario:
    """One scenario.

    Attributes:
        id: its name.
        node: the tested node.
        sha256: digest of its script; a script with another digest is not the intended node.
        helpers: nodes that run beside it.
        needs: further repositories whose packages it imports.
        namespace: namespace of the node, "/" or deeper.
        params: initial parameters of the parameter server, by full name.
        keys: input at the node's terminal; None runs it without a terminal.
        observe: recorded topics with their types.
        stimulus: Python text that the observer executes; see `observer.py` for its names.
        seconds: virtual time that the scenario lasts, if the stimulus does not take longer.
        ends_itself: wait until the node ends after that; otherwise it is asked to end.
        expect: Python expressions that must be true; see `verdict.py` for their names.
    """

    id: str
    node: Program
    sha256: str
    seconds: float
    expect: tuple[str, ...]
    helpers: tuple[Program, ...] = ()
    needs: tuple[str, ...] = ()
    namespace: str = "/"
    params: Mapping[str, Any] = field(default_factory=dict)
    keys: tuple[str | float, ...] | None = None
    observe: Mapping[str, str] = field(default_factory=dict)
    stimulus: str = ""
    ends_itself: bool = False

    @property
    def repos(self) -> tuple[str, ...]:
        """All repositories that it takes, the node's own first."""
        return tuple(dict.fromkeys([self.node.repo, *(helper.repo for helper in self.helpers), *self.needs]))


class Corpus(NamedTuple):
    """All scenarios by name, and the commit of each repository."""

    scenarios: Mapping[str, Scenario]
    commits: Mapping[str, str]

    def chosen(self, ids: list[str]) -> list[Scenario]:
        """Return the scenarios of these names, or all if no names are given.

        Raises:
            UsageError: there is no scenario of that name.
        """
        for name in ids:
            if name not in self.scenarios:
                raise UsageError(f"unknown scenario {name}; expected an id of {FILE.name}", file=str(FILE))
        return [self.scenarios[name] for name in ids] if ids else list(self.scenarios.values())


def read_corpus(file: Path = FILE) -> Corpus:
    """Read a file of scenarios."""
    root = json.loads(file.read_text(encoding="utf-8"))
    found = [_scenario(entry) for entry in root["scenarios"]]
    return Corpus({scenario.id: scenario for scenario in found}, root["repositories"])


def _scenario(entry: dict[str, Any]) -> Scenario:
    return Scenario(
        id=entry["id"],
        node=_program(entry),
        sha256=entry["sha256"],
        seconds=float(entry["seconds"]),
        expect=tuple(entry["expect"]),
        helpers=tuple(_program(helper) for helper in entry.get("helpers", ())),
        needs=tuple(entry.get("needs", ())),
        namespace=entry.get("namespace", "/"),
        params=entry.get("params", {}),
        keys=tuple(entry["keys"]) if "keys" in entry else None,
        observe=entry["observe"],
        ends_itself=entry.get("ends_itself", False),
        stimulus="\n".join(entry.get("stimulus", ())),
    )


def _program(entry: dict[str, Any]) -> Program:
    return Program(entry["repo"], entry["path"], tuple(entry.get("argv", ())))
