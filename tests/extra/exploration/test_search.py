"""Which schedules a search gives, in which order."""

from __future__ import annotations

from collections import Counter
from itertools import islice

import pytest

from cfepy.extra.exploration.missing_points import OpenPlaces
from cfepy.extra.exploration.schedule_kinds import NOTHING_FOUND
from cfepy.extra.exploration.search import NewSwitchSearch, SeededSearch, SystematicSearch, make_search, shares
from cfepy.extra.exploration.verdict import Verdict
from cfepy.schedules.schedule import Schedule


def next_of(search: SeededSearch | SystematicSearch) -> str | None:
    """Return the next schedule as text."""
    found = search.next()
    return None if found is None else found.text()


def first(
    policy: str,
    count: int,
    depth: int | None = None,
    options: str = "at",
    seed: int = 0,
    openings: OpenPlaces = NOTHING_FOUND,
) -> list[str]:
    search = make_search(policy, depth, 50, Schedule.parse(options), seed, openings=openings)
    found = search.next()
    assert found is not None
    search.tell(0, Verdict(found))
    more = islice(iter(search.next, None), count - 1)
    return [found.text(), *(each.text() for each in more if each is not None)]


def test_seeds_of_one_policy_are_counted_up() -> None:
    assert first("random", 3) == ["random:0", "random:1", "random:2"]
    assert first("pct", 2, seed=7) == ["pct:7:3:50", "pct:8:3:50"]
    assert first("pct", 1, depth=5) == ["pct:0:5:50"]


def test_all_policy_mixes_schedules_without_duplicates() -> None:
    found = first("all", 40)
    assert len(set(found)) == 40
    assert {text.split(":")[0] for text in found} == {"random", "pct", "abreast"}
    assert {text.split(":")[2] for text in found if text.startswith("pct")} >= {"1", "2", "3"}


def test_options_are_part_of_every_schedule() -> None:
    assert all(":any:hold=500us" in text for text in first("all", 8, options="at:any:hold=500us"))


def test_pct_uses_the_decisions_of_the_first_schedule() -> None:
    search = make_search("pct", None, 50, Schedule.parse("at"))
    assert [next_of(search), next_of(search)] == ["pct:0:3:50", None]
    search.tell(0, Verdict(Schedule.parse("pct:0:3:50"), decisions=120))
    assert [next_of(search), next_of(search)] == ["pct:1:3:120", "pct:2:3:120"]
    search.tell(1, Verdict(Schedule.parse("pct:1:3:120"), decisions=300))
    assert next_of(search) == "pct:3:3:120"


def test_each_schedule_equals_its_parsed_text() -> None:
    for policy in ("all", "random", "pct", "abreast"):
        search = make_search(policy, None, 50, Schedule.parse("at:any"))
        for number in range(12):
            schedule = search.next()
            assert schedule is not None
            assert Schedule.parse(schedule.text()) == schedule
            search.tell(number, Verdict(schedule, decisions=120))


def test_fifo_may_have_the_most_decisions() -> None:
    search = make_search("all", None, 50, Schedule.parse("at"))
    assert [next_of(search), next_of(search)] == ["random:0", None]
    search.tell(0, Verdict(Schedule("random", 0), decisions=20))
    assert next_of(search) == "pct:1:2:50"


def test_with_points_between_calls_random_has_the_most_turns() -> None:
    search = make_search("all", None, 50, Schedule.parse("at:points=attributes"))
    texts = [next_of(search)]
    search.tell(0, Verdict(Schedule("random", 0), decisions=20))
    texts += [next_of(search) for _ in range(5)]
    kinds = ["random:0", "pct:1:3:50", "abreast:2", "random:3:hold=1ms", "random:4", "random:5:hold=1ms"]
    assert texts == [f"{kind}:points=attributes" for kind in kinds]


def test_one_schedule_of_four_has_points_at_shared_data() -> None:
    found = first("all", 32, openings=OpenPlaces(("goals", "total")))
    assert sum(text.endswith(":points=shared,goals,total") for text in found) == 8
    assert found[:6] == first("all", 6)
    assert {text.split(":")[0] for text in found if "shared" in text} == {"random", "pct"}


def test_any_priority_has_turns_if_tasks_of_different_priority_overlap() -> None:
    found = first("all", 32, openings=OpenPlaces(overlaps=True))
    assert sum(text.endswith(":any") for text in found) == 8
    assert not any(
        ":any:any" in text for text in first("all", 32, options="at:any", openings=OpenPlaces(overlaps=True))
    )


def test_other_policies_do_not_use_openings() -> None:
    openings = OpenPlaces(("total",), overlaps=True)
    assert first("random", 20, openings=openings) == first("random", 20)
    with_points = first("all", 20, options="at:points=lines", openings=openings)
    assert with_points == first("all", 20, options="at:points=lines")


def test_given_depth_is_kept_with_points() -> None:
    search = make_search("all", 5, 50, Schedule.parse("at:points=lines"))
    search.next()
    search.tell(0, Verdict(Schedule("random", 0), decisions=20))
    assert next_of(search) == "pct:1:5:50:points=lines"


def test_systematic_search_follows_verdicts() -> None:
    search = make_search("dfs", 1, 50, Schedule.parse("at"))
    assert next_of(search) == "at"
    assert next_of(search) is None
    search.tell(0, Verdict(Schedule("at"), widths=(-2, 3)))
    assert [next_of(search) for _ in range(4)] == ["at:0=1", "at:1=1", "at:1=2", None]


def test_a_systematic_search_has_two_preemptions_by_default() -> None:
    found: list[list[str]] = []
    for depth in (None, 2, 1):
        search, texts = make_search("dfs", depth, 10, Schedule()), list[str]()
        while (schedule := search.next()) is not None:
            texts.append(schedule.text())
            search.tell(len(texts) - 1, Verdict(schedule, widths=(-2, -2, -2)))
        found.append(texts)
    assert found[0] == found[1]
    assert len(found[1]) == 1 + 3 + 3
    assert len(found[2]) == 1 + 3


@pytest.mark.parametrize(("tick_ns", "hold"), [(0, "1ms"), (500_000, "1ms"), (10_000_000, "10ms")])
def test_tasks_are_held_up_for_a_tick_at_least(tick_ns: int, hold: str) -> None:
    search = make_search("all", None, 50, Schedule.parse("at"), tick_ns=tick_ns)
    search.next()
    search.tell(0, Verdict(Schedule(), decisions=50))
    assert any(str(search.next()).endswith(f":hold={hold}:late={hold}") for _ in range(4))


# -- searches for new switches ---------------------------------------------------------------------------------------


def told(late: int, count: int = 180) -> list[str]:
    """Return the schedules of a search in which PCT of depth 3 alone brings new switches.

    Args:
        late: verdicts that are still missing when a schedule is given out, at most; as with other processes.
        count: number of schedules.
    """
    search = make_search("all", None, 50, Schedule.parse("at"), new_switches=True)
    found: list[Schedule] = []
    known = 0
    while len(found) < count:
        schedule = search.next() if len(found) - known <= late else None
        if schedule is not None:
            found.append(schedule)
            continue
        verdict = Verdict(
            found[known],
            switches=(known,) if found[known].text().startswith("pct") and found[known].depth == 3 else (),
            decisions=50,
        )
        search.tell(known, verdict)
        known += 1
    return [each.text() for each in found]


def test_search_for_new_switches_prefers_the_policy_that_brings_them() -> None:
    deep = [text.startswith("pct") and text.endswith(":3:50") for text in told(0)]
    first, last = sum(deep[:60]), sum(deep[120:])
    assert first == 10
    assert last > 20
    assert {text.partition(":")[0] for text in told(0)[120:]} == {"random", "pct", "abreast"}


def test_search_for_new_switches_does_not_depend_on_the_number_of_processes() -> None:
    assert told(0) == told(7) == told(29)


def test_each_kind_of_schedule_keeps_a_turn() -> None:
    turns = shares(Counter({2: 1000}), Counter({0: 10, 1: 10, 2: 10}), 3, 15)
    assert (turns.count(0), turns.count(1), turns.count(2)) == (1, 1, 13)
    assert shares(Counter(), Counter(), 3, 6) == [0, 1, 2, 0, 1, 2]


def test_search_for_new_switches_is_a_search_of_one_policy_as_well() -> None:
    search = make_search("random", None, 50, Schedule.parse("at"), new_switches=True)
    assert isinstance(search, NewSwitchSearch)
    assert [next_of(search) for _ in range(3)] == ["random:0", "random:1", "random:2"]
