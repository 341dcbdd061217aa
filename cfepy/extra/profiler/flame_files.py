"""The files of `--profile`: speedscope's JSON (https://www.speedscope.app), and collapsed stacks for flamegraph.pl.

The outermost frames of each stack are the application and the task.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from cfepy import __version__
from cfepy.extra.profiler.run_profile import RunProfile
from cfepy.extra.profiler.task_times import HOST

SCHEMA = "https://www.speedscope.app/file-format-schema.json"
SWITCHES, OUTSIDE, NO_APP = "(task switches)", "(display, ports, pace)", "(boot and timers)"

_Frame = tuple[str, str, int]


def flame_text(file: str, profile: RunProfile, name: str) -> str:
    """Return the text of a file in the format that its suffix names.

    Args:
        file: name of the file.
        profile: the profile.
        name: name of the mission.
    """
    return speedscope(profile, name) if Path(file).suffix == ".json" else collapsed(profile)


def speedscope(profile: RunProfile, name: str) -> str:
    """Return a profile as speedscope's JSON."""
    frames: dict[_Frame, int] = {}
    samples, weights = [], []
    for stack, wall_ns in _stacks(profile):
        samples.append([frames.setdefault(frame, len(frames)) for frame in stack])
        weights.append(wall_ns)
    document: dict[str, Any] = {
        "$schema": SCHEMA,
        "exporter": f"cfepy {__version__}",
        "name": name,
        "activeProfileIndex": 0,
        "shared": {"frames": [_frame(*frame) for frame in frames]},
        "profiles": [
            {
                "type": "sampled",
                "name": f"{name}, wall time",
                "unit": "nanoseconds",
                "startValue": 0,
                "endValue": sum(weights),
                "samples": samples,
                "weights": weights,
            }
        ],
    }
    return json.dumps(document, separators=(",", ":")) + "\n"


def _frame(name: str, file: str, line: int) -> dict[str, Any]:
    return {"name": name, "file": file, "line": line} if file else {"name": name}


def collapsed(profile: RunProfile) -> str:
    """Return a profile as collapsed stacks: a line for each, frames separated by ";", and its time in us."""
    lines = []
    for stack, wall_ns in _stacks(profile):
        names = [f"{name} ({file.rpartition('/')[2]}:{line})" if file else name for name, file, line in stack]
        lines.append(f"{';'.join(each.replace(';', ',') for each in names)} {round(wall_ns / 1000)}\n")
    return "".join(lines)


def _stacks(profile: RunProfile) -> Iterator[tuple[Sequence[_Frame], int]]:
    """Yield the stacks from the outermost frame on, with their times in ns, in the order of names."""
    for label in sorted(profile.stacks):
        root: list[_Frame] = [(label.app or NO_APP, "", 0), (label.task, "", 0)]
        stacks = profile.stacks[label].items()
        yield from sorted(([*root, *map(profile.function, stack)], round(wall_ns)) for stack, wall_ns in stacks)
    yield [(SWITCHES, "", 0)], profile.times.switch_ns
    yield [(OUTSIDE, "", 0)], profile.times.times.get(HOST, 0)
