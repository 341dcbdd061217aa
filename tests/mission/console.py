"""Compares our console with one of NASA's, line by line, with masked times and declared differences."""

from __future__ import annotations

import re
from pathlib import Path

DATA = Path(__file__).parents[1] / "data"
STAMP = re.compile(r"\d{4}-\d{3}-\d\d:\d\d:\d\d\.\d{5}")

# Lines that only NASA's console has: (pattern, the reason why ours has none or another).
ONLY_THEIRS = [
    (r"OS_Posix_", "the POSIX scheduler's policies: there is no such scheduler here"),
    (r"CFE_PSP: initializing module '(timebase_posix_clock|eeprom_mmap_file|iodriver|linux_sysmon)'", "host drivers"),
    (r"CFE_PSP: Using POSIX monotonic clock as CFE timebase", "the time base is virtual"),
    (r"CFE_PSP: (Using MMAP simulated EEPROM|EEPROM Range)", "the host's address of the simulated EEPROM"),
    (r"cFE chksm \d+", "the checksum of another program"),
    (r"Version Info: Mission SampleMission", "the mission has another name"),
    (r"92: Build \d+ by", "built by others, elsewhere"),
    (r"OS_ModuleLoad_Impl\(\)|OS_GenericSymbolLookup_Impl\(\)", "words of the host's dynamic linker"),
]
# Lines that only ours has.
ONLY_OURS = [
    (r"CFE_PSP: EEPROM Range", "the board's address of the simulated EEPROM"),
    (r"cFE chksm \d+", "the checksum of this program"),
    (r"Version Info: Mission \w+, version", "this mission's name"),
    (r"92: Build cfepy", "built by cfepy"),
    (r"OS_ModuleLoad: |OS_SymbolLookup: ", "where code was looked for"),
]


def masked(lines: list[str], but: list[tuple[str, str]]) -> list[str]:
    """Return lines with the time masked, without those that a pattern declares to be different."""
    kept = [line for line in lines if not any(re.search(pattern, line) for pattern, _ in but)]
    return [STAMP.sub("<time>", line) for line in kept]


def golden(name: str, last: str) -> list[str]:
    """Return the lines of a recorded console up to the one that contains `last`."""
    lines = (DATA / name).read_text(encoding="utf-8").splitlines()
    end = max(number for number, line in enumerate(lines) if last in line)
    return masked(lines[: end + 1], ONLY_THEIRS)


def ours(lines: list[str], last: str) -> list[str]:
    """Our lines up to the one that contains `last`."""
    end = max((number for number, line in enumerate(lines) if last in line), default=len(lines) - 1)
    return masked(lines[: end + 1], ONLY_OURS)
