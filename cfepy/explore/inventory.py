"""What a campaign depends on: the files that its mission reads, and the versions that make its results comparable.

May import cfepy.mission and cfepy.journal.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from hashlib import file_digest
from typing import Any

from cfepy.journal.facts import versions
from cfepy.journal.mission_files import files_of
from cfepy.journal.reading import ReadFiles
from cfepy.mission.run_plan import RunPlan
from cfepy.status import CfeError

_DIGITS = 16  # of a hash that is shown to a person


def files_read(plan: RunPlan) -> list[str]:
    """Absolute paths of the files that a run depends on, sorted; it is flown once to see which it opens.

    All files of a folder that it looks into are among them.

    Args:
        plan: the run.

    Raises:
        UsageError: it cannot be flown.
    """
    seen: list[str] = []

    def listed(folder: str, names: list[str]) -> None:
        seen.extend(filter(os.path.isfile, (os.path.join(folder, name) for name in names)))

    with ReadFiles(seen.append, listed):
        spec = plan.spec()
        try:
            plan.fly(spec=spec)
        except CfeError:
            pass  # it cannot boot, which is a result too
    return sorted({*seen, *files_of(spec)})


def identity_of(plan: RunPlan, files: Sequence[str], search: Mapping[str, Any]) -> dict[str, Any]:
    """What makes a campaign: results of two can be put together when this is the same.

    Args:
        plan: the run.
        files: that it reads; see `files_read`.
        search: what else decides which schedules there are and what counts as a failure, by option.

    Returns:
        Plain data, in which a change can be told to a person by name.
    """
    contents = {path: _hash_of(path) for path in files}
    return {"plan": plan.to_dict(), "search": dict(search), "files": contents, "versions": comparable_versions()}


def _hash_of(path: str) -> str:
    with open(path, "rb") as file:
        return file_digest(file, "sha256").hexdigest()[:_DIGITS]


def comparable_versions() -> dict[str, str]:
    """Of cfepy, cFE and Python; of the last one the minor version counts."""
    found = versions()
    return {**found, "python": ".".join(found["python"].split(".")[:2])}
