"""`--profile`: measures a flight, prints tables at its end, and writes a file for a flame graph."""

from __future__ import annotations

import argparse
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

from cfepy.cli.flight_add_ons import FlightAddOn, Tell
from cfepy.cli.parser import shared_group

if TYPE_CHECKING:
    from cfepy.cli.text_table import Table
    from cfepy.pilot import Flown

OPTION, NO_FILE = "--profile", "-"
SPEEDSCOPE, COLLAPSED = (".json",), (".txt", ".folded", ".collapsed")
"""The endings of files, by their formats."""


class Profiler(FlightAddOn):
    """The profiler of a flight.

    Args:
        arguments: as for `FlightAddOn`.
        name: as for `FlightAddOn`.
        tell: as for `FlightAddOn`.
    """

    OPTIONS: ClassVar = {"profile": OPTION}

    def __init__(self, arguments: argparse.Namespace, name: str, tell: Tell) -> None:
        super().__init__(arguments, name, tell)
        self._file: str | None = arguments.profile
        self._name = name
        if self._file is None:
            return
        from cfepy.cli.user_notes import check_writable
        from cfepy.extra.profiler import StackSampler, TimedTasks, TurnTracer

        if self._file != NO_FILE:
            check_writable(self._file, OPTION)
        self._timed = TimedTasks()
        self._sampler = StackSampler(self._timed)
        self._tracer = self._timed.turns = TurnTracer(self._timed.times)
        self.attachments = [self._timed, self._sampler]

    @classmethod
    def add(cls, parser: argparse.ArgumentParser) -> None:
        shared_group(parser, "profile").add_argument(
            OPTION,
            nargs="?",
            const=NO_FILE,
            type=_flame_file,
            metavar="FILE",
            help="print where wall time goes, by application, callback, service and library; write it to FILE.json for "
            "speedscope, or FILE.txt for flamegraph.pl; the trace stays the same",
        )

    def tables(self, flown: Flown) -> Iterable[Table]:
        if self._file is None:
            return ()
        from cfepy.cli.user_notes import writing
        from cfepy.extra.profiler import RunProfile, flame_text, profile_tables

        seen = self._sampler.stacks() | self._tracer.stacks()
        profile = RunProfile.of(self._timed.times, seen, self._sampler.count + self._tracer.count)
        if self._file != NO_FILE:
            text = flame_text(self._file, profile, self._name)
            with writing(self._file, OPTION):
                Path(self._file).write_text(text, encoding="utf-8")
        return profile_tables(profile, flown)


def _flame_file(text: str) -> str:
    """Parse the name of the file, for argparse."""
    if text != NO_FILE and Path(text).suffix not in (*SPEEDSCOPE, *COLLAPSED):
        raise argparse.ArgumentTypeError(
            f"invalid file {text!r}; expected a name that ends with .json for speedscope, or .txt for flamegraph.pl "
            "(write a mission in front of --profile)"
        )
    return text
