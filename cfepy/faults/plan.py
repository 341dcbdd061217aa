"""`FaultPlan`: what is to go wrong in a run, as a plain value: from a file, from a dictionary, or made by a program.

    plan = read_plan("faults.yaml")
    plan = FaultPlan.from_dict({"faults": [{"drop": "/odom", "probability": 0.1}]})

docs/faults.md describes the kinds of faults and the form of the file. Imports cfepy.psp.marked_yaml and its neighbours.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from cfepy.faults.gate import When
from cfepy.psp.marked_yaml import Marked

ALWAYS = When()


@dataclass(frozen=True, slots=True)
class Fault:
    """One fault.

    Attributes:
        kind: a key of `cfepy.faults.kinds.KINDS`.
        target: what it strikes, as the plan writes it; several messages or applications are several targets.
        name: what reports call it, unique in its plan; its random numbers follow from it and the run's seed.
        when: at which occasions.
        options: the rest, by the names of the plan; times in ns.
        line: in the file, 0 when there is none.
    """

    kind: str
    target: tuple[str, ...]
    name: str = ""
    when: When = ALWAYS
    options: Mapping[str, Any] = field(default_factory=dict)
    line: int = field(default=0, compare=False)

    @property
    def text(self) -> str:
        """What it does, in the words of the plan: "drop /odom"."""
        return f"{self.kind} {', '.join(self.target)}"


@dataclass(frozen=True, slots=True)
class FaultPlan:
    """Faults, in the order in which they look at a message.

    Attributes:
        faults: the faults; each has a name.
        file: where they came from, for errors; empty when from nowhere.
    """

    faults: tuple[Fault, ...] = ()
    file: str = field(default="", compare=False)

    @classmethod
    def from_dict(cls, plain: Mapping[str, Any]) -> FaultPlan:
        """The plan of a dictionary of the form of the file.

        Raises:
            UsageError: it is no such plan.
        """
        from cfepy.faults.plan_text import read_marked

        return read_marked(_marked(plain, ""))

    def to_dict(self) -> dict[str, Any]:
        """Itself as plain values, which `from_dict` takes."""
        from cfepy.faults.plan_text import plain_fault

        return {"faults": [plain_fault(fault) for fault in self.faults]}

    def to_yaml(self) -> str:
        """The text of a file with this plan."""
        import yaml

        return str(yaml.safe_dump(self.to_dict(), sort_keys=False, default_flow_style=None, width=100))


def read_plan(path: str | Path) -> FaultPlan:
    """Read a plan from a file.

    Raises:
        UsageError: it cannot be read, or something in it is wrong: with file, line and field.
    """
    from cfepy.faults.plan_text import read_marked
    from cfepy.psp.marked_yaml import load

    return read_marked(load(Path(path)))


def _marked(value: Any, place: str) -> Marked:
    """A plain value as if it had been read from a file."""
    inner = value
    if isinstance(value, Mapping):
        inner = {str(key): _marked(item, f"{place}.{key}".lstrip(".")) for key, item in value.items()}
    elif isinstance(value, list | tuple):
        inner = [_marked(item, f"{place}[{index}]") for index, item in enumerate(value)]
    return Marked(inner, Path("fault plan"), 0, place)
