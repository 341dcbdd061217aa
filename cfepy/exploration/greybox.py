"""The search that is guided by coverage: what runs covered decides which schedules come next.

    search = GreyboxSearch(make_search(...), reference)
    campaign = Campaign(replace(trial, usual=known_of(reference)), search, 200, crew)

It is a search in generations. Runs that covered something new (`cfepy.exploration.coverage`) make the corpus. In a
generation there are

- schedules with aims (`cfepy.rtos.aims`). Two uses of one thing by different tasks have been seen, and never directly
  one after the other: so that is aimed at, those first that were tried least. Then any uses may be aimed at, after some
  more steps, one or two pairs in a schedule, also behind the aims of one of the corpus;
- changed members of the corpus, those with rare things before others, with changes around the decisions of these;
- a few more from seeds.

The idea of pairs as what matters, and of the abstract schedules, is that of Wolff, Shi, Duck, Mathur and Roychoudhury:
Greybox Fuzzing for Concurrency Testing (ASPLOS 2024).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from random import Random

from cfepy.exploration.coverage import Coverage, Covered, ThingUse
from cfepy.exploration.generations import Generations, changed
from cfepy.exploration.search import SeededSearch
from cfepy.exploration.verdict import Verdict
from cfepy.rtos import Aim, Schedule

FROM_SEEDS = 5  # schedules before the first generation
AIMED, CHANGED, FRESH = 7, 3, 10
"""A generation: how many schedules of each kind. It does not depend on how many processes there are."""
NEW = 5  # of those with aims: at most so many that aim at what was not seen
MOST_TRIES = 3  # that what was not seen is aimed at, each with one step more from the first line
MOST_AIMS = 4
STEPS = (1, 1, 2, 2, 3, 4, 6)  # from the first line, where it was seen


@dataclass(slots=True)
class Member:
    """A schedule of the corpus.

    Attributes:
        number: of the schedule in the campaign.
        verdict: on it.
        new: what it was the first to cover.
        children: how many schedules were made of it.
    """

    number: int
    verdict: Verdict
    new: list[Covered]
    children: int = 0


class GreyboxSearch(Generations):
    """Schedules that are guided by coverage; see the module.

    Args:
        seeded: where the first ones and some of the later ones come from.
        coverage: what is known to be covered, by fifo; what is found is added.
        reference: the verdict on fifo, with all its uses of things.
        options: a schedule whose options all have.
        seed: of the choices.
        first: schedules that come before all others.

    Attributes:
        corpus: the schedules that covered something new.
    """

    def __init__(
        self,
        seeded: SeededSearch,
        coverage: Coverage,
        reference: Verdict,
        options: Schedule,
        seed: int = 0,
        first: tuple[Schedule, ...] = (),
    ) -> None:
        super().__init__(seeded, Random(f"greybox {seed}"), FROM_SEEDS, FRESH, first)
        self.corpus: list[Member] = []
        self._options = options
        self._coverage = coverage
        self._uses: dict[tuple[str, str], dict[ThingUse, None]] = {}  # by thing
        self._open: dict[tuple[ThingUse, ThingUse], int] = {}  # not seen, and how often aimed at
        self._learn_uses(reference)

    def learn(self, number: int, verdict: Verdict) -> None:
        """See `Generations.learn`."""
        new = self._coverage.take(number, verdict.covered)
        self._learn_uses(verdict)
        if new:
            self.corpus.append(Member(number, verdict, new))

    def _learn_uses(self, verdict: Verdict) -> None:
        """Each new use could come before and after all others of the thing by other tasks."""
        for use in verdict.uses:
            others = self._uses.setdefault(use[:2], {})
            if use in others:
                continue
            for other in others:
                if other.task != use.task and not (other.is_read and use.is_read):
                    self._open |= {pair: 0 for pair in ((use, other), (other, use)) if _is_aim(pair)}
            others[use] = None

    def generation(self) -> list[Schedule]:
        """See `Generations.generation`."""
        self._open = {pair: tries for pair, tries in self._open.items() if not self._is_covered(pair)}
        made = [*self.untried(self._aimed(), AIMED)]
        return [*made, *self.untried((self._changed() for _ in range(CHANGED * 4 if self.corpus else 0)), CHANGED)]

    def _is_covered(self, pair: tuple[ThingUse, ThingUse]) -> bool:
        return self._coverage.has(pair[0].before(pair[1]))

    # -- aims ----------------------------------------------------------------------------------------------------------

    def _aimed(self) -> Iterator[Schedule]:
        """Schedules with aims, as many as are wanted."""
        random = self.random
        least = sorted(self._open.items(), key=lambda each: (each[1], random.random()))
        for pair, tries in least[:NEW]:
            if tries < MOST_TRIES:
                self._open[pair] = tries + 1
                yield self._with([_aim(pair, tries + 1)], is_random=bool(tries))
        pairs = self._pairs()
        for _ in range(4 * AIMED if pairs else 0):
            aims = [_aim(random.choice(pairs), random.choice(STEPS))]
            if random.random() < 0.5:
                aims.append(_aim(random.choice(pairs), random.choice(STEPS)))
            yield self._with(aims, is_random=random.random() < 0.5)

    def _with(self, aims: list[Aim], is_random: bool) -> Schedule:
        """A schedule with aims, some of them behind those of a member of the corpus, for what comes of both."""
        random = self.random
        parents = [member.verdict.schedule.aims for member in self.corpus if member.verdict.schedule.aims]
        if is_random and parents and random.random() < 0.3:
            aims = [*random.choice(parents), *aims][-MOST_AIMS:]
        return self._options.with_aims(aims, random.randrange(1, 1 << 31) if is_random else 0)

    def _pairs(self) -> list[tuple[ThingUse, ThingUse]]:
        """All that could be aimed at."""
        return [
            (one, other)
            for uses in self._uses.values()
            for one in uses
            for other in uses
            if one.task != other.task and not (one.is_read and other.is_read) and _is_aim((one, other))
        ]

    # -- changes -------------------------------------------------------------------------------------------------------

    def _changed(self) -> Schedule:
        """A member of the corpus, changed around something rare."""
        random = self.random
        weights = [self._energy(member) for member in self.corpus]
        (parent,) = random.choices(self.corpus, weights)
        parent.children += 1
        verdict = parent.verdict
        covered = verdict.covered
        rarities = [self._coverage.rarity(each) for each in covered]
        (rare,) = random.choices(covered, rarities)
        end = min(rare.decision + random.randint(0, 3), len(verdict.widths))
        answers = {at: answer for at, answer in verdict.deviations if at < end or random.random() < 0.5}
        found = changed(
            random, answers, verdict.widths[:end], lambda: dict(random.choice(self.corpus).verdict.deviations)
        )
        return self._options.at({at: answer for at, answer in found.items() if answer})

    def _answers_of_any(self) -> dict[int, int]:
        return dict(self.random.choice(self.corpus).verdict.deviations)

    def _energy(self, member: Member) -> float:
        return sum(map(self._coverage.rarity, member.new)) / (1 + member.children)


def _is_aim(pair: tuple[ThingUse, ThingUse]) -> bool:
    """Whether both are in code of the mission."""
    return bool(pair[0].file and pair[1].file)


def _aim(pair: tuple[ThingUse, ThingUse], number: int) -> Aim:
    first, then = pair
    return Aim(first.task, (first.file, first.line), then.task, (then.file, then.line), number)
