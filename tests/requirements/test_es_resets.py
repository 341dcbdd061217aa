"""NASA's requirements for resets of the processor (cES1009, 1010, 1024, 1025, 1317, 1318, 15xx, 1709)."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from cfepy.es import packets as pk
from cfepy.mission import Mission
from cfepy.psp.psp import (
    RST_SUBTYPE_HW_SPECIAL_COMMAND,
    RST_SUBTYPE_HW_WATCHDOG,
    RST_SUBTYPE_POWER_CYCLE,
    RST_SUBTYPE_UNDEFINED_RESET,
)
from cfepy.status import CFE_ES_BAD_ARGUMENT, CfeError
from cfepy.writing.console import Console
from tests.mission.flights import write_mission
from tests.requirements.covers import covers
from tests.requirements.flight import POWERON_RESET, PROCESSOR_RESET, Flight
from tests.requirements.ground import Ground
from tests.requirements.resets import POWERON, PROCESSOR, booted, causes, housekeeping, reset


@pytest.fixture
def ground(tmp_path: Path) -> Iterator[Ground]:
    with booted(tmp_path) as mission:
        yield Ground(mission)


# -- asking for a reset ------------------------------------------------------------------------------------------------


@covers("cES1009", "cES1509", "cES1500", "cES1502")
def test_cES1009_a_power_on_reset_by_command(ground: Ground) -> None:
    reset(ground, PROCESSOR)
    assert len(causes(ground)) == 2
    reset(ground, POWERON)
    assert ground.lines("CFE_ES_ResetCFE")[-1] == (
        "CFE_ES_ResetCFE: POWERON RESET called from CFE_ES_ResetCFE (Commanded)."
    )
    assert "CFE_PSP: Exiting cFE with POWERON Reset status." in ground.mission.console.lines
    values = housekeeping(ground)
    assert (values["ResetType"], values["ResetSubtype"], values["ProcessorResets"]) == (POWERON, 1, 0)
    assert causes(ground) == [(POWERON, 1, "POWER ON RESET due to Power Cycle (Power Cycle)")]
    assert len(ground.lines("LOOPER starts")) == 3


@covers("cES1010", "cES1510", "cES1512", "cES1520", "cES1521", "cES1000")
def test_cES1010_a_processor_reset_by_command(ground: Ground) -> None:
    ground.command(pk.SET_MAX_PR_COUNT, MaxPRCount=5)
    reset(ground, PROCESSOR)
    values = housekeeping(ground)
    assert (values["ResetType"], values["ResetSubtype"], values["BootSource"]) == (PROCESSOR, 1, 1)
    assert (values["ProcessorResets"], values["MaxProcessorResets"]) == (1, 5)
    assert (values["ERLogIndex"], values["ERLogEntries"]) == (2, 2)
    assert causes(ground) == [
        (POWERON, 1, "POWER ON RESET due to Power Cycle (Power Cycle)"),
        (PROCESSOR, 5, "PROCESSOR RESET called from CFE_ES_ResetCFE (Commanded)."),
    ]
    assert len(ground.lines("LOOPER starts")) == 2


@pytest.mark.parametrize(("app", "kind"), [("resets", PROCESSOR), ("powers", POWERON)])
@covers("cES1317", "cES1318")
def test_cES1317_an_application_requests_a_reset(ground: Ground, app: str, kind: int) -> None:
    fields = {"AppEntryPoint": f"{app}_main", "AppFileName": app, "Priority": 60}
    ground.command(pk.START_APP, 3, Application=app.upper(), **fields)
    assert ground.mission.cfe.es.get_reset_type().reset_type == kind
    assert ground.mission.record.resets[0].reset_type == kind
    assert not ground.lines("came back")
    with pytest.raises(CfeError) as caught:
        ground.mission.cfe.es.reset_cfe(3)
    assert caught.value.status == CFE_ES_BAD_ARGUMENT
    assert ground.lines("CFE_ES_ResetCFE")[-1] == "CFE_ES_ResetCFE: Invalid Reset Type: 3."


@covers("cES1301", "cES1301.1")
def test_cES1301_an_application_gets_the_type_of_the_last_reset(fly: Callable[..., Flight]) -> None:
    flight = fly()

    def told() -> tuple[int, int]:
        return flight.call(lambda: flight.cfe.es.get_reset_type())

    assert told() == (POWERON, RST_SUBTYPE_POWER_CYCLE)
    flight.reset(PROCESSOR_RESET)
    assert told() == (PROCESSOR, RST_SUBTYPE_POWER_CYCLE)  # the board names no other cause
    flight.reset(POWERON_RESET)
    assert told() == (POWERON, RST_SUBTYPE_POWER_CYCLE)


# -- counting them -----------------------------------------------------------------------------------------------------


def test_cES1024_the_count_of_processor_resets_can_be_set_to_zero(ground: Ground) -> None:
    reset(ground, PROCESSOR)
    assert housekeeping(ground)["ProcessorResets"] == 1
    assert ground.command(pk.RESET_PR_COUNT) == ["CFE_ES 72: Set Processor Reset Count to Zero"]
    assert housekeeping(ground)["ProcessorResets"] == 0


def test_cES1025_the_limit_of_processor_resets_can_be_set(ground: Ground) -> None:
    assert ground.command(pk.SET_MAX_PR_COUNT, MaxPRCount=7) == ["CFE_ES 73: Maximum Processor Reset Count set to: 7"]
    assert housekeeping(ground)["MaxProcessorResets"] == 7


def test_cES1709_too_many_processor_resets_become_a_power_on_reset(ground: Ground) -> None:
    for count in (1, 2):
        reset(ground, PROCESSOR)
        assert housekeeping(ground)["ProcessorResets"] == count
    reset(ground, PROCESSOR)
    assert [each.reset_type for each in ground.mission.record.resets] == [PROCESSOR, PROCESSOR, POWERON]
    assert ground.lines("CFE_ES_ResetCFE")[-1] == (
        "CFE_ES_ResetCFE: POWER ON RESET due to max proc resets (Commanded)."
    )
    assert housekeeping(ground)["ProcessorResets"] == 0


def test_cES1709_exceptions_count_as_processor_resets(ground: Ground) -> None:
    fields = {"AppEntryPoint": "broken_main", "AppFileName": "broken", "Priority": 60, "ExceptionAction": 1}
    for _ in range(3):
        ground.command(pk.START_APP, 3, Application="BROKEN", **fields)
    assert [each.reset_type for each in ground.mission.record.resets] == [PROCESSOR, PROCESSOR, POWERON]
    scans = ground.lines("CFE_ES_RunExceptionScan: P") + ground.lines("CFE_ES_RunExceptionScan: M")
    assert scans == [
        "CFE_ES_RunExceptionScan: Processor Reset count not reached (0/2)",
        "CFE_ES_RunExceptionScan: Processor Reset count not reached (1/2)",
        "CFE_ES_RunExceptionScan: Maximum Processor Reset count reached (2)",
    ]


def test_cES1510_a_reset_by_the_watchdog_is_distinguished(tmp_path: Path) -> None:
    board = tmp_path / "dog.yaml"
    board.write_text("name: dog\nwatchdog_max_ms: 5000\n", encoding="utf-8")
    sleeper = """
        def main(cfe):
            cfe.es.run_loop()
            cfe.psp.watchdog_set(2000)
            cfe.psp.watchdog_enable()
            cfe.os.task_delay(60_000)
    """
    folder = write_mission(tmp_path, "CFE_APP, sleeper, main, SLEEPER, 50, 16384, 0, 0;!", sleeper=sleeper)
    with Mission(folder, board=str(board), console=Console(quiet=True)) as mission:
        mission.run_for(3)
        ground = Ground(mission)
        values = housekeeping(ground)
        assert (values["ResetType"], values["ResetSubtype"]) == (PROCESSOR, RST_SUBTYPE_HW_WATCHDOG)
        assert values["ProcessorResets"] == 1
        assert causes(ground)[1:] == [
            (PROCESSOR, RST_SUBTYPE_HW_WATCHDOG, "PROCESSOR RESET due to Watchdog (Watchdog).")
        ]


@pytest.mark.parametrize(
    ("kind", "subtype", "kept", "text"),
    [
        (POWERON, RST_SUBTYPE_HW_SPECIAL_COMMAND, 3, "POWER ON RESET due to HW Special Cmd (Hw Spec Cmd)"),
        (POWERON, RST_SUBTYPE_UNDEFINED_RESET, 7, "POWER ON RESET due to other cause (See Subtype)"),
        (PROCESSOR, RST_SUBTYPE_HW_WATCHDOG, 4, "PROCESSOR RESET due to Watchdog (Watchdog)."),
        (PROCESSOR, RST_SUBTYPE_UNDEFINED_RESET, 4, "PROCESSOR RESET due to Watchdog (Watchdog)."),
        (
            PROCESSOR,
            RST_SUBTYPE_HW_SPECIAL_COMMAND,
            3,
            "PROCESSOR RESET due to Hardware Special Command (Hw Spec Cmd).",
        ),
    ],
)
@covers("cES1500", "cES1510")
def test_cES1500_the_subtype_of_a_reset_is_distinguished(
    ground: Ground, kind: int, subtype: int, kept: int, text: str
) -> None:
    """The same as at a boot that was not requested."""
    es = ground.mission.cfe.es
    es.setup_reset_variables(kind, subtype, 1)
    assert es.get_reset_type() == (kind, kept)
    assert causes(ground)[-1] == (kind, subtype, text)
    said = text.replace("(Hw Spec", "(HW Spec") if kind == PROCESSOR else f"{text}."
    assert ground.lines("CFE_ES_SetupResetVariables")[-1] == f"CFE_ES_SetupResetVariables: {said}"


@pytest.mark.parametrize(
    ("subtype", "cause"), [(RST_SUBTYPE_HW_WATCHDOG, "Watchdog"), (RST_SUBTYPE_HW_SPECIAL_COMMAND, "HW Spec Cmd")]
)
def test_cES1709_resets_by_the_hardware_count_as_processor_resets(ground: Ground, subtype: int, cause: str) -> None:
    ground.command(pk.SET_MAX_PR_COUNT, MaxPRCount=0)
    ground.mission.cfe.es.setup_reset_variables(PROCESSOR, subtype, 1)
    ground.mission.run_for(3)
    assert ground.lines("CFE_ES_SetupResetVariables")[1] == (
        f"CFE_ES_SetupResetVariables: POWER ON RESET due to max proc resets ({cause})."
    )
    assert ground.mission.record.resets[0].reset_type == POWERON
