"""Make a mission of NASA's functional tests from a folder of shared objects, fly it and read its log."""

from __future__ import annotations

import re
import shutil
from dataclasses import dataclass
from pathlib import Path

from cfepy.mission import Mission
from cfepy.writing.console import Console

STARTUP = """\
CFE_LIB, cfe_assert,   CFE_Assert_LibInit, ASSERT_LIB,  0,  0,     0x0, 0;
CFE_LIB, sample_lib,   SAMPLE_LIB_Init,    SAMPLE_LIB,  0,  0,     0x0, 0;
CFE_APP, sample_app,   SAMPLE_APP_Main,    SAMPLE_APP,  50, 16384, 0x0, 0;
CFE_APP, ci_lab,       CI_LAB_AppMain,     CI_LAB_APP,  60, 16384, 0x0, 0;
CFE_APP, to_lab,       TO_LAB_AppMain,     TO_LAB_APP,  70, 16384, 0x0, 0;
CFE_APP, sch_lab,      SCH_LAB_AppMain,    SCH_LAB_APP, 80, 16384, 0x0, 0;
CFE_APP, cfe_testcase, CFE_TestMain,       CFE_TEST,    50, 65536, 0x0, 0;
!
"""
"""The lab applications and the sample application are there since some segments need them."""
RELEASE = 'cfe_version: "7.0.0"\n'
LONGEST_S = 600
"""Virtual seconds that the tests may take."""
LOG = "/cf/cfe_test.log"
"""What cfe_assert writes; it has this name when the tests have come to their end."""
NASA = Path(__file__).with_name("nasa.txt")
_END = re.compile(r"\[  END\] (\d+) (.*?) *TOTAL::(\d+) +PASS::(\d+) +FAIL::(\d+) +MIR::(\d+) +TSF::(\d+) +TTF::(\d+)")
_MORE = re.compile(r"\[ INFO\] +ABORT::(\d+) +WARN::\d+ +FLOW::\d+ +DEBUG::\d+ +N/A::(\d+)")


@dataclass(frozen=True, slots=True)
class Segment:
    """A segment: how many assertions passed, failed in whatever way, are for a person to look at, were left out."""

    number: int
    name: str
    passed: int
    failed: int
    by_hand: int
    left_out: int


@dataclass(frozen=True, slots=True)
class Result:
    """Results of one flight.

    Attributes:
        segments: the finished segments.
        is_complete: whether the tests ran to their end.
        digest: digest of the trace.
    """

    segments: tuple[Segment, ...]
    is_complete: bool
    digest: str


def make_mission(source: Path, folder: Path) -> str:
    """Make the mission.

    Args:
        source: folder with the shared objects and table files.
        folder: folder of the mission.

    Returns:
        The argument for `Mission`.
    """
    for pattern in ("*.so", "*.tbl"):
        for file in source.glob(pattern):
            shutil.copy(file, folder)
    (folder / "startup.scr").write_text(STARTUP, encoding="utf-8")
    (folder / "mission.yaml").write_text(RELEASE, encoding="utf-8")
    return str(folder)


def fly(mission: str, tasks: str) -> Result:
    """Fly the tests for as long as they may take."""
    with Mission(mission, console=Console(quiet=True), tasks=tasks) as flight:
        flight.run_for(LONGEST_S)
        file = flight.files.find(LOG)
        log = "" if file is None else bytes(file.data).decode(errors="replace")
        return Result(tuple(read(log)), file is not None, flight.finish())


def read(log: str) -> list[Segment]:
    """Return the segments in a log of cfe_assert, without the sums at its end."""
    segments = []
    aborted = left_out = 0
    for line in log.splitlines():
        more, end = _MORE.match(line), _END.match(line)
        if more is not None:
            aborted, left_out = map(int, more.groups())
        elif end is not None and end.group(2) != "SUMMARY":
            _, passed, failed, by_hand, setup, teardown = map(int, end.groups()[2:])
            bad = failed + setup + teardown + aborted
            segments.append(Segment(int(end.group(1)), end.group(2), passed, bad, by_hand, left_out))
    return segments


def of_nasa() -> dict[int, tuple[int, int, int]]:
    """Return the counts of each segment in NASA's own run on cFE 7.0.0 on Linux: passed, by hand, left out."""
    rows = (line.split() for line in NASA.read_text(encoding="utf-8").splitlines() if not line.startswith("#"))
    return {int(number): (int(passed), int(by_hand), int(out)) for number, passed, by_hand, out in rows}
