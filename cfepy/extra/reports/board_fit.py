"""A mission's requirements for a board, its shortages, and the fewest changes that make it fit.

The mission is flown on the board with as much RAM as it asks for, so that all of its use is visible. Stacks are booked
with the sizes of the startup script. The stack depth of compiled tasks is measured; the depth of Python tasks would not
apply to C.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, replace
from typing import Any, NamedTuple

from cfepy.app import Cfe
from cfepy.attachment import Attachment
from cfepy.es import CFE_APP
from cfepy.extra.c import ElfError, read_shared_object
from cfepy.mission import Mission, MissionSpec, Processor, StackUse
from cfepy.pilot import Host, Results, RunPlan, fly
from cfepy.psp import BoardProfile, load_profile
from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import OBJECT_BYTES

STACK = "stack"
POOL = "memory pool"
SMALLEST_STACK = 8192  # of an application with unknown use; twice the stack of core tasks on small boards
CALLS = 2048  # stack bytes of cFE and OSAL functions on top of the application's; an estimate
GRAIN = 1024  # sizes are rounded up to multiples of this
SPARE = 2  # the proposed size of a pool, as a multiple of its peak use
SMALLEST_POOL = 16384


class BoardLedger(Attachment):
    """Gives a mission as much RAM as it asks for, and records its use.

    Attributes:
        claims: the size of each claim by (owner, purpose), at peak use.
        peak: bytes in use at that time.
        sb_pool: peak use of the Software Bus's pool, in bytes.
        pools: contents of the pools of cFE at the end.
    """

    def __init__(self) -> None:
        self.claims: dict[tuple[str, str], list[int]] = {}
        self.peak = 0
        self.sb_pool = 0
        self.pools: list[PoolRow] = []
        self._mission: Mission

    def begin(self, mission: Mission) -> None:
        self._mission = mission

    def power_up(self, processor: Processor) -> None:
        """Remove the RAM limit from now on, and record the use."""
        memory = processor.memory
        claim = memory.claim
        memory.limit = None

        def noting(owner: str, kind: str, size: int) -> int:
            token = claim(owner, kind, size)
            if memory.used > self.peak:
                self.peak, self.claims = memory.used, memory.sizes()
            return token

        memory.claim = noting  # type: ignore[method-assign]  # of this budget only

    def conclude(self) -> None:
        cfe = self._mission.cfe
        self.sb_pool = max(self.sb_pool, cfe.sb.peaks.memory)
        self.pools = [*_tables(cfe), *_cds(cfe), *_messages(cfe)]


class PoolRow(NamedTuple):
    """Bytes of a pool of cFE, with their owner and purpose; free bytes have no owner.

    `pool` is the name of the pool among the bookings, such as "CDS"; a block counts with its descriptor.
    """

    pool: str
    owner: str
    what: str
    size: int


class BoardChange(NamedTuple):
    """A change that makes a mission smaller: its place, the new text, and the bytes that it saves.

    `is_estimate`: no measurement shows whether the smaller size is enough.
    """

    place: str
    text: str
    saves: int
    is_estimate: bool = False


class StackRow(NamedTuple):
    """The stacks of an application: number of tasks, bytes of each, and the deepest use; None: not measured."""

    app: str
    tasks: int
    size: int
    used: int | None


@dataclass(frozen=True, slots=True)
class BoardFit:
    """A mission's requirements for a board.

    Attributes:
        board: the board's name.
        ram: bytes of RAM of the board; 0 without a limit.
        flash: bytes of flash of the board; 0 without a limit.
        needed: peak use of RAM in bytes.
        rows: (owner, purpose, bytes), largest first.
        pools: contents of those pools of cFE that are among the rows, at the end of the run.
        stacks: stacks of the applications of the startup script.
        sb_pool: bytes of the Software Bus's pool.
        sb_pool_used: peak use of that pool in bytes.
        code: bytes of compiled applications in flash, by name; applications in Python have none.
        changes: the fewest changes that make it fit; empty if it fits.
        results: results of the run, with the CPU of each application.
    """

    board: str
    ram: int
    flash: int
    needed: int
    rows: tuple[tuple[str, str, int], ...]
    pools: tuple[PoolRow, ...]
    stacks: tuple[StackRow, ...]
    sb_pool: int
    sb_pool_used: int
    code: dict[str, int]
    changes: tuple[BoardChange, ...]
    results: Results

    @property
    def missing(self) -> int:
        """Bytes of RAM that are missing; 0 if it fits."""
        return max(0, self.needed - self.ram) if self.ram else 0

    @property
    def in_python(self) -> tuple[str, ...]:
        """Applications of the startup script without a C stack, so that their depth could not be measured."""
        return tuple(row.app for row in self.stacks if row.used is None and row.app not in self.code)

    @property
    def fits_changed(self) -> bool:
        """True if it fits with the changes."""
        return sum(change.saves for change in self.changes) >= self.missing

    @property
    def cpu(self) -> float:
        """Share of the virtual time in which applications ran, 0 to 1."""
        return sum(app.cpu_share for app in self.results.apps)

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        parts: dict[str, tuple[Any, ...]] = {"pools": self.pools, "stacks": self.stacks, "changes": self.changes}
        named = {name: [each._asdict() for each in part] for name, part in parts.items()}
        return {**asdict(self), **named, "missing": self.missing, "cpu": self.cpu}


def fit_of(plan: RunPlan, host: Host | None = None) -> BoardFit:
    """Fly a mission and compute its requirements for its board.

    Args:
        plan: the run.
        host: the host's side; None runs without a break.

    Returns:
        The requirements.

    Raises:
        UsageError: it cannot be flown, or there is no such board.
    """
    spec = plan.spec()
    ledger = BoardLedger()
    flown = fly(plan, spec=spec, attachments=[ledger], host=host)
    board = load_profile(plan.board or spec.board)
    config = flown.mission.config
    rows = sorted(((*key, sum(sizes)) for key, sizes in ledger.claims.items()), key=lambda row: (-row[2], row))
    fit = BoardFit(
        board.name,
        board.sram_size,
        board.program_flash,
        ledger.peak,
        tuple(rows),
        tuple(ledger.pools),
        tuple(_stacks(spec, board, ledger, flown.mission.record.stack_use)),
        config.sb_buf_memory_bytes,
        ledger.sb_pool,
        _code(spec),
        (),
        flown.results,
    )
    return replace(fit, changes=tuple(_fewest(fit, spec))) if fit.missing else fit


def _stacks(
    spec: MissionSpec, board: BoardProfile, ledger: BoardLedger, uses: Mapping[tuple[str, str], StackUse]
) -> Iterator[StackRow]:
    block = board.memory_costs.task_control_block
    for entry in spec.entries:
        sizes = ledger.claims.get((entry.name, STACK), []) if entry.kind == CFE_APP else []
        if sizes:
            used = [use.used for (app, _), use in uses.items() if app == entry.name]
            tasks = sum(size == entry.stack_size + block for size in sizes)
            yield StackRow(entry.name, tasks, entry.stack_size, max(used, default=None))


def _tables(cfe: Cfe) -> Iterator[PoolRow]:
    """Yield the table buffer pool by the owners of tables."""
    pool = cfe.es.pools.find(cfe.tbl.pool_id)
    if pool is None:
        return
    found = []
    for name, sizes in cfe.tbl.buffer_sizes().items():
        app, _, own = name.partition(".")
        what = f"table {own}" + (f", {len(sizes)} buffers" if len(sizes) > 1 else "")
        shared = f"{len(sizes)} buffers that loads and dumps share"
        found.append((app or "CFE_TBL", what if name else shared, sum(map(pool.blocks.room_of, sizes))))
    yield from _shares("CFE_TBL memory pool", pool.blocks.size, found)


def _cds(cfe: Cfe) -> Iterator[PoolRow]:
    """Yield the Critical Data Store by the owners of its blocks."""
    store = cfe.es.cds
    if store is None or not store.is_available:
        return
    found = [("CFE_ES", "registry", store.overhead)]
    for block in store:
        app, _, own = block.name.partition(".")
        found.append((app, f"{'critical table' if block.is_table else 'block'} {own}", store.room_of(block)))
    yield from _shares("CDS", cfe.es.psp.get_cds_size(), found)


def _messages(cfe: Cfe) -> Iterator[PoolRow]:
    """Yield the pool of the Software Bus at its peak use."""
    found = [("CFE_SB", "subscriptions and messages, at most", cfe.sb.peaks.memory)]
    yield from _shares("CFE_SB memory pool", cfe.sb.config.sb_buf_memory_bytes, found)


def _shares(pool: str, size: int, found: list[tuple[str, str, int]]) -> Iterator[PoolRow]:
    for owner, what, taken in sorted(found, key=lambda share: (-share[2], share)):
        if taken:
            yield PoolRow(pool, owner, what, taken)
    yield PoolRow(pool, "", "free", size - sum(taken for _, _, taken in found))


def _code(spec: MissionSpec) -> dict[str, int]:
    found = {}
    for entry in spec.entries:
        built = spec.built.get(entry.name)
        path = built.file if built is not None else spec.folder / entry.path.removeprefix("/cf/")
        if path.suffix in (".so", ".obj") and os.path.isfile(path):
            try:
                source = read_shared_object(read_limited(path, OBJECT_BYTES), path.name)
            except ElfError:
                continue
            found[entry.name] = sum(segment.file_size for segment in source.segments)
    return found


def _fewest(fit: BoardFit, spec: MissionSpec) -> list[BoardChange]:
    """Return as many of the largest savings as are needed; the last one saves no more than necessary."""
    found: list[BoardChange] = []
    left = fit.missing
    lines = {entry.name: entry.line for entry in spec.entries}
    unmeasured = {row.app for row in fit.stacks if row.used is None}
    savings = sorted(_savings(fit), key=lambda each: (-each[0], each[1]))
    for most, name, count, size, least in savings:
        if left <= 0:
            break
        wanted = size - min(most, left) // count
        new = max(least, _power_below(wanted)) if most > left else least
        saves = count * (size - new)
        if name:
            place = f"{spec.script.name}:{lines[name]}"
            text = f"stack of {name}: {new} in place of {size}, for each of {count} tasks"
        else:
            place = "mission.yaml" if spec.mission_file is None else spec.mission_file.name
            text = f"limits: {{sb_buf_memory_bytes: {new}}} in place of {size}; {fit.sb_pool_used} were in use at most"
        found.append(BoardChange(place, text.replace("each of 1 tasks", "its task"), saves, name in unmeasured))
        left -= saves
    return found


def _savings(fit: BoardFit) -> Iterator[tuple[int, str, int, int, int]]:
    """Yield (bytes that can be saved, application or "" for the pool, number of stacks, present size, smallest
    size).
    """
    for row in fit.stacks:
        least = SMALLEST_STACK if row.used is None else -(-(row.used + CALLS) // GRAIN) * GRAIN
        if row.size > least and row.tasks:
            yield row.tasks * (row.size - least), row.app, row.tasks, row.size, least
    least = max(SMALLEST_POOL, -(-SPARE * fit.sb_pool_used // GRAIN) * GRAIN)
    if fit.sb_pool > least:
        yield fit.sb_pool - least, "", 1, fit.sb_pool, least


def _power_below(size: int) -> int:
    """Return the largest power of two that is not larger, for the size of a stack."""
    return 1 << max(0, size.bit_length() - 1)
