"""`cfepy sweep`: fly a mission at many rates, boards, seeds and values, and report the highest rate without losses."""

from __future__ import annotations

import argparse
import io
import os
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from cfepy.cli.csv_cells import write_rows
from cfepy.cli.json_output import STDOUT, check_json, write_json, write_text
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS, INTERRUPTED
from cfepy.cli.options import plan_of_mission
from cfepy.cli.text_table import Table, show_tables
from cfepy.cli.user_notes import check_writable, writing
from cfepy.extra.exploration import (
    Knee,
    Sweep,
    SweepRow,
    answers,
    files_read,
    knees,
    make_crew,
    make_progress,
    numbers_of,
    points_of,
    seconds_text,
    seeds_of,
    ship,
    sweep_table,
    values_of,
)
from cfepy.pilot import RunPlan
from cfepy.status import UsageError

PICTURES = (".png", ".svg", ".pdf")
HINT_COLUMN = "why it is not clean"


def run(arguments: argparse.Namespace) -> int:
    """Run the sweep of the command line.

    Returns:
        The exit status.

    Raises:
        UsageError: the mission or the points are invalid, or a file cannot be written.
    """
    plan = plan_of_mission(arguments)
    check_json(arguments)
    if arguments.csv not in (None, STDOUT):
        check_writable(arguments.csv, "--csv")
    _check_picture(arguments.picture)
    rows, is_over = _flown(arguments, plan)
    heads, cells = sweep_table(rows)
    if arguments.csv is not None:
        write_text(arguments.csv, _csv_text([heads, *cells], arguments.quote_formulas), "--csv", arguments)
    found = knees(rows)
    said = [dict(zip(heads, each, strict=True)) for each in cells]
    write_json(arguments, {"rows": said, "knees": [{**each._asdict(), "varied": dict(each.varied)} for each in found]})
    show_tables([table_of(rows)], sys.stdout)
    print()
    for knee in found:
        print(knee.text)
    _draw(arguments, rows, found)
    for row in rows:
        if row.numbers.trouble:
            print(f"an error in cfepy itself; please report it:\n{row.numbers.trouble}", file=sys.stderr)
            return FOUND_PROBLEMS
    return ENDED_WELL if is_over else INTERRUPTED


def _flown(arguments: argparse.Namespace, plan: RunPlan) -> tuple[list[SweepRow], bool]:
    """Fly the points. Returns the flown points in order, and whether these are all points."""
    varied = [(name, values_of(text, "--set")) for name, text in arguments.varied]
    rates = [] if arguments.rate is None else numbers_of(arguments.rate, "--rate")
    boards: list[str | None] = [_board(each) for text in arguments.boards for each in text.split(",")] or [None]
    base = replace(plan, launch_args=(*plan.launch_args, *((name, values[0]) for name, values in _args(varied))))
    spec = base.spec()
    points = points_of(spec, boards, rates, varied, seeds_of(arguments.seeds, "--seed"))
    lot = Sweep(plan, tuple(arguments.measure) or spec.sweep.topics)
    crew = make_crew(
        len(points),
        arguments.jobs,
        arguments.cluster,
        lambda: ship(plan, sorted({file for board in boards for file in files_read(replace(base, board=board))})),
        arguments.longest,
    )
    progress = make_progress(None if arguments.quiet else sys.stderr, len(points), 0)
    found: dict[int, SweepRow] = {}
    is_over = True
    try:
        for number, numbers in answers(lot, [point for point, _ in points], crew):
            row = found[number] = SweepRow(*points[number][:1], numbers, points[number][1])
            progress.arrived(bool(row.why_not_clean))
    except KeyboardInterrupt:
        is_over = False
    finally:
        progress.close()
    return [found[number] for number in sorted(found)], is_over


def _args(varied: Sequence[tuple[str, list[str]]]) -> list[tuple[str, list[str]]]:
    return [(name, values) for name, values in varied if not name.startswith("/")]


def _board(word: str) -> str:
    """Return a board. A file becomes an absolute path, because another process reads it."""
    is_file = word.endswith((".yaml", ".yml")) or os.sep in word
    return os.path.abspath(word) if is_file else word


def _csv_text(rows: Sequence[Sequence[object]], quotes: bool) -> str:
    text = io.StringIO(newline="")
    write_rows(text, rows, quotes)
    return text.getvalue()


def table_of(rows: Sequence[SweepRow]) -> Table:
    """Return a table with a row for each point, with the numbers of its worst topic."""
    names = list(dict.fromkeys(name for row in rows for name, _ in row.varied))
    columns = ("board", "rate, Hz", *names, "seed", "came, Hz", "lost", "held back", "latency", "longest", "CPU")
    numbers = tuple(at for at in range(1, len(columns)))
    table = Table("Sweep", (*columns, HINT_COLUMN), right=numbers, least=(len(names) + 2, len(names) + 5))
    for row in rows:
        topics, varied = row.numbers.sent, dict(row.varied)
        rate = "" if row.point.rate_hz is None else f"{row.point.rate_hz:g}"
        came = f"{min(each.delivered_hz for each in topics):.1f}" if topics else ""
        mean, longest = (
            seconds_text(max((getattr(each, name) for each in topics), default=0.0))
            for name in ("latency_mean_us", "latency_max_us")
        )
        table.add(
            row.numbers.board,
            rate,
            *(varied.get(name, "") for name in names),
            row.point.seed,
            came,
            sum(each.lost for each in topics),
            sum(each.held_back for each in topics),
            mean,
            longest,
            f"{row.numbers.cpu:.2%}",
            row.why_not_clean,
        )
    table.note = "came, latency: of the worst topic with messages; CPU: of all applications"
    return table


def _check_picture(file: str | None) -> None:
    """Check before the runs that the picture can be drawn."""
    if file is None:
        return
    from cfepy.extra.reports import figure_of_matplotlib

    if Path(file).suffix.lower() not in PICTURES:
        raise UsageError(
            f"must be a picture with a name that ends with {', '.join(PICTURES)}", file=file, field="--picture"
        )
    figure_of_matplotlib()
    check_writable(file, "--picture")


def _draw(arguments: argparse.Namespace, rows: Sequence[SweepRow], found: Sequence[Knee]) -> None:
    if arguments.picture is None:
        return
    from cfepy.extra.exploration import SweepLine, picture_of_sweep
    from cfepy.extra.reports import save

    lines: dict[tuple[str, ...], SweepLine] = {}
    for row in rows:
        if row.point.rate_hz is None or not row.numbers.sent:
            continue
        name = ", ".join([row.numbers.board, *(f"{name}={value}" for name, value in row.varied)])
        knee = next(each for each in found if (each.board, each.varied) == (row.numbers.board, row.varied))
        line = lines.setdefault((name,), SweepLine(name, None if knee.broken_hz is None else knee.clean_hz))
        line.add(
            row.point.rate_hz,
            min(each.delivered_hz for each in row.numbers.sent),
            max(each.latency_max_us for each in row.numbers.sent) / 1000,
            row.numbers.cpu * 100,
        )
    if not lines:
        raise UsageError("requires --rate and at least one message", field="--picture")
    picture = picture_of_sweep(list(lines.values()), title=Path(arguments.mission).stem)
    with writing(arguments.picture, "--picture"):
        save(picture, Path(arguments.picture))
    print(f"{arguments.picture}: {len(lines)} boards or values")
