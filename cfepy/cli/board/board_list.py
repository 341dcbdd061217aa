"""`cfepy board list`: print the boards and their main numbers."""

from __future__ import annotations

import argparse
import sys

from cfepy.cli.json_output import check_json, write_json
from cfepy.cli.main import ENDED_WELL
from cfepy.cli.text_table import Table, show_tables
from cfepy.psp import BoardProfile, available_boards, load_profile

NO_LIMIT = "-"


def run(arguments: argparse.Namespace) -> int:
    """List the boards that cfepy brings along.

    Returns:
        The exit status.
    """
    check_json(arguments)
    boards = [load_profile(name) for name in available_boards()]
    write_json(arguments, [_record(board) for board in boards])
    columns = ("board", "CPU", "tick", "RAM", "flash", "switch", "call", "publish", "description")
    table = Table("Boards", columns, right=tuple(range(1, 8)), least=(7, 6, 5, 4, 2))
    table.note = f"{NO_LIMIT} stands for no limit or no cost; --board also takes the path of a .yaml file"
    for board in boards:
        table.add(*_row(board))
    show_tables([table], sys.stdout)
    return ENDED_WELL


def _record(board: BoardProfile) -> dict[str, object]:
    """Return the numbers of a board for JSON; null stands for no limit or no cost."""
    return {
        "name": board.name,
        "description": board.description,
        "cpu_hz": board.cpu_hz or None,
        "tick_ns": board.tick_ns or None,
        "ram_bytes": board.sram_size or None,
        "flash_bytes": board.program_flash or None,
        "switch_ns": board.cycles_ns(board.context_switch_cycles) or None,
        "call_ns": board.cycles_ns(board.syscall_cycles) or None,
        "max_publish_hz": board.max_publish_hz or None,
    }


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
