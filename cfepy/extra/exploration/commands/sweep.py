"""`cfepy sweep`: fly a mission at many rates, boards, seeds and values, and report the highest rate without losses.

Runs whose values are drawn have a summary instead of a row for each run.
"""

from __future__ import annotations

import argparse
import io
import os
import sys
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from cfepy.cli.csv_cells import write_rows
from cfepy.cli.json_output import STDOUT, check_json, write_json, write_text
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS, INTERRUPTED
from cfepy.cli.options import plan_of_mission
from cfepy.cli.text_table import Table, show_tables
from cfepy.cli.user_notes import check_writable, tell_briefly, writing
from cfepy.extra.exploration import (
    Drawn,
    FieldMeasure,
    Group,
    Knee,
    Point,
    Sweep,
    SweepRow,
    answers,
    draws_of,
    files_read,
    groups_of,
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
from cfepy.mission import MissionSpec, ParameterDistribution
from cfepy.pilot import RunPlan
from cfepy.status import UsageError

PICTURES = (".png", ".svg", ".pdf")
HINT_COLUMN = "why it is not clean"
DEFAULT_RUNS = 100
MOST_FAILED = 10
"""Rows of the table of failed runs."""


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
    said = [dict(zip(heads, each, strict=True)) for each in cells]
    if rows and rows[0].point.run is not None:
        _report_draws(arguments, plan, rows, said)
    else:
        _report_rates(arguments, rows, said)
    for row in rows:
        if row.numbers.trouble:
            print(f"an error in cfepy itself; please report it:\n{row.numbers.trouble}", file=sys.stderr)
            return FOUND_PROBLEMS
    return ENDED_WELL if is_over else INTERRUPTED


def _report_rates(arguments: argparse.Namespace, rows: Sequence[SweepRow], said: Sequence[object]) -> None:
    """Report each point, and the knees."""
    found = knees(rows)
    write_json(arguments, {"rows": said, "knees": [{**each._asdict(), "varied": dict(each.varied)} for each in found]})
    show_tables([table_of(rows)], sys.stdout)
    print()
    for knee in found:
        print(knee.text)
    _draw(arguments, rows, found)


def _report_draws(
    arguments: argparse.Namespace, plan: RunPlan, rows: Sequence[SweepRow], said: Sequence[object]
) -> None:
    """Report the summary of runs with drawn values, and the knees if there is a rate."""
    groups = _show_draws(rows, plan)
    found = knees(rows)
    plain_knees = [{**each._asdict(), "varied": dict(each.varied)} for each in found]
    write_json(arguments, {"rows": said, "groups": _plain_groups(groups, plan), "knees": plain_knees})
    for knee in found:
        print(knee.text)
    if arguments.picture is not None:
        _draw_groups(groups, arguments.mission, arguments.picture)


def _flown(arguments: argparse.Namespace, plan: RunPlan) -> tuple[list[SweepRow], bool]:
    """Fly the points. Returns the flown points in order, and whether these are all points."""
    varied = [(name, values_of(text, "--set")) for name, text in arguments.varied]
    rates = [] if arguments.rate is None else numbers_of(arguments.rate, "--rate")
    boards: list[str | None] = [_board(each) for text in arguments.boards for each in text.split(",")] or [None]
    fields = tuple(FieldMeasure.parse(each, "--measure") for each in arguments.measure if _is_field(each))
    topics = tuple(each for each in arguments.measure if not _is_field(each))
    base = replace(plan, launch_args=(*plan.launch_args, *((name, values[0]) for name, values in _args(varied))))
    spec = base.spec()
    draws = _draws_asked(arguments, spec)
    seeds = None if arguments.seeds is None else seeds_of(arguments.seeds, "--seed")
    points = points_of(spec, boards, rates, varied, seeds, draws)
    tell_briefly(_notes(points[0][0], plan))
    lot = Sweep(plan, topics or spec.sweep.topics, fields)
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


def _notes(point: Point, plan: RunPlan) -> list[str]:
    """Return the notes about the mission of a point, such as a parameter of an unknown node."""
    drawn = tuple(f"--set {name}:" for name, _ in point.drawn)
    notes = point.plan(plan).spec().notes
    return [note.replace("--set", "--draw", 1) if note.startswith(drawn) else note for note in notes]


def _is_field(measure: str) -> bool:
    return ":" in measure and not measure.startswith("/")


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
    fields = list(dict.fromkeys(each.name for row in rows for each in row.numbers.values))
    numbers = tuple(range(1, len(columns) + len(fields)))
    table = Table("Sweep", (*columns, *fields, HINT_COLUMN), right=numbers, least=(len(names) + 2, len(names) + 5))
    for row in rows:
        topics, varied = row.numbers.sent, dict(row.varied)
        measured = {each.name: f"{each.value:.6g}" for each in row.numbers.values if each.value is not None}
        rate = "" if row.point.rate_hz is None else f"{row.point.rate_hz:g}"
        came = f"{min(each.delivered_hz for each in topics):.1f}" if topics else ""
        mean, longest = (
            seconds_text(max(getattr(each, name) for each in topics)) if topics else ""
            for name in ("latency_mean_us", "latency_max_us")
        )
        table.add(
            row.numbers.board,
            rate,
            *(varied.get(name, "") for name in names),
            row.point.seed,
            came,
            sum(each.lost for each in topics) if topics else "",
            sum(each.held_back for each in topics) if topics else "",
            mean,
            longest,
            f"{row.numbers.cpu:.2%}",
            *(measured.get(name, "") for name in fields),
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


# -- drawn runs --------------------------------------------------------------------------------------------------------


def _draws_asked(arguments: argparse.Namespace, spec: MissionSpec) -> list[Drawn]:
    """Return the drawn values of each run; an empty list if the command line asks for no drawn runs.

    Args:
        arguments: the command line.
        spec: the mission; distributions of the command line override the ones in its file.

    Raises:
        UsageError: nothing is to be drawn, a distribution is given twice, or an option requires drawn runs.
    """
    said: dict[str, ParameterDistribution] = {}
    for name, distribution in arguments.drawn:
        if name in said:
            raise UsageError(f"{name} is given twice; leave one of them out", field="--draw")
        said[name] = distribution
    if not said and arguments.draws is None:
        if arguments.draw_seed is not None:
            raise UsageError("requires --draw or --draws", field="--draw-seed")
        return []
    distributions: Mapping[str, ParameterDistribution] = {**spec.sweep.draw, **said}
    return draws_of(distributions, arguments.draws or DEFAULT_RUNS, arguments.draw_seed or 0)


def _show_draws(rows: Sequence[SweepRow], plan: RunPlan) -> list[Group]:
    """Print the summary of drawn runs. Returns their groups."""
    groups = groups_of(rows)
    for group in groups:
        tables = [_quantities(group)]
        if group.failed:
            tables.append(_failed(group))
        show_tables(tables, sys.stdout)
    print()
    for group in groups:
        row, why = group.worst()
        print(group.text)
        print(f"  worst: run {row.point.run}{_seed_of(row)}, {why}\n  again: {row.point.plan(plan).command_line()}")
    return groups


def _seed_of(row: SweepRow) -> str:
    return "" if row.point.seed == row.point.run else f" with seed {row.point.seed}"


def _plain_groups(groups: Sequence[Group], plan: RunPlan) -> list[dict[str, Any]]:
    """Return the summary as plain values for JSON."""
    found = []
    for group in groups:
        row, why = group.worst()
        low, high = group.interval
        worst = {"run": row.point.run, "seed": row.point.seed, "why": why, "drawn": dict(row.point.drawn)}
        found.append(
            {
                "name": group.name,
                "runs": len(group.rows),
                "clean": group.successes,
                "success_rate": group.successes / len(group.rows),
                "confidence_95": [low, high],
                "measures": [each._asdict() for each in group.quantities()],
                "worst": {**worst, "command": row.point.plan(plan).command_line()},
            }
        )
    return found


def _draw_groups(groups: Sequence[Group], mission: str, file: str) -> None:
    """Draw the picture of drawn runs."""
    from cfepy.extra.exploration import picture_of_draws
    from cfepy.extra.reports import save

    picture = picture_of_draws(groups, Path(mission).stem)
    with writing(file, "--picture"):
        save(picture, Path(file))
    print(f"{file}: {sum(len(group.rows) for group in groups)} runs")


def _quantities(group: Group) -> Table:
    columns = ("measure", "runs", "least", "run", "5 %", "median", "95 %", "most", "run", "unit")
    table = Table(group.name, columns, right=tuple(range(1, 9)), least=(1, 3, 8))
    for each in group.quantities():
        low, middle, high = (_number(value) for value in (each.low, each.median, each.high))
        least, most = _number(each.least), _number(each.most)
        runs = (str(each.least_run), str(each.most_run))
        table.add(each.measure, each.runs, least, runs[0], low, middle, high, most, runs[1], each.unit)
    return table


def _number(value: float) -> str:
    return f"{value:.6g}"


def _failed(group: Group) -> Table:
    names = [name for name, _ in group.rows[0].point.drawn]
    failed = group.failed
    table = Table("Runs that are not clean", ("run", "seed", *names, "why it is not clean"), range(len(names) + 2))
    for row in failed[:MOST_FAILED]:
        values = (value for _, value in row.point.drawn)
        table.add(str(row.point.run), str(row.point.seed), *values, row.why_not_clean)
    if len(failed) > MOST_FAILED:
        table.note = f"and {len(failed) - MOST_FAILED} more; --csv has all of them"
    return table
