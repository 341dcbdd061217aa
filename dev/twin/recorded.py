"""Recorded flights of NASA's cFE: the packets sent, the packets received, and the files written, step by step."""

from __future__ import annotations

import json
import lzma
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from dev.twin.commands import Step
from dev.twin.flight import Observed

DATA = Path(__file__).parents[2] / "tests/twin/data"

Flight = list[tuple[Step, Observed]]


def of_release(release: str, what: str = "commands") -> Path:
    """Return the record of a release of cFE such as "7.0.0"; `what` begins its name."""
    return DATA / f"{what}_{release.replace('.', '_')}.json.xz"


def save(path: Path, flights: Iterable[Flight]) -> None:
    """Write flights to a file."""
    rows = [[_row(step, observed) for step, observed in flight] for flight in flights]
    path.write_bytes(lzma.compress(json.dumps(rows, separators=(",", ":")).encode(), preset=9))


def load(path: Path) -> list[Flight]:
    """Flights of a file."""
    rows = json.loads(lzma.decompress(path.read_bytes()))
    return [[_entry(*row) for row in flight] for flight in rows]


def _row(step: Step, observed: Observed) -> list[Any]:
    files = {path: data.hex() for path, data in sorted(observed.files.items())}
    return [step.service, step.pace, _hex(step.packets), _hex(observed.packets), files]


def _entry(service: str, pace: str, up: list[str], down: list[str], files: dict[str, str]) -> tuple[Step, Observed]:
    written = {path: bytes.fromhex(data) for path, data in files.items()}
    return Step(service, _bytes(up), pace), Observed(_bytes(down), written)


def _hex(packets: tuple[bytes, ...]) -> list[str]:
    return [packet.hex() for packet in packets]


def _bytes(texts: list[str]) -> tuple[bytes, ...]:
    return tuple(map(bytes.fromhex, texts))
