"""A session of the console, without a user interface: it carries out typed lines and collects the output.

A line is a step of a mission script, a command by its name, or a word of the console such as `run 5`. The session
advances time in short steps: as long as the user asked for, and as long as a line waits for something. Its output is a
list of entries, which a screen or a plain stream shows.
"""

from __future__ import annotations

from argparse import ArgumentTypeError
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple, Protocol, TypeVar

from cfepy.cli.ground.console.pages import PacketBoard
from cfepy.cli.ground.console.saved import SavedScript, when_of
from cfepy.cli.options import LONGEST_S, count_of, factor_of, seconds_of
from cfepy.ground import EVENT_IDS, EVENT_TYPES, DecodedEvent
from cfepy.mission import Seen, receivers
from cfepy.msg import MsgType, get_type
from cfepy.reading.input_files import text_limited
from cfepy.reading.input_limits import LINE_FILE_BYTES
from cfepy.rtos import ENDLESS, Stopwatch
from cfepy.script import OVER, ROS_STEPS, TYPED, StandingScript, Step, StepVerdict
from cfepy.status import UsageError
from cfepy.units import NS_PER_S
from cfepy.writing.escapes import visible, visible_line

T = TypeVar("T")

VERBS = ("send", "expect", "reset", *ROS_STEPS)
TIMES = ("at", "after", "end")
EVENT, CONSOLE, TYPED_LINE, REPLY, GOOD, BAD = "event", "console", "typed", "reply", "good", "bad"
LOOKING = ("page", "raw", "events", "save", "help", "quit")
MAXIMUM = "max"
EVENT_PORT = "EVS Port"
REQUEST = "_SEND_HK"
SPEED_NS = NS_PER_S // 2  # wall time over which the speed is measured


class Entry(NamedTuple):
    """An output entry: its kind, its text in displayable form, and the event if it is one."""

    kind: str
    text: str
    event: DecodedEvent | None = None


class Craft(Protocol):
    """The target of a console: a mission that is flown for it, or a remote computer.

    Attributes:
        name: name for the status line.
        flows: its time advances without a request.
        script: carries out its steps.
    """

    name: str
    flows: bool
    script: StandingScript

    @property
    def stands_ns(self) -> int:
        """The virtual time in ns at which it stands, as a script would give it."""

    @property
    def is_asked(self) -> bool:
        """True if the user asked to end, by Ctrl-C or SIGTERM."""

    @property
    def is_over(self) -> bool:
        """True if time cannot advance any more."""

    def step(self, until_ns: int) -> bool:
        """Advance for a short while, at most to a virtual time in ns. Returns True if time advanced."""

    def stand(self) -> None:
        """Let time stand still for a short while."""

    def next_event(self) -> int | None:
        """Return the virtual time in ns of the next event, or None if there is none or it is not known."""

    def pace(self, factor: float | None) -> None:
        """Set the speed as a multiple of the wall clock; None is as fast as possible."""

    def news(self) -> list[Seen | str]:
        """Return packets that were sent and lines that its console printed, since the last call."""


@dataclass(frozen=True, slots=True)
class ConsoleWord:
    """A word of the console: its function, its usage, and its description."""

    act: Callable[[list[str]], None]
    usage: str
    text: str


class ConsoleSession:
    """Carries out the lines of a console.

    Args:
        craft: the target.
        board: keeps telemetry.
        saved: keeps the packets that are sent.
        factor: speed as a multiple of the wall clock; None for as fast as possible.
        stop_on_failure: the first failed step or wrong line ends the session.

    Attributes:
        words: the console's own words.
        sent: number of packets that were sent.
        failed: number of failed steps and wrong lines.
        is_over: the session has ended.
        is_landed: time cannot advance any more; the results can still be viewed.
        speed: the recent speed, as a multiple of the wall clock.
        least_type: events of a lower type are not shown.
        only_app: the only application whose events are shown; None for all.
    """

    def __init__(
        self,
        craft: Craft,
        board: PacketBoard,
        saved: SavedScript,
        factor: float | None = None,
        stop_on_failure: bool = False,
    ) -> None:
        self.craft = craft
        self.board = board
        self.saved = saved
        self.sent = self.failed = 0
        self.is_over = self.is_landed = False
        self.speed = 0.0
        self.least_type = 0
        self.only_app: str | None = None
        self._stop_on_failure = stop_on_failure
        self._factor = factor
        self._flows = craft.flows
        self._goal_ns: int | None = None
        self._stood = True
        self._entries: list[Entry] = []
        self._prints_event = False
        self._watch, self._watched_ns = Stopwatch(), 0
        self.words = {
            "run": ConsoleWord(self._run, "run [SECONDS]", "let time go on, for so long or until pause"),
            "until": ConsoleWord(self._until, "until CONDITION", "go on until it is met, as in until event CFE_ES 3"),
            "step": ConsoleWord(self._step, "step [N]", "go on to the next instant at which something happens"),
            "pause": ConsoleWord(self._pause, "pause", "stand still, and wait no more for what was expected"),
            "speed": ConsoleWord(self._speed, "speed FACTOR|max", "how many times as fast as the wall clock"),
            "page": ConsoleWord(self._page, "page hk|all|NAME ...", "the telemetry that is shown; NAME may have a *"),
            "raw": ConsoleWord(self._raw, "raw on|off", "show measurements as raw numbers"),
            "events": ConsoleWord(self._events, "events [APP] [TYPE]|all", "choose those that are shown"),
            "hk": ConsoleWord(self._ask_hk, "hk", "ask all applications for housekeeping"),
            "load": ConsoleWord(self._load, "load FILE", "do what a script says"),
            "save": ConsoleWord(self._save, "save FILE", "write what was sent as a script"),
            "help": ConsoleWord(self._help, "help [WORD|COMMAND]", "this list, or a command's fields"),
            "quit": ConsoleWord(self._quit, "quit", "end the session"),
        }

    # -- output --------------------------------------------------------------------------------------------------------

    def take_entries(self) -> list[Entry]:
        """Return the output since the last call."""
        entries, self._entries = self._entries, []
        return entries

    def say(self, kind: str, text: str) -> None:
        """Add an output entry."""
        self._entries.append(Entry(kind, visible(text)))

    @property
    def moves(self) -> bool:
        """True if time should advance."""
        if self.is_over or self.is_landed:
            return False
        return self._goal_ns is not None or self._flows or self.craft.script.is_waiting

    @property
    def is_busy(self) -> bool:
        """True if an action is in progress that a line of a script would wait for."""
        waits = self._goal_ns is not None or self.craft.script.is_waiting or (self._flows and not self.craft.flows)
        return waits and not self.is_over and not self.is_landed

    def is_shown(self, event: DecodedEvent) -> bool:
        """Return True if an event passes the filter."""
        return event.event_type >= self.least_type and self.only_app in (None, event.app)

    def status(self) -> str:
        """Return one line: the time, the speed, and the numbers of packets sent and accepted."""
        state = f"{self.speed:.1f} x real time" if self.moves else "over" if self.is_landed else "paused"
        accepted, refused = self.board.counters()
        time = f"{self.craft.script.scene.now_ns / NS_PER_S:.3f} s"
        name = visible_line(self.craft.name)
        return f"{name}  {time}  {state}  sent {self.sent}, accepted {accepted}, refused {refused}"

    # -- time --------------------------------------------------------------------------------------------------------

    def go_on(self) -> bool:
        """Advance time for a short while, if it should. Returns True if it advanced."""
        self.craft.script.advance()  # steps that are decided now are no longer waited for
        self._look_for_the_end()
        if not self.moves:
            self._stood = True
            self.craft.stand()
            self.gather()
            return False
        if self._stood:
            self.craft.pace(self._factor)
            self._stood, self._watch, self._watched_ns = False, Stopwatch(), self.craft.stands_ns
        moved = self.craft.step(ENDLESS if self._goal_ns is None else self._goal_ns)
        if self._goal_ns is not None and self.craft.stands_ns >= self._goal_ns:
            self._goal_ns = None
        self.gather()
        self._measure()
        return moved

    def _look_for_the_end(self) -> None:
        if self.craft.is_asked:
            self.is_over = True
        elif self.craft.is_over and not self.is_landed:
            self.is_landed = True
            self.say(REPLY, "the run is over; quit ends the session")

    def gather(self) -> None:
        """Take the news of the craft."""
        for each in self.craft.news():
            if isinstance(each, str):
                self._gather_line(each)
            elif each.msg_id in EVENT_IDS:
                event = DecodedEvent.of(each)
                text = f"{event.at_ns / NS_PER_S:.3f} {event.app} {event.event_id} {event.type_name}: {event.text}"
                self._entries.append(Entry(EVENT, visible_line(text), event))
                self._prints_event = False
            elif get_type(each.packet) == MsgType.TLM:
                self.board.note(each)

    def _gather_line(self, line: str) -> None:
        """Add a line of the craft's console. Skip output of its event port, because it arrives as an event next."""
        self._prints_event = self._prints_event or line.startswith(EVENT_PORT)
        if not self._prints_event:
            self.say(CONSOLE, line)

    def _measure(self) -> None:
        wall_ns = self._watch.elapsed_ns()
        if wall_ns > SPEED_NS:
            self.speed = (self.craft.stands_ns - self._watched_ns) / wall_ns
            self._watch, self._watched_ns = Stopwatch(), self.craft.stands_ns

    def end(self) -> None:
        """End the session, and decide all open expectations."""
        self.is_over = True
        self.craft.script.end()
        self.gather()

    # -- lines -------------------------------------------------------------------------------------------------------

    def take(self, line: str) -> None:
        """Carry out a line, and report an error in it."""
        line = line.strip()
        if not line or line.startswith("#") or self.is_over:
            return
        self.say(TYPED_LINE, line)
        name, *rest = line.split()
        try:
            if self.is_landed and name not in LOOKING:
                raise UsageError(f"the run is over; only {', '.join(LOOKING)} can be used now")
            if name in self.words:
                self.words[name].act(rest)
            else:
                self._add(line if name in VERBS or name in TIMES else f"send {line}")
        except UsageError as error:
            self._fail("; ".join(f"{each.field}: {each.text}" if each.field else each.text for each in error.each))
        self.gather()

    def _fail(self, text: str) -> None:
        self.say(BAD, text)
        self.failed += 1
        if self._stop_on_failure:
            self.is_over = True

    def _add(self, text: str, file: str = TYPED) -> None:
        """Add a line, or the file of a script."""
        script, began_ns = self.craft.script, self.craft.stands_ns

        def tell(step: Step, verdict: StepVerdict) -> None:
            nonlocal began_ns
            began_ns = when_of(step, began_ns)
            if step.condition is not None:
                self.saved.expected(step, verdict, began_ns, self.craft.stands_ns)
            began_ns = self.craft.stands_ns
            self._tell(step, verdict, file)

        script.add(text, file, tell, self._stop_on_failure)
        script.advance()

    def _tell(self, step: Step, verdict: StepVerdict, file: str) -> None:
        where = "" if file == TYPED else f"{file}:{step.line}: "
        detail = f": {verdict.detail}" if verdict.detail else ""
        if step.packet is not None:
            self.sent += 1
        text = f"{verdict.at_s:.3f} {where}{step.text}{detail}"
        if verdict.ok:
            self.say(GOOD, text)
        elif verdict.detail == OVER:
            self.say(REPLY, text)
        else:
            self._fail(text)

    # -- the console's words -----------------------------------------------------------------------------------------

    def _run(self, words: list[str]) -> None:
        if words:
            self._goal_ns = self.craft.stands_ns + round(_parsed(seconds_of, words) * NS_PER_S)
        else:
            self._flows = True

    def _until(self, words: list[str]) -> None:
        if not words:
            raise UsageError(
                "missing condition; write for instance: until event CFE_ES 3, until app HK RUNNING, "
                "until tlm NAME FIELD == 3"
            )
        limit = "" if {"within", "until"} & set(words) else f" within {LONGEST_S:.0f}"
        script, scene = self.craft.script, self.craft.script.scene
        mark = scene.mark_ns, scene.since

        def tell(step: Step, verdict: StepVerdict) -> None:
            if verdict.ok:
                self.say(GOOD, f"{verdict.at_s:.3f} until {' '.join(words)}")
            elif verdict.detail != OVER:
                self._fail(f"{verdict.at_s:.3f} until {' '.join(words)}: {verdict.detail}")

        script.add(f"after 0 expect {' '.join(words)}{limit}", TYPED, tell)
        script.advance()
        scene.mark_ns, scene.since = mark  # `until` looks from here on; it does not affect the expectations of a script

    def _step(self, words: list[str]) -> None:
        count = _parsed(count_of, words) if words else 1
        for _ in range(count):
            upcoming = self.craft.next_event()
            if upcoming is None:
                raise UsageError("cannot step: the mission has no further event")
            while self.craft.stands_ns < upcoming and self.craft.step(upcoming):
                pass
            while count > 1 and self.craft.next_event() == upcoming and self.craft.step(upcoming):
                pass
        self.say(REPLY, f"{self.craft.script.scene.now_ns / NS_PER_S:.9f} s")

    def _pause(self, words: list[str]) -> None:
        if self.craft.flows and not self.craft.script.scene.has_mission:
            raise UsageError("a remote target cannot be paused")
        self.pause()

    def pause(self) -> None:
        """Stand still, and give up all open expectations."""
        self._goal_ns, self._flows = None, self.craft.flows and not self.craft.script.scene.has_mission
        given_up = self.craft.script.give_up()
        if given_up:
            self.say(REPLY, f"no longer waited for: {given_up}")

    def _speed(self, words: list[str]) -> None:
        if not words:
            raise UsageError(f"missing factor; write for instance: speed 2, speed {MAXIMUM}")
        self._factor = None if words == [MAXIMUM] else _parsed(factor_of, words)
        self._stood = True

    def _page(self, words: list[str]) -> None:
        self.board.choose(words)

    def _raw(self, words: list[str]) -> None:
        if words not in (["on"], ["off"]):
            raise UsageError(f"invalid words {' '.join(words)!r}; write raw on, or raw off", field="raw")
        self.board.show_raw(words == ["on"])

    def _events(self, words: list[str]) -> None:
        least, app = 0, None
        for word in words:
            if word.upper() in EVENT_TYPES:
                least = EVENT_TYPES[word.upper()]
            elif word not in ("all", "*"):
                app = word
        self.least_type, self.only_app = least, app
        self.say(REPLY, f"events of {app or 'all applications'}{f', {words[-1].upper()} and above' if least else ''}")

    def _ask_hk(self, words: list[str]) -> None:
        scene = self.craft.script.scene
        for name, command in scene.dictionary.commands.items():
            if name.endswith(REQUEST) and (not scene.has_mission or receivers(scene.mission.cfe.sb, command.msg_id)):
                self._add(f"send {name}")

    def _load(self, words: list[str]) -> None:
        if len(words) != 1:
            raise UsageError("requires one file: load FILE")
        self.load(words[0])

    def load(self, file: str) -> None:
        """Carry out the file of a script.

        Raises:
            UsageError: it cannot be read, or has a mistake; then none of its steps is done.
        """
        try:
            text = text_limited(file, LINE_FILE_BYTES, handed=True)
        except OSError as error:
            raise UsageError(f"cannot be read: {error.strerror}", file=file) from None
        except UnicodeError:
            raise UsageError("is not UTF-8 text", file=file) from None
        self._add(text, file)

    def _save(self, words: list[str]) -> None:
        if len(words) != 1:
            raise UsageError("requires one file: save FILE")
        self.saved.write(words[0], self.craft.stands_ns)
        self.say(REPLY, f"{words[0]}: {self.saved.count} commands")

    def _help(self, words: list[str]) -> None:
        dictionary = self.craft.script.scene.dictionary
        if words and words[0] not in self.words:
            command = dictionary.command(words[0])
            fields = " ".join(f"{cell.path}:{cell.type}" for cell in command.payload.cells())
            self.say(REPLY, f"{command.name} {fields}".rstrip() + f"  {command.text}")
            return
        for name in words or self.words:
            self.say(REPLY, f"{self.words[name].usage:<24} {self.words[name].text}")
        if not words:
            self.say(REPLY, f"{'NAME FIELD=VALUE ...':<24} send a command by its name")
            self.say(REPLY, f"{'send, expect, reset, ...':<24} a step as in a mission script")

    def _quit(self, words: list[str]) -> None:
        self.is_over = True


def _parsed(parse: Callable[[str], T], words: list[str]) -> T:
    """Parse the argument of a console word in the same way as a command line option."""
    try:
        return parse(" ".join(words))
    except ArgumentTypeError as error:
        raise UsageError(str(error)) from None
