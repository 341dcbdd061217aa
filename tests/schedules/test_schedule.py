"""The text form of schedules."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cfepy.rtos import PCT, Decision, Deviations, Kernel, SeededRandom
from cfepy.schedules import Schedule
from cfepy.status import UsageError

TASKS = [Kernel().host, Kernel().host]
NUMBERS = st.integers(0, 10**9)
POINTS = st.sampled_from(["", "lines", "attributes,arm", "calls,a-b,c.d"])
OPTIONS = {"any_priority": st.booleans(), "hold_ns": NUMBERS, "from_ns": NUMBERS, "points": POINTS}
AT_POINTS = Schedule("at", deviations=((3, 1),), any_priority=True, points="attributes,arm,util")
SCHEDULES = st.one_of(
    st.just(Schedule()),
    st.builds(Schedule, st.just("random"), seed=NUMBERS, **OPTIONS),
    st.builds(Schedule, st.just("pct"), seed=NUMBERS, depth=st.integers(1, 9), steps=st.integers(1, 10**6), **OPTIONS),
    st.builds(Schedule, st.just("abreast"), seed=NUMBERS, **OPTIONS),
    st.builds(Schedule().at, st.dictionaries(NUMBERS, st.integers(1, 9), max_size=5)),
)


@given(SCHEDULES)
def test_text_of_a_schedule_parses_to_it(schedule: Schedule) -> None:
    assert Schedule.parse(schedule.text()) == schedule


@pytest.mark.parametrize(
    ("text", "schedule"),
    [
        ("fifo", Schedule()),
        ("random", Schedule("random", 5)),
        ("random:7", Schedule("random", 7)),
        ("random:any", Schedule("random", 5, any_priority=True)),
        ("abreast:any", Schedule("abreast", 5, any_priority=True)),
        ("abreast:7", Schedule("abreast", 7)),
        ("pct:7", Schedule("pct", 7)),
        ("pct:7:2", Schedule("pct", 7, depth=2)),
        ("pct:7:2:500:hold=2ms:any", Schedule("pct", 7, depth=2, steps=500, any_priority=True, hold_ns=2_000_000)),
        ("at:97=2,42=1", Schedule("at", deviations=((42, 1), (97, 2)))),
        ("at:42=0,97=2", Schedule("at", deviations=((97, 2),))),
        ("at", Schedule("at")),
        ("random:1:from=600ms", Schedule("random", 1, from_ns=600_000_000)),
        ("at:3=1:any:connect=50ms", Schedule("at", deviations=((3, 1),), any_priority=True, connect_ns=50_000_000)),
        ("at:3=1:points=attributes,arm,util.py:any", AT_POINTS),
        ("at:3=1:hold=500us", Schedule("at", deviations=((3, 1),), hold_ns=500_000)),
    ],
)
def test_short_forms_of_a_schedule_are_parsed(text: str, schedule: Schedule) -> None:
    assert Schedule.parse(text, seed=5) == schedule


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "expected fifo, random"),
        ("rondom:1", "unknown schedule 'rondom'; did you mean random?"),
        ("fifo:any", "invalid schedule 'fifo:any'; expected fifo alone, without options"),
        ("fifo:1", "invalid schedule 'fifo:1'; expected fifo alone"),
        (
            "random:1:points=all",
            "invalid kind of points 'all'; did you mean calls? (expected lines, attributes, calls or shared)",
        ),
        ("random:1:points=lines,", "invalid module ''; write for instance lines:arm,util"),
        ("random:1:2", "invalid schedule 'random:1:2'; expected random[:SEED], then options such as :any"),
        ("random:-1", "SEED must be a whole number of at least 0, not '-1'"),
        ("pct:1:0", "DEPTH must be a whole number of at least 1, not '0'"),
        ("pct:1:2:x", "STEPS must be a whole number of at least 1, not 'x'"),
        ("at:3", "'3' is not DECISION=CHOICE"),
        ("at:1=1,1=2", "decision 1 is given twice"),
        ("random:1:hold=500", "such as hold=500us"),
        ("random:1:connect=never", "such as connect=500us"),
        ("random:1:hold=0s", "such as hold=500us"),
    ],
)
def test_invalid_schedule_is_refused_with_advice(text: str, says: str) -> None:
    with pytest.raises(UsageError, match="--schedule") as caught:
        Schedule.parse(text)
    assert says in str(caught.value)


def test_each_kind_of_schedule_has_its_policy() -> None:
    assert Schedule().policy() is None
    assert isinstance(Schedule.parse("random:1").policy(), SeededRandom)
    assert isinstance(Schedule.parse("pct:1").policy(), PCT)
    policy = Schedule.parse("at:3=1:any:hold=1us").policy()
    assert isinstance(policy, Deviations)
    assert policy.any_priority
    assert policy.hold_ns == 1000


def test_deviations_keep_the_options_of_their_schedule() -> None:
    assert Schedule.parse("random:7:any:hold=1us").at({5: 1, 2: 3}).text() == "at:2=3,5=1:any:hold=1us"


@pytest.mark.parametrize("seed", range(8))
def test_pct_changes_only_at_its_decisions(seed: int) -> None:
    def answers(depth: int, steps: int) -> list[int]:
        policy = PCT(seed, depth, steps)
        return [policy.choose(Decision(number, 0, TASKS, False, False, None)) for number in range(4)]

    without = answers(1, 1)
    assert without == [without[0]] * 4
    at_the_first = answers(2, 1)
    assert at_the_first == [at_the_first[0]] * 4
    first, *others = answers(3, 2)
    assert others == [1 - first] * 3
