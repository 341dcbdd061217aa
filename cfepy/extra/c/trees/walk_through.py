"""`cfepy new mission --from`: from a mission tree, or the folder of an application, to a flight in one command.

The steps are: build, check, fly. They end with a flight, or with a list of things to do, the most useful first.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS, main
from cfepy.extra.c.toolchain.application import Options, build
from cfepy.extra.c.toolchain.compiler import CompilerError
from cfepy.extra.c.trees.configuration import Configuration, mission_file
from cfepy.extra.c.trees.mission_folder import MISSION_FILE, TreeOptions, build_tree, functions_of
from cfepy.extra.c.trees.startup_scripts import made_startup
from cfepy.extra.c.trees.tree_layout import is_tree
from cfepy.mission import STARTUP_SCRIPT
from cfepy.pilot import check_mission
from cfepy.status import UsageError

SECONDS = 10
MOST_STEPS = 10
LABS = (
    "CFE_APP, ci_lab, CI_LAB_AppMain, CI_LAB, 60, 16384, 0x0, 0;\n"
    "CFE_APP, to_lab, TO_LAB_AppMain, TO_LAB, 70, 16384, 0x0, 0;\n"
    "CFE_APP, sch_lab, SCH_LAB_AppMain, SCH_LAB, 80, 16384, 0x0, 0;\n"
)
"""cfepy's own lab applications, which bring commands in, telemetry out and a schedule."""


def mission_from(source: Path, folder: Path | None, cfe: str | None = None) -> int:
    """Make a mission folder from a tree or an application, check it, and fly it.

    Args:
        source: the mission tree, or the folder of an application in C.
        folder: the new mission folder; named after the source when None.
        cfe: the release of cFE 6 that the sources are written for; None for cFE 7.

    Returns:
        The exit status of the flight, or 1 if there was none.

    Raises:
        UsageError: the source is neither, there is no compiler, or the folder exists already.
    """
    options = Options(cfe=cfe)
    made, steps = _built_tree(source, folder, options) if is_tree(source) else _built_app(source, folder, options)
    if made is None:
        return _ended(steps)
    print(f"\ncheck: cfepy check {made}")
    problems = check_mission(str(made))
    for each in problems:
        print(f"  {each}")
    print(f"  {len(problems)} found" if problems else "  nothing found")
    print(f"\nflight: cfepy run {made} --for {SECONDS}")
    status = main(["run", str(made), "--for", str(SECONDS)])
    steps += [each.text for each in problems if not each.is_warning]
    steps += [each.text for each in problems if each.is_warning]
    if status == ENDED_WELL:
        print(f"\nThe mission flies: {made}")
        return ENDED_WELL
    _ended([*steps, f"look at the report above, and run the mission again: cfepy run {made}"])
    return status


def _ended(steps: Iterable[str]) -> int:
    several = list(dict.fromkeys(steps))
    print("\nto do:")
    for number, step in enumerate(several[:MOST_STEPS], 1):
        print(f"  {number}. {step}")
    return FOUND_PROBLEMS


def _built_tree(tree: Path, folder: Path | None, options: Options) -> tuple[Path | None, list[str]]:
    print(f"build: cfepy build {tree}{_shown(options)}")
    _check_free(folder)
    report = build_tree(tree, folder, TreeOptions(build=options))
    for line in report.lines():
        print(f"  {line}")
    return Path(report.folder), list(report.steps)


def _built_app(app: Path, folder: Path | None, options: Options) -> tuple[Path | None, list[str]]:
    made = Path(f"{app.resolve().name}_mission") if folder is None else folder
    _check_free(made)
    print(f"build: cfepy build {app}{_shown(options)}")
    made.mkdir(parents=True)
    try:
        built = build(app, made / f"{app.resolve().name}.so", options)
    except CompilerError as error:
        print(error)
        made.rmdir()
        first = next((each for each in str(error).splitlines() if "error: " in each), str(error))
        steps = [first, *(each for each in str(error).splitlines() if "--cfe" in each)]
        return None, [*steps, f"when it compiles: cfepy new mission --from {app}{_shown(options)}"]
    script = made_startup([(built.library.stem, functions_of(built.library), list(built.names.values()))])
    (made / STARTUP_SCRIPT).write_bytes(LABS.encode() + script.text)
    (made / MISSION_FILE).write_bytes(mission_file(app.resolve().name, Configuration()))
    for file in (built.library, *built.tables, made / STARTUP_SCRIPT, made / MISSION_FILE):
        print(f"  {file}")
    return made, []


def _shown(options: Options) -> str:
    return "" if options.cfe is None else f" --cfe {options.cfe}"


def _check_free(folder: Path | None) -> None:
    if folder is not None and folder.exists():
        raise UsageError("already exists and is not overwritten; choose another name", file=folder)
