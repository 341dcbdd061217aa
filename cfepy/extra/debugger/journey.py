"""`Journey`: where a replay that can go back has been, and where it is to stop next.

A replay does the same each time. So to go back is to fly it again from its beginning, unseen and unheard, and to stop
earlier: at a moment that is known, or at the last one before now of which something holds, which is looked for first.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

NOTHING_BEFORE = "no match before this point of the run"


class RunMoment(NamedTuple):
    """A moment of a run, the same in each replay of it.

    Attributes:
        happened: how many things have happened until then.
        hits: how many breakpoints have stopped since the last of these.
        finds: how often what is looked for was found since then.
        text: what is looked for.
    """

    happened: int
    hits: int = 0
    finds: int = 0
    text: str = ""

    def before(self) -> RunMoment:
        """The last thing that happened before."""
        return RunMoment(self.happened if self.hits or self.finds else self.happened - 1)


class LineMoment(NamedTuple):
    """A moment of a task that Python's debugger looks into: so many lines of its own code have begun."""

    task: int
    lines: int


AnyMoment = RunMoment | LineMoment


@dataclass(slots=True)
class BackSearch:
    """What is looked for, up to a moment.

    Attributes:
        text: as for `--back-to`; empty for breakpoints.
        limit: the moment; None for the end of the run.
        found: the last one until now.
        begins_at: how many things have happened where it begins; what was before is looked through after that.
        origin: where the user was; None for the limit.
    """

    text: str
    limit: AnyMoment | None
    found: AnyMoment | None = None
    begins_at: int = 0
    origin: AnyMoment | None = None


class Journey:
    """What flights of one replay have in common.

    Args:
        asks_at_end: the user is asked at the end of the run.
        back_to: what to look for in the first flight.

    Attributes:
        target: where to stop; None when nothing is stepped over.
        search: what is looked for.
        texts: all that was looked for.
        flies_again: this flight is broken off, for another one.
        was_in_vain: a search has found nothing, and its user is not told yet.
    """

    def __init__(self, asks_at_end: bool = False, back_to: str | None = None) -> None:
        self.asks_at_end = asks_at_end
        self.target: AnyMoment | None = None
        self.search = None if back_to is None else BackSearch(back_to, None)
        self.texts = [] if back_to is None else [back_to]
        self.flies_again = self.was_in_vain = False

    @property
    def is_silent(self) -> bool:
        """Whether nothing is shown, as the user has seen it before."""
        return self.target is not None or self.search is not None

    def go_to(self, target: AnyMoment) -> None:
        """Stop there, in another flight."""
        self.target, self.search, self.flies_again = target, None, True

    def look_for(self, text: str, limit: AnyMoment) -> None:
        """Find the last moment before another, in another flight; see `BackSearch`."""
        self.target, self.search, self.flies_again = None, BackSearch(text, limit), True
        if text and text not in self.texts:
            self.texts.append(text)

    def arrives(self, moment: AnyMoment) -> bool:
        """Whether the user is to be asked at a moment; when a search ends there, with success, the flight is over."""
        if self.target == moment:
            self.target = None
            return True
        if self.search is None or self.search.limit != moment:
            return False
        return not self.ends_search()

    def ends_search(self) -> bool:
        """The search is over: go to what it has found, if it has."""
        assert self.search is not None
        search, self.search = self.search, None
        if search.found is not None:
            self.go_to(search.found)
        elif search.begins_at > 1:
            self.flies_again = True
            self.search = BackSearch(search.text, RunMoment(search.begins_at), None, 0, search.origin or search.limit)
        elif search.origin is not None:
            self.go_to(search.origin)
            self.was_in_vain = True
        return self.flies_again

    def finds(self, moment: AnyMoment, text: str = "") -> None:
        """Something was found, in the search for it."""
        search = self.search
        if search is None or search.text != text or moment == search.limit:
            return
        if text or type(moment) is type(search.limit):  # a debugger's breakpoints are others than those of the run
            search.found = moment


class LineWay:
    """The way back from one line of a task to another.

    Args:
        journey: of the replay.
        task: number of the task.
        break_off: ends this flight.
        say: tells the user something.
    """

    def __init__(self, journey: Journey, task: int, break_off: Callable[[], None], say: Callable[[str], None]) -> None:
        self._journey = journey
        self._at = LineMoment(task, 0)
        self._break_off = break_off
        self._say = say

    @property
    def is_silent(self) -> bool:
        """Whether the user has seen all this before: then breakpoints do not stop."""
        return self._journey.is_silent

    def passes(self, has_break: bool) -> bool:
        """A line of the task begins; whether the user is to be asked there."""
        journey = self._journey
        self._at = moment = LineMoment(self._at.task, self._at.lines + 1)
        if not journey.is_silent or journey.flies_again:
            return False
        if has_break:
            journey.finds(moment)
        was_search = journey.search is not None
        if journey.arrives(moment):
            if was_search:
                self._say(NOTHING_BEFORE)
            return True
        if journey.flies_again:
            self._break_off()
        return False

    def step_back(self) -> bool:
        """To the line before; False when this is the first one."""
        if self._at.lines < 2:
            self._say(NOTHING_BEFORE)
            return False
        self._journey.go_to(LineMoment(self._at.task, self._at.lines - 1))
        self._break_off()
        return True

    def to_break(self) -> bool:
        """To the last line with a breakpoint."""
        self._journey.look_for("", self._at)
        self._break_off()
        return True
