"""The search that is guided by coverage: it is the same whoever flies it, goes on from results, and finds more."""

from __future__ import annotations

import random
from collections import Counter
from hashlib import blake2b
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cfepy.exploration import Expedition, Report
from cfepy.exploration.campaign import Campaign, Inline
from cfepy.exploration.corpus import distilled, read_corpus
from cfepy.exploration.coverage import Coverage, Covered, ThingUse
from cfepy.exploration.greybox import GreyboxSearch, Member
from cfepy.exploration.results_file import ResultsFile, add_schedules, read_results
from cfepy.exploration.search import make_search
from cfepy.exploration.verdict import Verdict
from cfepy.pilot import RunPlan
from cfepy.rtos import Schedule
from cfepy.status import UsageError
from tests.exploration import missions
from tests.exploration.test_campaign_property import Flaky
from tests.exploration.test_coverage import BANK

USES = tuple(
    ThingUse("locks", thing, f"BANK.{task}", "has", "bank.py", 10 * task + number, False)
    for thing in ("left", "right")
    for task in (1, 2, 3)
    for number in (1, 2)
)
REFERENCE = Verdict(Schedule("at"), decisions=30, uses=USES)


class FakeTrial:
    """Its verdicts are functions of the schedule: an aim is met, or it is not, and other things are covered, too."""

    def run(self, schedule: Schedule) -> Verdict:
        digest = blake2b(schedule.text().encode(), digest_size=32).digest()
        covered = {Covered("variables", each % 64, index) for index, each in enumerate(digest[:4])}
        if schedule.aims and digest[4] % 2:
            one, other = (use for use in USES if use.task == schedule.aims[-1].first), digest[5]
            covered.add(Covered("locks", next(one).number % 1000, other % 30))
        widths = tuple(-2 - each % 2 for each in digest[:30])
        deviations = tuple((at, 1) for at, each in enumerate(digest[:30]) if each % 3 == 0)
        found = tuple(sorted(covered))
        return Verdict(schedule, trace=digest.hex(), decisions=30, widths=widths, deviations=deviations, covered=found)


def search() -> GreyboxSearch:
    options = Schedule("at")
    coverage = Coverage({}, frozenset())
    return GreyboxSearch(make_search("greybox", None, 30, options), coverage, REFERENCE, options)


def fly(crew: Any, path: Path, count: int) -> tuple[list[Verdict], list[Member]]:
    """What a campaign came to; one that is broken off goes on from its file."""
    while True:
        found, told = search(), list[Verdict]()
        campaign = Campaign(FakeTrial(), found, count, crew, ResultsFile(path, {}))
        try:
            tally = campaign.run(lambda number, verdict: told.append(verdict))  # noqa: B023  # run at once
        except UsageError:
            continue
        if not tally.interrupted:
            return told, found.corpus


@pytest.mark.slow
@settings(max_examples=10, deadline=None)
@given(st.integers(0, 2**32))
def test_any_crew_that_is_broken_off_anywhere_makes_the_same_corpus(seed: int) -> None:
    with TemporaryDirectory() as folder:
        whole = fly(Inline(), Path(folder, "whole"), 120)
        flaky = Flaky(random.Random(seed), (UsageError, KeyboardInterrupt), Counter())
        assert fly(flaky, Path(folder, "parts"), 120) == whole
    told, corpus = whole
    assert len(told) == 120
    assert corpus
    assert {verdict.schedule.kind for verdict in told} == {"random", "pct", "abreast", "aims", "at"}
    made = [verdict.schedule for verdict in told if verdict.schedule.kind in ("aims", "at")]
    assert len(made) == len(set(made))


def test_what_was_not_seen_is_aimed_at_and_then_not_again() -> None:
    found = search()
    for number in range(5):
        schedule = found.next()
        assert schedule is not None
        found.tell(number, Verdict(schedule))
    aimed = [schedule for schedule in iter(found.next, None) if schedule.aims]
    pairs = {(aim.first, aim.first_line, aim.then, aim.then_line) for each in aimed for aim in each.aims}
    assert len(aimed) == 7
    assert all(first != then for first, _, then, _ in pairs)
    assert sum(each.seed == 0 for each in aimed) >= 5


def test_few_schedules_that_cover_all_are_left_of_a_corpus() -> None:
    def member(number: int, *covered: int) -> Member:
        things = [Covered("locks", each, 0) for each in covered]
        return Member(number, Verdict(Schedule("random", number), covered=tuple(things)), things)

    corpus = [member(0, 1), member(1, 1, 2), member(2, 3), member(3, 1, 2, 4), member(4, 3)]
    assert [each.number for each in distilled(corpus)] == [3, 2]


@pytest.fixture
def plan(tmp_path: Path) -> RunPlan:
    return RunPlan((str(missions.write(tmp_path / "bank", {"BANK": BANK})),), seconds=0.6, tasks="greenlet")


def explored(plan: RunPlan, **options: Any) -> Report:
    return Expedition(plan, policy="greybox", jobs=1, **options).run()


@pytest.mark.slow
def test_it_finds_what_others_miss_and_a_later_campaign_begins_there(plan: RunPlan, tmp_path: Path) -> None:
    first = tmp_path / "first.results"
    report = explored(plan, seeds=30, results=str(first), shrink=20)
    (told,) = report.findings
    assert told.finding.failure.text == "exit status 1 (node /bank)"
    assert report.coverage is not None
    assert report.coverage.counts()["outcomes"] == 2
    corpus = read_corpus(first, Schedule("at", points="lines"))
    assert {each.kind for each in corpus} == {"moves"}
    assert all(each.points == "lines" for each in corpus)
    later = explored(plan, seeds=len(corpus) - 1, corpus=str(first), shrink=0)
    assert later.findings[0].finding.number == 0
    again = explored(plan, seeds=35, results=str(first), shrink=0)
    assert again.tally.resumed == 30


def test_a_corpus_of_a_campaign_that_was_broken_off_is_that_of_its_verdicts(tmp_path: Path) -> None:
    path = tmp_path / "part.results"
    told, _ = fly(Inline(), path, 20)
    found = read_corpus(path, Schedule("at"))
    assert found[0] == told[0].schedule
    assert 1 < len(found) <= 20
    add_schedules(path, [Schedule.parse("moves:A=B")])
    assert read_corpus(path, Schedule("at", any_priority=True)) == (Schedule.parse("moves:A=B:any"),)
    assert len(list(read_results(path)[1])) == 20


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"policy": "random", "corpus": "x"}, "--corpus: goes with --policy greybox"),
        ({"policy": "greybox", "worst": "wait:BANK"}, "--policy: --worst makes generations of its own"),
    ],
)
def test_what_does_not_go_together_is_told(plan: RunPlan, options: dict[str, Any], says: str) -> None:
    with pytest.raises(UsageError) as error:
        Expedition(plan, **options).run()
    assert says in str(error.value)
