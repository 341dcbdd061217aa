"""Mission scripts flown: verdicts, the actual values, time, resets, determinism."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from cfepy.pilot import pilot
from cfepy.pilot.plan import RunPlan
from cfepy.script.script_run import Outcome
from tests.mission.flights import write_mission

STARTUP = """
    CFE_APP, sample_app,  SAMPLE_APP_Main, SAMPLE_APP, 50, 16384, 0x0, 0;
    CFE_APP, own,     Main,            OWN,        60, 16384, 0x0, 0;
    !
"""
OWN = """
    from cfepy.msg import Command, Layout, Telemetry, init

    ASK = Command("OWN_ASK", 0x1890, 0, Layout("Ask", [("Value", "u16"), ("Name", "char[8]")]))
    ANSWER = Telemetry("OWN_ANSWER", 0x0890, Layout("Answer", [("Value", "u16"), ("Name", "char[8]")]))
    COMMANDS, TELEMETRY = (ASK,), (ANSWER,)

    def Main(cfe):
        '''Answers a quarter of a second after it was asked, and complains about 13.'''
        cfe.evs.register()
        pipe = cfe.sb.create_pipe(10, "OWN")
        cfe.sb.subscribe(ASK.msg_id, pipe)
        while cfe.es.run_loop(1):
            asked = ASK.read(cfe.sb.receive_buffer(pipe))
            cfe.os.task_delay(250)
            if asked["Value"] == 13:
                cfe.evs.send_err(13, "no thirteens")
            if asked["Value"] == 14:
                raise ValueError("fourteen")
            cfe.sb.transmit_msg(cfe.msg.telemetry(0x0890, ANSWER.payload.pack(asked)))
            cfe.os.printf(f"answered {asked['Value']}\\n")
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write_mission(tmp_path, STARTUP, own=OWN)
    return tmp_path


def fly(folder: Path, text: str, **options: Any) -> Outcome:
    (folder / "script.txt").write_text(text, encoding="utf-8")
    outcome = pilot.fly(RunPlan((str(folder),), script=str(folder / "script.txt"), **options)).outcome
    assert outcome is not None
    return outcome


def verdicts(outcome: Outcome) -> list[tuple[bool, float]]:
    return [(each.ok, round(each.at_s, 3)) for each in outcome.verdicts]


def test_successful_script_has_only_good_verdicts(folder: Path) -> None:
    outcome = fly(
        folder,
        """
        expect no event * CRITICAL
        at 2 send CFE_ES_NOOP
        expect event CFE_ES 3 INFORMATION "No-op command" within 0.1
        at 3 send OWN_ASK Value=7 Name=seven
        expect tlm OWN_ANSWER Value == 7 and Name == seven within 1
        expect console "answered 7"
        expect no file /ram/x
        expect file /cf/own.py size > 10
        expect app OWN RUNNING
        expect no app NOBODY
        """,
    )
    assert outcome.ok, outcome.text()
    assert verdicts(outcome)[1:5] == [(True, 2.0), (True, 2.0), (True, 3.0), (True, 3.25)]
    assert outcome.text().splitlines()[-1] == "10 steps, all ok"


@pytest.mark.parametrize(
    ("expectation", "at_s", "detail"),
    [
        ("event CFE_ES 4 within 0.5", 2.5, 'there was CFE_ES 92 INFORMATION "Build'),
        ("event OWN within 0.5", 2.5, "no event of OWN was sent, only of CFE_ES"),
        ("event CFE_ES * ERROR within 0.5", 2.5, "there was CFE_ES"),
        ("tlm OWN_ANSWER Value == 8 within 0.5", 2.5, "Value was 7 in the last of 1 packet, at 2.250"),
        ("tlm OWN_ANSWER Value == 7 within 0.2", 2.2, "no OWN_ANSWER was sent"),
        ("tlm SAMPLE_APP_HK_TLM within 0.5", 2.5, "no SAMPLE_APP_HK_TLM was sent"),
        ("app OWN STOPPED", 2.0, "it is RUNNING"),
        ("app NOBODY", 2.0, "there are CFE_ES, CFE_EVS, CFE_SB, CFE_TBL, CFE_TIME, SAMPLE_APP, OWN"),
        ("app OWN GONE within 0.1", 2.1, "it is RUNNING"),
        ("file /cf/own.py size 3", 2.0, "it has "),
        ("file /ram/x", 2.0, "/ram has no files"),
        ("file /ram/no/x", 2.0, "the folder /ram/no does not exist"),
        ('console "answered 8" within 0.5', 2.5, 'the last line was "answered 7"'),
        ("no tlm OWN_ANSWER until 3", 2.25, "there was OWN_ANSWER Value=7 Name=seven at 2.250"),
        ("no event CFE_ES until 3", 2.0, 'there was CFE_ES 92 INFORMATION "Build'),
        ("no app OWN", 2.0, "it is RUNNING"),
        ('no console "answered" until 3', 2.25, 'there was "answered 7"'),
    ],
)
def test_failed_expectation_reports_the_actual_values(folder: Path, expectation: str, at_s: float, detail: str) -> None:
    outcome = fly(folder, f"at 2 send OWN_ASK Value=7 Name=seven\nsend CFE_ES_NOOP\nexpect {expectation}\n")
    verdict = outcome.verdicts[-1]
    assert not outcome.ok
    assert (verdict.line, verdict.step, round(verdict.at_s, 3)) == (3, f"expect {expectation}", at_s)
    assert verdict.detail.startswith(detail)
    assert outcome.text().splitlines()[-1] == "3 steps, 1 failed"


def test_expectation_includes_events_since_the_last_action(folder: Path) -> None:
    """Two expectations after one command may be met in any order. Events before the command do not count."""
    outcome = fly(
        folder,
        """
        at 2 send OWN_ASK Value=1
        expect tlm OWN_ANSWER Value == 1
        at 3 send OWN_ASK Value=2
        expect console "answered 2"
        expect tlm OWN_ANSWER Value == 2
        expect tlm OWN_ANSWER Value == 1 within 1
        """,
    )
    assert [each.ok for each in outcome.verdicts] == [True, True, True, True, True, False]


def test_wait_ends_as_soon_as_its_expectation_is_met(folder: Path) -> None:
    outcome = fly(folder, "at 2 send OWN_ASK Value=1\nexpect tlm OWN_ANSWER within 9\nsend CFE_ES_NOOP\n")
    assert verdicts(outcome)[1:] == [(True, 2.25), (True, 2.25)]


def test_after_counts_from_the_previous_step(folder: Path) -> None:
    outcome = fly(folder, "at 2 send OWN_ASK Value=1\nafter 0.5 send OWN_ASK Value=2\nafter 1 end\n")
    assert verdicts(outcome) == [(True, 2.0), (True, 2.5), (True, 3.5)]


def test_run_continues_after_a_failure_by_default(folder: Path) -> None:
    text = "at 2 expect app NOBODY\nat 3 send CFE_ES_NOOP\nexpect event CFE_ES 3\n"
    assert verdicts(fly(folder, text)) == [(False, 2.0), (True, 3.0), (True, 3.0)]
    stopped = fly(folder, text, stop_on_failure=True)
    assert verdicts(stopped) == [(False, 2.0)] * 3
    assert stopped.verdicts[1].detail == "the run ended earlier"


def test_unexpected_events_are_watched_while_the_script_continues(folder: Path) -> None:
    outcome = fly(
        folder,
        """
        expect no event OWN * ERROR until 3
        expect no event OWN * ERROR
        at 2 send OWN_ASK Value=1
        at 4 send OWN_ASK Value=13
        after 1 end
        """,
    )
    assert verdicts(outcome)[:2] == [(True, 3.0), (False, 4.25)]
    assert outcome.verdicts[1].detail == 'there was OWN 13 ERROR "no thirteens" at 4.250'


def test_packet_refused_by_the_bus_fails_its_step(folder: Path) -> None:
    outcome = fly(folder, "at 2 send raw 1806c000\n")
    assert not outcome.ok
    assert "Bad input argument" in outcome.verdicts[0].detail


@pytest.mark.parametrize("kind", ["processor", "power-on"])
def test_script_continues_after_a_reset(folder: Path, kind: str) -> None:
    outcome = fly(
        folder,
        f"""
        at 2 reset {kind}
        expect event SAMPLE_APP 1 within 3
        after 1 send OWN_ASK Value=3
        expect tlm OWN_ANSWER Value == 3
        expect app OWN RUNNING
        """,
    )
    assert outcome.ok, outcome.text()
    assert 2.0 < outcome.verdicts[1].at_s < 5


def test_step_after_a_reset_concerns_the_time_after_it(folder: Path) -> None:
    outcome = fly(folder, "at 2 reset processor\nexpect app OWN RUNNING within 3\nsend OWN_ASK Value=3\n")
    assert outcome.ok, outcome.text()
    reset_s, running_s, sent_s = (each.at_s for each in outcome.verdicts)
    assert 2 < reset_s < 2.1 < 2.4 < running_s == sent_s


def test_reset_without_a_subscriber_of_commands_fails(folder: Path) -> None:
    outcome = fly(folder, "at 0.01 reset processor\n")
    assert verdicts(outcome) == [(False, 0.01)]
    assert "MsgId 0x1806 has no subscriber" in outcome.text()


def test_command_without_a_subscriber_fails_its_step(folder: Path) -> None:
    outcome = fly(folder, "send CFE_ES_NOOP\nsend raw 1806c00000010020\nat 2 send CFE_ES_NOOP\n")
    assert verdicts(outcome) == [(False, 0), (True, 0), (True, 2)]
    assert outcome.verdicts[0].detail == "MsgId 0x1806 has no subscriber at this time"


def test_restart_of_a_dead_app_is_seen(folder: Path) -> None:
    outcome = fly(
        folder,
        """
        at 2 send OWN_ASK Value=14
        expect console "ValueError: fourteen" within 1
        expect event CFE_ES * INFORMATION "Restart Application OWN" within 20
        after 1 send OWN_ASK Value=1
        expect tlm OWN_ANSWER Value == 1
        """,
    )
    assert outcome.ok, outcome.text()


def test_outcome_is_the_same_on_threads_and_greenlets(folder: Path) -> None:
    pytest.importorskip("greenlet")
    text = "at 2 send OWN_ASK Value=13\nexpect tlm OWN_ANSWER\nexpect no event * ERROR until 4\nexpect app NOBODY\n"
    assert fly(folder, text, tasks="thread") == fly(folder, text, tasks="greenlet") == fly(folder, text)


def test_plain_data(folder: Path) -> None:
    outcome = fly(folder, "at 2 expect app NOBODY\n")
    step = outcome.to_dict()["steps"][0]
    assert outcome.to_dict()["ok"] is False
    assert (step["line"], step["step"], step["ok"], step["at_s"]) == (1, "at 2 expect app NOBODY", False, 2.0)
