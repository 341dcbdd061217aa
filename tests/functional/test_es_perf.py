"""Marks in the performance log, collected and written to a file by command (es_perf_test.c)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from cfepy.app import Cfe
from cfepy.es import packets as pk
from cfepy.es.perf import EXIT_BIT, MAX_IDS, TRIGGER_START
from cfepy.fs.header import HEADER_SIZE
from cfepy.msg import Command

ENTRY, EXIT = 0, 1
TRIGGER_MARK = 126
NO_MARK = -1
FILE = "/ram/perf.dat"
LAST_MARKS = (0, MAX_IDS - 1, MAX_IDS)
"""The first, the last, and one that there is not."""


def send(cfe: Cfe, command: Command, **fields: object) -> None:
    cfe.sb.transmit_msg(command.packet(fields), False)
    cfe.os.task_delay(10)


def set_masks(cfe: Cfe, trigger_mark: int) -> None:
    """Collect mark 0 and the last 32 marks, which the core does not use."""
    for number, mask in enumerate([1, 0, 0, 0xFFFFFFFF]):
        trigger = 1 << trigger_mark % 32 if number == trigger_mark // 32 else 0
        send(cfe, pk.SET_PERF_FILTER_MASK, FilterMaskNum=number, FilterMask=mask)
        send(cfe, pk.SET_PERF_TRIGGER_MASK, TriggerMaskNum=number, TriggerMask=trigger)


def collect(cfe: Cfe, act: Callable[[], object], trigger_mark: int = NO_MARK) -> tuple[dict[str, Any], list[int]]:
    """Return the file's description of a collection during an action, and its marks."""
    set_masks(cfe, trigger_mark)
    send(cfe, pk.START_PERF_DATA, TriggerMode=TRIGGER_START)
    act()
    send(cfe, pk.STOP_PERF_DATA, DataFileName=FILE)
    cfe.os.task_delay(2000)
    data = cfe.os.read(cfe.os.open_create(FILE), 10_000)
    begin = HEADER_SIZE + pk.PERF_METADATA.size
    places = range(begin, len(data), pk.PERF_ENTRY.size)
    return pk.PERF_METADATA.unpack(data, HEADER_SIZE), [pk.PERF_ENTRY.unpack(data, at)["Data"] for at in places]


def entry(mark: int) -> int:
    return mark | ENTRY << EXIT_BIT


def exit_(mark: int) -> int:
    return mark | EXIT << EXIT_BIT


def test_perf_log_entry(cfe: Cfe) -> None:
    _, marks = collect(cfe, lambda: [cfe.es.perf_log_entry(mark) for mark in LAST_MARKS])
    assert marks == [entry(0), entry(MAX_IDS - 1)]


def test_perf_log_exit(cfe: Cfe) -> None:
    _, marks = collect(cfe, lambda: [cfe.es.perf_log_exit(mark) for mark in LAST_MARKS])
    assert marks == [exit_(0), exit_(MAX_IDS - 1)]


def test_perf_log_add(cfe: Cfe) -> None:
    ways = (ENTRY, EXIT, 0xFFFFFFFF)
    _, marks = collect(cfe, lambda: [cfe.es.perf_log_add(mark, way) for mark in LAST_MARKS for way in ways])
    assert marks == [made(mark) for mark in (0, MAX_IDS - 1) for made in (entry, exit_, exit_)]


def test_perf_trigger(cfe: Cfe) -> None:
    def act() -> None:
        cfe.es.perf_log_entry(TRIGGER_MARK - 1)
        cfe.es.perf_log_entry(TRIGGER_MARK)
        cfe.es.perf_log_exit(TRIGGER_MARK)

    about, marks = collect(cfe, act, TRIGGER_MARK)
    assert marks == [entry(TRIGGER_MARK - 1), entry(TRIGGER_MARK), exit_(TRIGGER_MARK)]
    assert about["TriggerCount"] == 2, "counted from the trigger on"
