"""`cfepy convert check`: whether a ROS node in C++ can be a cFE application, and the facts to know before a conversion.

Code that examines sources, with a parser and with the compiler, and reports findings by a table of rules belongs here.
Nothing is built and nothing runs.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.extra.convert.node_check.arena_size import ArenaSize, arena_size
    from cfepy.extra.convert.node_check.checking import check_program
    from cfepy.extra.convert.node_check.compiler import ABOUT_HEADERS, rule_of
    from cfepy.extra.convert.node_check.findings import (
        CheckReport,
        GraphName,
        RuleFinding,
        SourcePlace,
        SubscriptionMemory,
    )
    from cfepy.extra.convert.node_check.headers import write_refusals
    from cfepy.extra.convert.node_check.program import ProgramSources
    from cfepy.extra.convert.node_check.programs import programs_of
    from cfepy.extra.convert.node_check.rules import RULES, CheckRule, Level
    from cfepy.extra.convert.node_check.sarif import sarif_of
    from cfepy.extra.convert.node_check.source import read_source

__all__ = [
    "ABOUT_HEADERS",
    "RULES",
    "ArenaSize",
    "CheckReport",
    "CheckRule",
    "GraphName",
    "Level",
    "ProgramSources",
    "RuleFinding",
    "SourcePlace",
    "SubscriptionMemory",
    "arena_size",
    "check_program",
    "programs_of",
    "read_source",
    "rule_of",
    "sarif_of",
    "write_refusals",
]

if not TYPE_CHECKING:  # a type checker sees the names above, and no others
    __getattr__, __dir__ = face(
        __name__,
        {
            ".arena_size": ("ArenaSize", "arena_size"),
            ".checking": ("check_program",),
            ".findings": ("RuleFinding", "GraphName", "SubscriptionMemory", "SourcePlace", "CheckReport"),
            ".compiler": ("ABOUT_HEADERS", "rule_of"),
            ".program": ("ProgramSources",),
            ".source": ("read_source",),
            ".programs": ("programs_of",),
            ".headers": ("write_refusals",),
            ".rules": ("RULES", "Level", "CheckRule"),
            ".sarif": ("sarif_of",),
        },
    )
