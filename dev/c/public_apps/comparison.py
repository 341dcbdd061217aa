"""The comparison of a mission: build it twice, and fly each application on cfepy and on NASA's cFE."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Collection, Iterator
from pathlib import Path

from dev.c.public_apps.beside import Rules, compare
from dev.c.public_apps.missions import PublicMission
from dev.c.public_apps.nasa_headers import environment
from dev.c.public_apps.results import DIFFERS, NOT_COMPARED, SAME, Beside
from dev.c.public_apps.trial import Trial, build_mission
from dev.corpus.sources import Sources

CFE_OPTION = "--cfe"
NO_COMMANDS = "it ends without its device, or subscribes to nothing"
_LONGEST = 200


def compare_mission(mission: PublicMission, sources: Sources, built: Path, apps: Collection[str]) -> Iterator[Beside]:
    """Compare applications of a mission.

    Args:
        mission: the mission.
        sources: the folder with its sources.
        built: the folder of NASA's executable, inside of its build.
        apps: the applications that fly.

    Yields:
        A result for each of them.
    """
    if not apps:
        return
    if CFE_OPTION in mission.options:
        yield from (Beside(mission.name, each, NOT_COMPARED, "0", "0", "it is for cFE 6") for each in sorted(apps))
        return
    with (
        tempfile.TemporaryDirectory() as one,
        tempfile.TemporaryDirectory() as other,
        tempfile.TemporaryDirectory() as scripts,
    ):
        ours = {each.app: each for each in build_mission(mission, sources, Path(one))}
        more = environment(built, Path(scripts), mission.host)
        theirs = {each.app: each for each in build_mission(mission, sources, Path(other), more)}
        for app in sorted(apps):
            name = app if app in ours else next(iter(ours))  # an application of its own may have another name
            yield _compared(mission, app, ours[name], theirs[name], built)


def _compared(mission: PublicMission, app: str, ours: Trial, theirs: Trial, built: Path) -> Beside:
    if ours.folder is None or theirs.folder is None:
        reason = f"it does not build with NASA's headers: {theirs.reason or ours.reason}"
        return Beside(mission.name, app, NOT_COMPARED, "0", "0", reason[:_LONGEST])
    rules = Rules(app in mission.events_only, mission.blank)
    found = compare(ours.folder, theirs.folder, built, rules)
    counts = str(found.commands), str(found.packets)
    if found.differences:
        first = re.sub(r"\s+", " ", found.differences[0])
        text = mission.explained.get(app) or f"{len(found.differences)} differences, such as {first}"
        return Beside(mission.name, app, DIFFERS, *counts, text[:_LONGEST])
    if not found.packets:
        return Beside(mission.name, app, NOT_COMPARED, *counts, "it sends nothing, and has no commands")
    note = "events" if rules.events_only else "" if found.commands else NO_COMMANDS
    return Beside(mission.name, app, SAME, *counts, note)
