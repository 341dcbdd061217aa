"""What the check tells: findings, the names that a node uses, and the memory of its subscriptions."""

from __future__ import annotations

import os
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from cfepy.extra.convert.message_headers import Profile
from cfepy.extra.convert.node_check.rules import RULES, Level


class SourcePlace(NamedTuple):
    """Where something is.

    Attributes:
        file: its path.
        line: from 1; 0 for the whole file.
        column: from 1; 0 when it is not known.
    """

    file: Path
    line: int = 0
    column: int = 0


class RuleFinding(NamedTuple):
    """Something that a rule has found.

    Attributes:
        rule: id of the rule.
        place: where.
        message: what it is, of this place.
    """

    rule: str
    place: SourcePlace
    message: str

    def line(self, level: Level) -> str:
        """A line for a person: `file:line:column: what: why; what to do [rule]`; a warning or note says so."""
        file = self.place.file
        shown = os.path.relpath(file) if file.is_relative_to(Path.cwd()) else str(file)
        place = ":".join(str(part) for part in (shown, *self.place[1:]) if part)
        told = "" if level is Level.ERROR else f"{level.value}: "
        rule = RULES[self.rule]
        return f"{place}: {told}{self.message}: {rule.why}; {rule.remedy} [{rule.id}]"


class GraphName(NamedTuple):
    """A name in the ROS graph that a source uses.

    Attributes:
        kind: "publish", "subscribe", "serve", "call", "action" or "parameter".
        name: as written; None when it is computed.
        text: of the expression.
        place: where.
        type: of the message, such as "std_msgs/String"; empty when it is not seen.
        queue: its size as written; None when it is not.
    """

    kind: str
    name: str | None
    text: str
    place: SourcePlace
    type: str = ""
    queue: int | None = None


class SubscriptionMemory(NamedTuple):
    """The memory of a subscription.

    Attributes:
        topic: its name as written.
        type: of its messages.
        slots: messages that it keeps.
        size: of one, in bytes, as the compiler lays it out.
        place: where it is subscribed to.
    """

    topic: str
    type: str
    slots: int
    size: int
    place: SourcePlace

    @property
    def total(self) -> int:
        """Bytes of all its messages."""
        return self.slots * self.size


@dataclass(slots=True)
class CheckReport:
    """What the check found in one program.

    Attributes:
        name: of the program.
        profile: that it is checked for.
        findings: sorted by place, each once.
        names: that it uses.
        memory: of its subscriptions; empty when it does not compile.
        files: its sources and own headers that were read.
        unparsed: places that were left to the compiler, because the parser does not expand macros.
    """

    name: str
    profile: Profile
    findings: list[RuleFinding] = field(default_factory=list)
    names: list[GraphName] = field(default_factory=list)
    memory: list[SubscriptionMemory] = field(default_factory=list)
    files: list[Path] = field(default_factory=list)
    unparsed: int = 0

    def add(self, rule: str, place: SourcePlace, message: str) -> None:
        """A finding, when the rule matters in this profile; one that is there already is not told again."""
        level = RULES[rule].level(self.profile)
        finding = RuleFinding(rule, place, message)
        if level is not None and not any(each.rule == rule and each.place == place for each in self.findings):
            self.findings.append(finding)

    def at(self, level: Level) -> list[RuleFinding]:
        """The findings of a level, by place."""
        return sorted(each for each in self.findings if RULES[each.rule].level(self.profile) is level)

    @property
    def is_refused(self) -> bool:
        """Whether the node is not converted."""
        return bool(self.at(Level.ERROR))

    def counts(self) -> Counter[str]:
        """How often each rule was met."""
        return Counter(each.rule for each in self.findings)
