"""`cfepy boards`: print the boards and their main numbers."""

from __future__ import annotations

import argparse
import sys

from cfepy.cli.main import ENDED_WELL
from cfepy.cli.text_table import Table, show_tables
from cfepy.psp import BoardProfile, available_boards, load_profile

NO_LIMIT = "-"


def run(arguments: argparse.Namespace) -> int:
    """List the boards that cfepy brings along.

    Returns:
        The exit status.
    """
    columns = ("board", "CPU", "tick", "RAM", "flash", "switch", "call", "publish", "description")
    table = Table("Boards", columns, right=tuple(range(1, 8)), least=(7, 6, 5, 4, 2))
    table.note = f"{NO_LIMIT} stands for no limit or no cost; --board also takes the path of a .yaml file"
    for name in available_boards():
        table.add(*_row(load_profile(name)))
    show_tables([table], sys.stdout)
    return ENDED_WELL


def _row(board: BoardProfile) -> tuple[str, ...]:
    return (
        board.name,
        _or_none(board.cpu_hz, f"{board.cpu_hz / 1e6:g} MHz"),
        _or_none(board.tick_ns, f"{board.tick_ns / 1e6:g} ms"),
        _or_none(board.sram_size, f"{board.sram_size // 1024} KiB"),
        _or_none(board.program_flash, f"{board.program_flash // 1024} KiB"),
        _or_none(board.context_switch_cycles, f"{board.cycles_ns(board.context_switch_cycles) / 1e3:g} us"),
        _or_none(board.syscall_cycles, f"{board.cycles_ns(board.syscall_cycles) / 1e3:g} us"),
        _or_none(board.max_publish_hz, f"{board.max_publish_hz} Hz"),
        board.description,
    )


def _or_none(number: int, text: str) -> str:
    return text if number else NO_LIMIT
