"""`cfepy board new`: write a profile of a board from three times that were measured on it."""

from __future__ import annotations

import argparse
import os
import re
from pathlib import Path

from cfepy.cli.main import ENDED_WELL
from cfepy.cli.user_notes import writing
from cfepy.psp import Measured, load_profile
from cfepy.status import UsageError
from cfepy.units import NS_PER_S

_SIZE = re.compile(r"(\d+) ?(B|KiB|MiB)?", re.ASCII)


def run(arguments: argparse.Namespace) -> int:
    """Write the profile.

    Returns:
        The exit status.

    Raises:
        UsageError: the times contradict each other, the file exists already, or it cannot be written.
    """
    path = Path(arguments.file)
    if path.suffix not in (".yaml", ".yml"):
        raise UsageError(
            f"invalid profile name {arguments.file!r}; expected a name such as gr712.yaml", field="FILE.yaml"
        )
    if os.path.exists(path):
        raise UsageError("already exists; give another name", file=path)
    text = _text(arguments, path.stem)
    with writing(path, "FILE.yaml"):
        path.write_text(text, encoding="utf-8")
    board = load_profile(path)
    print(f"{path}: a call {board.cycles_ns(board.syscall_cycles)} ns,", end=" ")
    print(f"a change of task {board.cycles_ns(board.context_switch_cycles)} ns")
    return ENDED_WELL


def _text(arguments: argparse.Namespace, name: str) -> str:
    times = [getattr(arguments, each) * NS_PER_S for each in ("round_trip", "short", "long")]
    measured = Measured(arguments.cpu_hz, *times)
    trip, short, long = (f"{each / 1000:g} us" for each in times)
    lines = [
        f"# Measured: a round trip of two tasks {trip}; to send and take 32 bytes {short}, 2048 bytes {long}.",
        f"name: {name}",
        f"description: {name}, {arguments.cpu_hz / 1e6:g} MHz, measured",
        f"cpu_hz: {arguments.cpu_hz}",
    ]
    if arguments.tick is not None:
        lines += [f"tick_ns: {round(arguments.tick * NS_PER_S)}"]
    if arguments.flash is not None:
        lines += [f"program_flash: {_size(arguments.flash, '--flash')}"]
    if arguments.ram is not None:
        lines += ["sram:", f"  - {{name: ram, size: {_size(arguments.ram, '--ram')}}}"]
    lines += [f"{field}: {cycles}" for field, cycles in measured.cycles().items()]
    if arguments.tick is not None:
        lines += [f"max_publish_hz: {max(1, round(1 / arguments.tick))}   # a message a publisher and tick"]
    return "\n".join(lines) + "\n"


def _size(text: str, option: str) -> str:
    found = _SIZE.fullmatch(text)
    if found is None:
        raise UsageError(
            f"invalid size {text!r}; expected bytes, or a number with KiB or MiB, such as 512KiB", field=option
        )
    return f"{found[1]} {found[2]}" if found[2] else found[1]
