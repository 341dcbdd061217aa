"""`Journey`: the state of a replay that can go back: the moments it has been at, and its next stop.

A replay is the same each time. So to go back, cfepy flies it again from its beginning without output, and stops
earlier: at a known moment, or at the last earlier moment for which a text matches, which is searched first.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

NOTHING_BEFORE = "no match before this point of the run"


class RunMoment(NamedTuple):
    """A moment of a run, the same in each replay of it.

    Attributes:
        happened: number of events until then.
        hits: number of breakpoint matches since the last event.
        finds: number of matches of the searched text since then.
        text: the searched text.
    """

    happened: int
    hits: int = 0
    finds: int = 0
    text: str = ""

    def before(self) -> RunMoment:
        """Return the moment of the last event before."""
        return RunMoment(self.happened if self.hits or self.finds else self.happened - 1)


class LineMoment(NamedTuple):
    """A moment of a task in Python's debugger: the number of its own lines that have begun."""

    task: int
    lines: int


AnyMoment = RunMoment | LineMoment


@dataclass(slots=True)
class BackSearch:
    """A search for a moment, up to a limit.

    Attributes:
        text: as for `--back-to`; empty for breakpoints.
        limit: the moment at which it ends; None for the end of the run.
        found: the last match until now.
        begins_at: number of events at its beginning; earlier events are searched after that.
        origin: the user's moment; None for the limit.
    """

    text: str
    limit: AnyMoment | None
    found: AnyMoment | None = None
    begins_at: int = 0
    origin: AnyMoment | None = None


class Journey:
    """The state that flights of one replay share.

    Args:
        asks_at_end: the user is asked at the end of the run.
        back_to: the text to search for in the first flight.

    Attributes:
        target: the moment of the next stop; None if no moment is skipped.
        search: the current search.
        texts: all searched texts.
        flies_again: this flight is aborted for another one.
        was_in_vain: a search has found nothing, and its user has not been informed yet.
    """

    def __init__(self, asks_at_end: bool = False, back_to: str | None = None) -> None:
        self.asks_at_end = asks_at_end
        self.target: AnyMoment | None = None
        self.search = None if back_to is None else BackSearch(back_to, None)
        self.texts = [] if back_to is None else [back_to]
        self.flies_again = self.was_in_vain = False

    @property
    def is_silent(self) -> bool:
        """Whether nothing is shown, because the user has seen it before."""
        return self.target is not None or self.search is not None

    def go_to(self, target: AnyMoment) -> None:
        """Stop at a moment, in another flight."""
        self.target, self.search, self.flies_again = target, None, True

    def look_for(self, text: str, limit: AnyMoment) -> None:
        """Find the last matching moment before another one, in another flight; see `BackSearch`."""
        self.target, self.search, self.flies_again = None, BackSearch(text, limit), True
        if text and text not in self.texts:
            self.texts.append(text)

    def arrives(self, moment: AnyMoment) -> bool:
        """Return True if the user is to be asked at a moment. A search that ends there with success ends the flight."""
        if self.target == moment:
            self.target = None
            return True
        if self.search is None or self.search.limit != moment:
            return False
        return not self.ends_search()

    def ends_search(self) -> bool:
        """End the search, and go to its match if there is one. Returns True if another flight is needed."""
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
        """Record a match of the search."""
        search = self.search
        if search is None or search.text != text or moment == search.limit:
            return
        if text or type(moment) is type(search.limit):  # pdb's breakpoints differ from breakpoints of the run
            search.found = moment


class LineWay:
    """The way back from one line of a task to another.

    Args:
        journey: of the replay.
        task: number of the task.
        break_off: ends this flight.
        say: shows a text to the user.
    """

    def __init__(self, journey: Journey, task: int, break_off: Callable[[], None], say: Callable[[str], None]) -> None:
        self._journey = journey
        self._at = LineMoment(task, 0)
        self._break_off = break_off
        self._say = say

    @property
    def is_silent(self) -> bool:
        """Whether the user has seen all this before; then breakpoints do not stop."""
        return self._journey.is_silent

    def passes(self, has_break: bool) -> bool:
        """Count a line of the task that begins. Returns True if the user is to be asked there."""
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
        """Go back to the line before. Returns False if this is the first one."""
        if self._at.lines < 2:
            self._say(NOTHING_BEFORE)
            return False
        self._journey.go_to(LineMoment(self._at.task, self._at.lines - 1))
        self._break_off()
        return True

    def to_break(self) -> bool:
        """Go back to the last line with a breakpoint."""
        self._journey.look_for("", self._at)
        self._break_off()
        return True
