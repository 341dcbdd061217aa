"""`cfepy board report`: a mission's requirements for a board, and the changes that make it fit."""

from __future__ import annotations

import argparse
import sys

from cfepy.cli.flying_progress import FlyingProgress
from cfepy.cli.json_output import check_json, write_json
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS
from cfepy.cli.options import plan_of_mission
from cfepy.cli.text_table import Table, show_paragraph, show_tables
from cfepy.extra.reports import BoardFit, fit_of

NO_C_STACK = "no C stack"
UNKNOWN = "not measured"


def run(arguments: argparse.Namespace) -> int:
    """Print the report.

    Returns:
        The exit status.

    Raises:
        UsageError: the mission cannot boot, or there is no such board.
    """
    check_json(arguments)
    fit = fit_of(plan_of_mission(arguments), FlyingProgress())
    write_json(arguments, fit.to_dict())
    show_tables([_ram(fit), _pools(fit), _stacks(fit), _cpu(fit)], sys.stdout)
    print()
    for line in _told(fit):
        show_paragraph(line, sys.stdout)
    return FOUND_PROBLEMS if fit.missing else ENDED_WELL


def _ram(fit: BoardFit) -> Table:
    table = Table("RAM, bytes, when most was in use", ("owner", "what for", "bytes"), right=(2,))
    for row in fit.rows:
        if row[2]:
            table.add(*row)
    table.note = f"{fit.needed:,} in use" + (f", {fit.ram:,} on {fit.board}" if fit.ram else ", no limit")
    return table


def _pools(fit: BoardFit) -> Table:
    title = "Of these, what is in pools of cFE at the end, bytes"
    table = Table(title, ("pool", "owner", "what for", "bytes"), right=(3,))
    for row in fit.pools:
        table.add(*row)
    return table


def _stacks(fit: BoardFit) -> Table:
    table = Table("Stacks, bytes", ("application", "tasks", "booked for each", "deepest use"), right=(1, 2, 3))
    for row in fit.stacks:
        unmeasured = NO_C_STACK if row.app in fit.in_python else UNKNOWN
        table.add(row.app, row.tasks, row.size, unmeasured if row.used is None else f"{row.used:,}")
    table.note = "the deepest use of compiled applications is measured, without what cFE's own functions take"
    return table


def _cpu(fit: BoardFit) -> Table:
    table = Table("CPU at the mission's rates", ("application", "CPU"), right=(1,))
    for app in fit.results.apps:
        table.add(app.name, app.cpu_text)
    table.note = f"{fit.cpu:.2%} in use, {1 - fit.cpu:.2%} left"
    return table


def _told(fit: BoardFit) -> list[str]:
    lines = []
    if fit.in_python:
        lines.append(
            f"stacks: {', '.join(fit.in_python)}: Python has no C stack that could be measured, so what is booked "
            "counts; their C code tells what the board needs: fly it here (cfepy build), or paint stacks on the board"
        )
    if fit.flash:
        code = sum(fit.code.values())
        told = f"{code:,} of {fit.flash:,} bytes for compiled applications" if fit.code else "no compiled application"
        lines.append(f"flash: {told}; cFE itself and applications in Python have no size here")
    if not fit.ram:
        return [*lines, f"RAM: {fit.board} has no limit"]
    if not fit.missing:
        return [*lines, f"RAM: it fits, {fit.ram - fit.needed:,} bytes are left ({1 - fit.needed / fit.ram:.1%})"]
    lines.append(f"RAM: it does not fit, {fit.missing:,} bytes are missing; the fewest changes that make it fit:")
    for each in fit.changes:
        guess = ", an estimate: nothing was measured" if each.is_estimate else ""
        lines.append(f"  {each.place}: {each.text}, saves {each.saves:,}{guess}")
    left = sum(each.saves for each in fit.changes) - fit.missing
    if fit.fits_changed:
        return [*lines, f"with them {left:,} bytes are left"]
    return [*lines, f"with them {-left:,} bytes are still missing: take applications out, or another board"]
