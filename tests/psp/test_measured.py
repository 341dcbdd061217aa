"""Profiles from measured times: the simulation charges the measured times."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from cfepy.mission import Mission
from cfepy.psp.measured import LONG_BYTES, SHORT_BYTES, Measured
from cfepy.psp.profile import BoardProfile
from cfepy.status import UsageError
from cfepy.writing.console import Console
from tests.mission.flights import write_mission

MEASURE = f"""
    ROUNDS = 100

    def time_of(cfe, action):
        began = cfe.psp.get_timebase()
        for _ in range(ROUNDS):
            action()
        ended = cfe.psp.get_timebase()
        return ((ended.upper - began.upper) * 10**9 + ended.lower - began.lower) / ROUNDS

    def main(cfe):
        there, back = cfe.os.bin_sem_create("THERE", 0), cfe.os.bin_sem_create("BACK", 0)
        pipe = cfe.sb.create_pipe(2, "MINE")
        cfe.sb.subscribe(0x0999, pipe)

        def other():
            while True:
                cfe.os.bin_sem_take(there)
                cfe.os.bin_sem_give(back)

        def trip():
            cfe.os.bin_sem_give(there)
            cfe.os.bin_sem_take(back)

        def message(size):
            packet = bytearray(size)
            packet[:6] = bytes([0x09, 0x99, 0xC0, 0, *divmod(size - 7, 256)])
            cfe.sb.transmit_msg(packet)
            cfe.sb.receive_buffer(pipe, 0)

        cfe.es.create_child_task("OTHER", other, 8192, 50)
        cfe.os.task_delay(100)
        sizes = {SHORT_BYTES}, {LONG_BYTES}
        found = time_of(cfe, trip), *(time_of(cfe, lambda: message(size)) for size in sizes)
        cfe.es.write_to_sys_log("measured %.1f %.1f %.1f\\n" % found)
"""


def test_measured_times_match_the_profile_of_the_board(tmp_path: Path) -> None:
    cycles = Measured(100_000_000, 14_000, 4_960, 65_440).cycles()
    assert cycles == {"context_switch_cycles": 300, "syscall_cycles": 200, "copy_cycles_per_byte": 3}
    board = BoardProfile("measured", cpu_hz=100_000_000, **cycles)  # type: ignore[arg-type]  # names of its fields
    folder = write_mission(tmp_path, "CFE_APP, measure, main, MEASURE, 50, 16384, 0, 0;\n!", measure=MEASURE)
    with Mission(folder, board=board, console=Console(quiet=True)) as mission:
        mission.run_for(1)
        text = "\n".join(mission.console.lines)
    found = re.search(r"measured ([\d.]+) ([\d.]+) ([\d.]+)", text)
    assert found is not None, text
    assert [float(each) for each in found.groups()] == pytest.approx([14_000, 4_960, 65_440], rel=0.01)


@pytest.mark.parametrize(
    ("times", "option"),
    [((14_000, 5_000, 4_000), "--long"), ((14_000, 100, 65_440), "--short"), ((1_000, 4_960, 65_440), "--round-trip")],
)
def test_inconsistent_times_are_refused(times: tuple[float, float, float], option: str) -> None:
    with pytest.raises(UsageError, match="measure again") as caught:
        Measured(100_000_000, *times).cycles()
    assert caught.value.field == option
