"""The place for add-ons that read the declarations of packets and tables in files other than Python."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

from cfepy.mission import MissionSpec
from cfepy.msg import Command, Layout, Telemetry
from cfepy.plugins import Hook
from cfepy.tbl import TableType


class ForeignDeclarations(NamedTuple):
    """The declarations of a mission in files that are not Python.

    Attributes:
        packets: commands and telemetry.
        tables: types of tables.
        names: names of MsgIds.
        problems: a line for each declaration that could not be read.
        layout: returns a struct by its name in C, such as "HS_AMTEntry_t", or None.
    """

    packets: Sequence[Command | Telemetry] = ()
    tables: Sequence[TableType] = ()
    names: Mapping[int, str] = {}
    problems: Sequence[str] = ()
    layout: Callable[[str], Layout | None] = lambda name: None


FOREIGN_DECLARATIONS: Hook[Callable[[MissionSpec], ForeignDeclarations]] = Hook("declarations")
"""Reads the packets and tables of a mission that files other than Python declare."""
