"""The results of the check: findings, the names that a node uses, and the memory of its subscriptions."""

from __future__ import annotations

import os
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from cfepy.extra.convert.message_headers import Profile
from cfepy.extra.convert.node_check.rules import RULES, Level


class SourcePlace(NamedTuple):
    """A place in a source.

    Attributes:
        file: its path.
        line: from 1; 0 for the whole file.
        column: from 1; 0 when it is not known.
    """

    file: Path
    line: int = 0
    column: int = 0


class RuleFinding(NamedTuple):
    """A finding of a rule.

    Attributes:
        rule: id of the rule.
        place: its place.
        message: the message for this place.
    """

    rule: str
    place: SourcePlace
    message: str

    def line(self, level: Level) -> str:
        """Return a line: `file:line:column: what: why; what to do [rule]`, with the level of a warning or note."""
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
        place: its place.
        type: of the message, such as "std_msgs/String"; empty when it is not known.
        queue: its size as written; None when it is not written.
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
        place: place of the subscription.
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
    """The findings of the check in one program.

    Attributes:
        name: of the program.
        profile: the profile of the check.
        findings: sorted by place, each once.
        names: names in the ROS graph that it uses.
        memory: of its subscriptions; empty when it does not compile.
        has_transforms: whether it has a buffer of transforms.
        files: its sources and own headers that were read.
        unparsed: places that were left to the compiler, because the parser does not expand macros.
    """

    name: str
    profile: Profile
    findings: list[RuleFinding] = field(default_factory=list)
    names: list[GraphName] = field(default_factory=list)
    memory: list[SubscriptionMemory] = field(default_factory=list)
    has_transforms: bool = False
    files: list[Path] = field(default_factory=list)
    unparsed: int = 0

    def add(self, rule: str, place: SourcePlace, message: str) -> None:
        """Add a finding if the rule applies in this profile and the place does not have it yet."""
        level = RULES[rule].level(self.profile)
        finding = RuleFinding(rule, place, message)
        if level is not None and not any(each.rule == rule and each.place == place for each in self.findings):
            self.findings.append(finding)

    def at(self, level: Level) -> list[RuleFinding]:
        """Return the findings of a level, by place."""
        return sorted(each for each in self.findings if RULES[each.rule].level(self.profile) is level)

    def is_error(self, finding: RuleFinding) -> bool:
        """Return True if a finding refuses the node."""
        return RULES[finding.rule].level(self.profile) is Level.ERROR

    @property
    def is_refused(self) -> bool:
        """Whether the node is not converted."""
        return bool(self.at(Level.ERROR))

    def counts(self) -> Counter[str]:
        """Return the number of findings of each rule."""
        return Counter(each.rule for each in self.findings)
