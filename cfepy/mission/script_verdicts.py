"""What became of the steps of a mission script, for a person and as plain data."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any

from cfepy.mission.script_text import Step
from cfepy.rtos.units import NS_PER_S

OVER = "the run was over before"


@dataclass(frozen=True, slots=True)
class Verdict:
    """What became of a step: `at_s` is the virtual time in s at which it was decided, `detail` what was wrong."""

    line: int
    step: str
    ok: bool
    at_s: float
    detail: str = ""

    @classmethod
    def of(cls, step: Step, ok: bool, at_ns: int, detail: str = "") -> Verdict:
        """The verdict on a step."""
        return cls(step.line, step.text, ok, at_ns / NS_PER_S, detail)


@dataclass(frozen=True, slots=True)
class Outcome:
    """The verdicts of a script, in the order of its lines."""

    file: str
    verdicts: tuple[Verdict, ...]

    @property
    def ok(self) -> bool:
        """Whether every step went well."""
        return all(verdict.ok for verdict in self.verdicts)

    def lines(self) -> Iterator[str]:
        """A line for each step, and the summary."""
        for each in self.verdicts:
            detail = f": {each.detail}" if each.detail else ""
            word = "ok" if each.ok else "FAILED"
            yield f"{word:<6} {each.at_s:9.3f}  {self.file}:{each.line}: {each.step}{detail}"
        failed = sum(not verdict.ok for verdict in self.verdicts)
        count = len(self.verdicts)
        yield f"{count} {'step' if count == 1 else 'steps'}, {f'{failed} failed' if failed else 'all ok'}"

    def text(self) -> str:
        """All lines, for a message."""
        return "\n".join(self.lines())

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers and text."""
        return {"file": self.file, "ok": self.ok, "steps": [asdict(verdict) for verdict in self.verdicts]}
