"""The board of a mission: processor speed, clock tick, memory, cost of kernel calls, and the resulting limits.

A profile is a file, boards/<name>.yaml. A number that is 0 or missing means "no limit" or "costs nothing".
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields
from functools import partial
from pathlib import Path
from typing import Any

from cfepy.config.platform import COUNTED_BY_ID, IDENTITIES, MAY_BE_ZERO, MOST_ID, NOT_LIMITS, PlatformConfig
from cfepy.ids import SERIAL_MAX
from cfepy.reading.marked_yaml import Marked, load
from cfepy.reading.mistakes import Mistakes, collected, each_of
from cfepy.reading.resources import shipped
from cfepy.reading.suggestions import expected, listed
from cfepy.rtos import CpuCosts
from cfepy.status import UsageError
from cfepy.units import NS_PER_S, PS_PER_NS

DEFAULT_NODE_CALL_NS = 1000
SIZE_UNITS = {"B": 1, "KiB": 1024, "MiB": 1024 * 1024}
MOST_BYTES = 1 << 32  # a board with more memory needs no limit
MOST_LIMIT = (1 << 31) - 1
MOST_OBJECTS = SERIAL_MAX - 1  # a resource id has 16 bits for the serial number
LIMIT_NAMES = tuple(known.name for known in fields(PlatformConfig) if known.name not in NOT_LIMITS)
Limit = int | str | tuple[int, ...]
"""A value of `PlatformConfig`."""

LINUX, DIRECT, RANGES = "linux", "direct", "ranges"
MEMORIES = (LINUX, DIRECT, RANGES)
"""How flight software reaches memory by address: as with NASA's PSP for Linux; the same with its module ram_direct in
place of ram_notimpl; or only in the ranges that the board has.
"""
REGION_FIELDS = ("name", "size", "retained")
PORT_FIELDS = ("name", "address", "size")
SIZES = ("program_flash", "data_flash")
NUMBERS = (
    "cpu_hz",
    "cores",
    "watchdog_max_ms",
    "tick_ns",
    *SIZES,
    "context_switch_cycles",
    "syscall_cycles",
    "copy_cycles_per_byte",
    "max_publish_hz",
    "node_call_ns",
)


@dataclass(frozen=True, slots=True)
class MemoryRegion:
    """A block of RAM: its name, its size in bytes, and whether it keeps its content through a reset."""

    name: str
    size: int
    retained: bool = False


@dataclass(frozen=True, slots=True)
class PortRange:
    """The registers of a device: a name, the first address, and the size in bytes."""

    name: str
    address: int
    size: int


@dataclass(frozen=True, slots=True)
class MemoryCosts:
    """RAM used by each object of the kernel, in bytes; 0 costs nothing."""

    task_control_block: int = 0
    queue_control_block: int = 0
    queue_slot: int = 0
    semaphore: int = 0
    mutex: int = 0
    timer: int = 0


@dataclass(frozen=True, slots=True)
class BoardProfile:
    """The properties of a board.

    Attributes:
        name: the board's name.
        description: a line about it.
        cpu_hz: processor clock in Hz; 0 means that computing costs no virtual time.
        cores: number of cores that run the mission's tasks; 0 if it is not known.
        tick_ns: the kernel's clock tick, to which delays are rounded up, in ns; 0 for none.
        program_flash, data_flash: size in bytes; 0 for no limit.
        sram: regions of RAM; empty for no limit.
        ports: I/O ports; empty for none.
        memory: how flight software reaches memory by address, one of `MEMORIES`.
        watchdog_max_ms: longest time of the watchdog, which resets the processor, in ms; 0 for a watchdog without
            effect.
        context_switch_cycles: processor cycles of a task switch.
        syscall_cycles: cycles of a kernel call.
        copy_cycles_per_byte: cycles to copy a byte of a message.
        max_publish_hz: maximum number of messages per second of one publisher; 0 for no limit.
        node_call_ns: virtual time of a call of a ROS node into the middleware, in ns.
        limits: values that replace values of `PlatformConfig`.
        memory_costs: RAM used by each object.
    """

    name: str
    description: str = ""
    cpu_hz: int = 0
    tick_ns: int = 0
    program_flash: int = 0
    data_flash: int = 0
    sram: tuple[MemoryRegion, ...] = ()
    ports: tuple[PortRange, ...] = ()
    memory: str = RANGES
    watchdog_max_ms: int = 0
    context_switch_cycles: int = 0
    syscall_cycles: int = 0
    copy_cycles_per_byte: int = 0
    max_publish_hz: int = 0
    node_call_ns: int = DEFAULT_NODE_CALL_NS
    limits: dict[str, Limit] = field(default_factory=dict)
    memory_costs: MemoryCosts = MemoryCosts()
    cores: int = 0

    @property
    def sram_size(self) -> int:
        """The total bytes of RAM; 0 for no limit."""
        return sum(region.size for region in self.sram)

    def cpu_costs(self) -> CpuCosts:
        """Return the times of calls on this board; the time of a byte is rounded up to a picosecond."""
        byte_ps = -(-self.copy_cycles_per_byte * PS_PER_NS * NS_PER_S // self.cpu_hz) if self.cpu_hz else 0
        return CpuCosts(
            call_ns=self.cycles_ns(self.syscall_cycles),
            byte_ps=byte_ps,
            switch_ns=self.cycles_ns(self.context_switch_cycles),
            polling_ns=self.node_call_ns,
        )

    def cycles_ns(self, cycles: int) -> int:
        """Return the time of processor cycles in ns, rounded up; 0 on a board without a clock rate."""
        return -(-cycles * NS_PER_S // self.cpu_hz) if self.cpu_hz else 0

    def config(self, base: PlatformConfig | None = None) -> PlatformConfig:
        """Return the platform configuration under this board's limits.

        Args:
            base: the configuration to apply the limits to; None for cFE's defaults.
        """
        return (base or PlatformConfig()).with_limits(self.limits)


def available_boards() -> list[str]:
    """Return the names of the boards included in cfepy, sorted."""
    return sorted(path.stem for path in shipped("boards").glob("*.yaml"))


def load_profile(name_or_path: str | Path) -> BoardProfile:
    """Read the profile of a board.

    Args:
        name_or_path: a shipped board's name such as "rx64m", or the path of a .yaml file.

    Raises:
        UsageError: if the board does not exist or its file is wrong; the error names file, line and field.
    """
    return collected(partial(_profile, load(_find(name_or_path))))


def _profile(root: Marked, mistakes: Mistakes) -> BoardProfile:
    entries = dict(mistakes.fields(root, [known.name for known in fields(BoardProfile)]))
    if "name" not in entries and not mistakes.errors:  # otherwise it may have a misspelt key
        mistakes.add(root.fail("missing name; a board profile starts with `name: ...`"))
    found: dict[str, Any] = {}
    for key, entry in entries.items():
        if key in NUMBERS:
            found[key] = mistakes.attempt(partial(_number, key, entry))
        else:
            found[key] = mistakes.attempt(partial(_PARTS.get(key, Marked.text), entry))
    return BoardProfile(**{"name": "", **found})


def _find(name_or_path: str | Path) -> Path:
    path = Path(name_or_path)
    if path.suffix in (".yaml", ".yml") or len(path.parts) != 1:
        return path
    boards = available_boards()
    if str(name_or_path) not in boards:
        hint = expected(str(name_or_path), [*boards, "the path of a .yaml file"])
        raise UsageError(f"unknown board {str(name_or_path)!r}; {hint}", field="board")
    return shipped("boards") / f"{path}.yaml"


def _number(key: str, entry: Marked) -> int:
    if entry.value is None:
        return 0
    return _size(entry) if key in SIZES else entry.integer()


def _size(entry: Marked) -> int:
    """Return a size in bytes, from a whole number or a number with a unit, such as "512 KiB"."""
    if not isinstance(entry.value, str):
        return entry.integer(highest=MOST_BYTES)
    count, _, unit = entry.value.partition(" ")
    if not count.isdecimal() or unit not in SIZE_UNITS:
        raise entry.fail(f"must be bytes or a number with {listed(SIZE_UNITS)}, such as 512 KiB, not {entry.shown()}")
    size = int(count) * SIZE_UNITS[unit]
    if size > MOST_BYTES:
        raise entry.fail(f"must be at most {MOST_BYTES // SIZE_UNITS['MiB']} MiB, not {entry.shown()}")
    return size


def _sram(entry: Marked) -> tuple[MemoryRegion, ...]:
    return tuple(each_of(partial(_region, item) for item in entry.items()))


def _region(entry: Marked) -> MemoryRegion:
    parts = entry.mapping(REGION_FIELDS)
    for needed in ("name", "size"):
        if needed not in parts:
            raise entry.fail(f"missing {needed}; write a region as {{name: ecc, size: 512 KiB}}")
    readers = {"name": Marked.text, "size": _size, "retained": Marked.flag}
    return MemoryRegion(**_each(readers, parts))


def _ports(entry: Marked) -> tuple[PortRange, ...]:
    return tuple(each_of(partial(_port_range, item) for item in entry.items()))


def _port_range(entry: Marked) -> PortRange:
    parts = entry.mapping(PORT_FIELDS)
    for needed in ("name", "address", "size"):
        if needed not in parts:
            raise entry.fail(f"missing {needed}; write ports as {{name: gpio, address: 0x8C000, size: 64}}")
    readers = {"name": Marked.text, "address": _address, "size": _size}
    return PortRange(**_each(readers, parts))


def read_memory(entry: Marked) -> str:
    """Return how flight software reaches memory by address.

    Raises:
        UsageError: it is none of `MEMORIES`.
    """
    if entry.value not in MEMORIES:
        raise entry.fail(f"must be {' or '.join(MEMORIES)}, not {entry.shown()}")
    return str(entry.value)


def _address(entry: Marked) -> int:
    return entry.integer(highest=MOST_BYTES)


def _each(readers: Mapping[str, Callable[[Marked], Any]], parts: Mapping[str, Marked]) -> dict[str, Any]:
    """Return the values of the parts, each read by the reader of its name."""
    return dict(zip(parts, each_of(partial(readers[name], part) for name, part in parts.items()), strict=True))


def _limits(entry: Marked) -> dict[str, Limit]:
    return collected(partial(_read_limits, entry))


def _read_limits(entry: Marked, mistakes: Mistakes) -> dict[str, Limit]:
    found = (
        (name, mistakes.attempt(partial(read_limit, name, item))) for name, item in mistakes.fields(entry, LIMIT_NAMES)
    )
    return {name: value for name, value in found if value is not None}


def read_limit(name: str, entry: Marked) -> Limit:
    """Return a value of the platform configuration, as read from a file.

    Args:
        name: a field of `PlatformConfig`.
        entry: its value.

    Raises:
        UsageError: if it has the wrong type, or is a number that cFE cannot be built with.
    """
    default = getattr(PlatformConfig(), name)
    if isinstance(default, str):
        return entry.text()
    if isinstance(default, bool):
        return entry.flag()
    if isinstance(default, tuple):
        return tuple(each.integer() for each in entry.items())
    if name in IDENTITIES:
        return entry.integer(0, MOST_ID)
    lowest = 0 if name in MAY_BE_ZERO else min(1, default)
    return entry.integer(lowest, MOST_OBJECTS if name in COUNTED_BY_ID else MOST_LIMIT)


def _memory_costs(entry: Marked) -> MemoryCosts:
    parts = entry.mapping([known.name for known in fields(MemoryCosts)])
    return MemoryCosts(**_each(dict.fromkeys(parts, Marked.integer), parts))


_PARTS: Mapping[str, Callable[[Marked], Any]] = {
    "sram": _sram,
    "ports": _ports,
    "memory": read_memory,
    "limits": _limits,
    "memory_costs": _memory_costs,
}
