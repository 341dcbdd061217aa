"""Faults on messages: that they happen, and their effects on receivers."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.faults import FaultInjector, FaultPlan
from cfepy.mission import Mission
from tests.faults.worlds import fly, row, told, values

NUMBER = "NUMBER_TLM"


@pytest.mark.parametrize("name", [NUMBER, 0x0883, "0x883", "NUMBER_*"])
def test_a_dropped_message_leaves_a_gap_in_the_sequence_counts(tmp_path: Path, name: str | int) -> None:
    mission = fly(tmp_path, {"drop": name, "number": 3})
    assert values(mission)[:4] == values(mission, "OTHER")[:4] == [0, 1, 3, 4]
    assert told(mission, "TAKER got") == ["TAKER got 4 after 2"]
    fault = row(mission, "drop-1")
    assert fault["times"] == 1
    assert fault["never"] is None
    assert fault["details"] == ["drops NUMBER_TLM #3 sent by SOURCE"]
    assert told(mission, "cfepy fault drop-1: drops NUMBER_TLM #3 sent by SOURCE")


def test_dropped_message_is_counted_as_sent_only(tmp_path: Path) -> None:
    mission = fly(tmp_path, {"drop": NUMBER, "number": 3})
    route = mission.cfe.sb.routes[0x0883]
    count = len(values(mission))
    assert (route.sent, route.totals()[0]) == (count + 1, 2 * count)


def test_drop_for_one_receiver_spares_the_other(tmp_path: Path) -> None:
    mission = fly(tmp_path, {"drop": NUMBER, "number": 3, "to": "OTHER"})
    assert values(mission)[:4] == [0, 1, 2, 3]
    assert values(mission, "OTHER")[:4] == [0, 1, 3, 4]
    assert row(mission, "drop-1")["details"] == ["drops NUMBER_TLM #3 on pipe OTHER_PIPE"]


def test_drop_selects_a_pipe_and_a_sender(tmp_path: Path) -> None:
    drop = {"drop": NUMBER, "count": 2}
    mission = fly(
        tmp_path,
        drop | {"name": "right", "to": "OTHER_PIPE", "from": "SOURCE"},
        drop | {"name": "wrong", "to": "OTHER_PIPE", "from": "TAKER"},
        drop | {"name": "nobody", "from": "OTHER"},
    )
    assert values(mission, "OTHER")[:2] == [2, 3]
    assert values(mission)[:2] == [0, 1]
    assert [row(mission, name)["times"] for name in ("right", "wrong", "nobody")] == [2, 0, 0]


def test_duplicate_has_the_same_sequence_count(tmp_path: Path) -> None:
    mission = fly(tmp_path, {"duplicate": NUMBER, "number": 2, "copies": 2})
    assert values(mission)[:6] == [0, 1, 1, 1, 2, 3]
    assert told(mission, "TAKER got")[:2] == ["TAKER got 2 after 2", "TAKER got 2 after 2"]
    assert mission.cfe.sb.routes[0x0883].sent == len(values(mission)) - 2


def test_duplicate_reaches_only_its_receiver(tmp_path: Path) -> None:
    mission = fly(tmp_path, {"duplicate": NUMBER, "number": 2, "to": "TAKER"})
    assert values(mission)[:5] == [0, 1, 1, 2, 3]
    assert values(mission, "OTHER")[:4] == [0, 1, 2, 3]


@pytest.mark.parametrize("to", [{}, {"to": "TAKER"}])
def test_delayed_message_arrives_between_later_ones(tmp_path: Path, to: dict[str, str]) -> None:
    mission = fly(tmp_path, {"delay": NUMBER, "by": 0.25, "number": 2, **to})
    assert values(mission)[:6] == [0, 2, 3, 1, 4, 5]
    assert values(mission, "OTHER")[:3] == ([0, 1, 2] if to else [0, 2, 3])
    assert "delays by 0.25 s" in row(mission, "delay-1")["details"][0]


def test_short_delay_during_a_long_one_ends_first(tmp_path: Path) -> None:
    long, short = {"delay": NUMBER, "by": 0.25, "number": 2}, {"delay": NUMBER, "by": 0.02, "number": 3}
    mission = fly(tmp_path, long | {"name": "long"}, short | {"name": "short"})
    assert values(mission)[:6] == [0, 2, 3, 1, 4, 5]
    assert [row(mission, name)["times"] for name in ("long", "short")] == [1, 1]


def test_a_delay_may_have_a_range(tmp_path: Path) -> None:
    mission = fly(tmp_path, {"delay": NUMBER, "by": [0.01, 0.05], "after": 1.2})
    texts = row(mission, "delay-1")["details"]
    delays = {float(text.split()[2]) for text in texts}
    assert len(delays) > 5
    assert all(0.01 <= delay <= 0.05 for delay in delays)
    assert values(mission)[:5] == [0, 1, 2, 3, 4]


@pytest.mark.parametrize("to", [{}, {"to": "TAKER"}])
def test_reordered_messages_arrive_after_later_ones(tmp_path: Path, to: dict[str, str]) -> None:
    mission = fly(tmp_path, {"reorder": NUMBER, "number": 2, "past": 2, **to})
    assert values(mission)[:6] == [0, 2, 3, 1, 4, 5]


def test_reordered_message_arrives_at_its_time_limit_when_no_other_follows(tmp_path: Path) -> None:
    mission = fly(tmp_path, {"reorder": NUMBER, "number": 2, "past": 500, "within": 0.55})
    assert values(mission)[:8] == [0, 2, 3, 4, 5, 6, 1, 7]


def test_bits_of_the_payload_turn_over(tmp_path: Path) -> None:
    mission = fly(tmp_path, {"corrupt": NUMBER, "number": 2, "bits": 1})
    wrong = values(mission)[1]
    assert bin(wrong ^ 1).count("1") == 1
    assert not told(mission, "TAKER got")


def test_corrupt_command_has_a_bad_checksum_unless_it_is_fixed(tmp_path: Path) -> None:
    order = {"corrupt": "ORDER_CMD", "bytes": {"8": 77}}
    kept = fly(tmp_path, order | {"number": 2})
    assert told(kept, "TAKER sees") == ["TAKER sees a bad checksum in order 77"]
    assert not told(fly(tmp_path, order | {"number": 2, "checksum": "fix"}), "TAKER sees")


def test_damaged_header_does_not_affect_its_sender(tmp_path: Path) -> None:
    mission = fly(
        tmp_path,
        {"corrupt": NUMBER, "number": 2, "bytes": {"4": 0x7F}},  # the length
        {"corrupt": NUMBER, "number": 4, "bytes": {"0": 0xFF}},  # the MsgId
    )
    assert values(mission)[:4] == [0, 2, 4, 5]
    assert mission.record.history["SOURCE"].deaths == 0
    assert sum("Send Err" in line for line in mission.console.lines) == 2


def test_random_bits_spare_the_primary_header_of_a_packet_without_data(tmp_path: Path) -> None:
    mission = fly(tmp_path, {"corrupt": "CFE_TIME_TONE_CMD", "bits": 16})
    assert row(mission, "corrupt-1")["times"] > 1
    assert all(history.deaths == 0 for history in mission.record.history.values())


def test_a_field_is_set(tmp_path: Path) -> None:
    mission = fly(
        tmp_path,
        {"corrupt": NUMBER, "number": 2, "fields": {"Value": 1234}},
        {"corrupt": "ORDER_CMD", "number": 1, "fields": {"Value": 5}},
    )
    assert values(mission)[:3] == [0, 1234, 2]
    assert not told(mission, "TAKER sees")


def test_unknown_field_is_reported(tmp_path: Path) -> None:
    mission = fly(tmp_path, {"corrupt": NUMBER, "number": 2, "fields": {"Valu": 1}})
    why = "cannot set Valu of NUMBER_TLM: the field is missing or has another type"
    assert told(mission, "cfepy fault") == [f"cfepy fault corrupt-1: did not happen: {why}"]
    assert row(mission, "corrupt-1")["never"] == why
    assert values(mission)[:3] == [0, 1, 2]


def test_faults_strike_in_the_order_of_the_plan(tmp_path: Path) -> None:
    mission = fly(
        tmp_path,
        {"duplicate": NUMBER, "number": 2},
        {"corrupt": NUMBER, "number": 2, "fields": {"Value": 99}},
    )
    assert values(mission)[:4] == [0, 99, 99, 2]


def test_dropped_message_gets_no_other_fault(tmp_path: Path) -> None:
    mission = fly(tmp_path, {"drop": NUMBER, "number": 2}, {"duplicate": NUMBER, "number": 2})
    assert values(mission)[:3] == [0, 2, 3]
    assert row(mission, "duplicate-1")["never"] == "drop-1 has dropped the message before"


def test_windows_counts_and_instants(tmp_path: Path) -> None:
    drop = {"drop": NUMBER}
    assert values(fly(tmp_path, drop | {"after": 1.93, "until": 2.12}))[:6] == [0, 1, 2, 3, 6, 7]
    assert values(fly(tmp_path, drop | {"every": 2, "count": 2}))[:5] == [0, 2, 4, 5, 6]
    assert values(fly(tmp_path, drop | {"at": [1.93, 2.1]}))[:7] == [0, 1, 2, 3, 5, 7, 8]
    assert values(fly(tmp_path, drop | {"number": [1, 3]}))[:3] == [1, 3, 4]


def test_probability_depends_only_on_seed_and_name(tmp_path: Path) -> None:
    drop = {"drop": NUMBER, "probability": 0.5, "name": "half"}
    alone = values(fly(tmp_path, drop, seconds=6))
    assert 10 < len(alone) < 40
    beside = fly(tmp_path, {"drop": "ORDER_CMD", "probability": 0.5, "name": "others"}, drop, seconds=6)
    assert values(beside) == alone
    assert values(fly(tmp_path, drop, seconds=6, seed=1)) != alone
    assert values(fly(tmp_path, drop | {"name": "another"}, seconds=6)) != alone


def test_trace_is_reproducible_on_threads_and_greenlets(tmp_path: Path) -> None:
    faults = [
        {"drop": NUMBER, "probability": 0.2},
        {"delay": "ORDER_CMD", "by": [0.01, 0.3], "probability": 0.5},
        {"reorder": NUMBER, "every": 3, "to": "OTHER"},
        {"corrupt": "ORDER_CMD", "probability": 0.3, "bits": 3},
    ]
    digests = {fly(tmp_path, *faults, tasks=tasks).trace.digest() for tasks in ("thread", "greenlet", "thread")}
    assert len(digests) == 1
    assert fly(tmp_path).trace.digest() not in digests


def test_fault_of_an_unused_queue_call_suggests_the_call_for_pipes(tmp_path: Path) -> None:
    mission = fly(tmp_path, {"fail": "OS_QueueGet", "number": 1}, {"fail": "OS_MutSemTake", "app": "TAKER"})
    reasons = [each["never"] for each in mission.record.rows("faults")]
    text = "pipes are read without it: use a fault of CFE_SB_ReceiveBuffer"
    assert reasons[0] == f"no matching task called os.queue_get; {text}"
    assert reasons[1] == "no matching task called os.mut_sem_take"


def test_fault_that_never_struck_has_a_reason(tmp_path: Path) -> None:
    mission = fly(
        tmp_path,
        {"drop": "NUMBRE_TLM"},
        {"drop": NUMBER, "after": 100},
        {"drop": NUMBER, "number": 900},
    )
    reasons = [each["never"] for each in mission.record.rows("faults")]
    assert reasons[0] == "no matching message was delivered"
    assert "but never within its time window" in reasons[1]
    assert "none" in reasons[2] or "but never at one" in reasons[2]


def test_faults_continue_after_a_reset(tmp_path: Path) -> None:
    mission = fly(tmp_path, {"drop": NUMBER, "number": [2, 12]}, {"reset": "processor", "at": 1.98}, seconds=5)
    assert len(mission.record.resets) == 1
    numbers = values(mission)
    again = numbers.index(0, 1)
    first, second = numbers[:again], numbers[again:]
    assert first == [0, *range(2, 5)]
    assert second[:7] == [0, 1, 2, 3, 4, 5, 7]  # the twelfth message of both lives is missing
    assert row(mission, "drop-1")["times"] == 2


def test_plan_without_message_faults_does_not_change_the_bus(tmp_path: Path) -> None:
    mission = fly(tmp_path, {"jump_clock": 1, "at": 50})
    assert type(mission.cfe.sb).__name__ == "SoftwareBus"
    assert FaultInjector(FaultPlan()).bus(Mission) is Mission  # type: ignore[arg-type, comparison-overlap]
