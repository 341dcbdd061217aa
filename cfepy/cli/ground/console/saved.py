"""The packets of a session as a mission script: `cfepy run MISSION --script FILE` repeats the same run.

Each packet is written with the virtual time at which the run stood when it was sent. An expectation in a file waits,
while a typed one let other lines pass. So an expectation is written as a step only where it cannot delay the following
steps; elsewhere it is a comment.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from cfepy.ground import Dictionary, line_of, packet_of
from cfepy.msg import CMD_HEADER_SIZE, get_header_size
from cfepy.reading.input_files import unwritable
from cfepy.script import LOOK_NS, OVER, RosAction, Step, StepVerdict, without_when
from cfepy.status import UsageError
from cfepy.units import NS_PER_S


@dataclass(frozen=True, slots=True)
class Noted:
    """A line of the script: when it began and ended, in virtual ns, and the step if it expects something."""

    began_ns: int
    done_ns: int
    text: str
    step: Step | None = None
    was_over: bool = False

    @property
    def is_quick(self) -> bool:
        """True if the step is done at once: a packet, a state that is judged, or a condition that is watched in the
        background.
        """
        step = self.step
        if step is None or step.must_not:
            return True
        return step.condition is not None and step.condition.lasts and step.within_ns is step.until_ns is None


class SavedScript:
    """Keeps the packets that were sent.

    Args:
        dictionary: names the commands.
        heading: lines for the head of the file.
    """

    def __init__(self, dictionary: Dictionary, heading: Sequence[str] = ()) -> None:
        self.heading = tuple(heading)
        self._dictionary = dictionary
        self._noted: list[Noted] = []

    @property
    def count(self) -> int:
        """The number of packets that were sent."""
        return sum(each.step is None for each in self._noted)

    def sent(self, packet: bytes, at_ns: int) -> None:
        """Note a packet that was sent at a virtual time in ns."""
        self._noted.append(Noted(at_ns, at_ns, f"send {self._words(packet)}"))

    def acted(self, action: RosAction, at_ns: int) -> None:
        """Note an action on the ROS side at a virtual time in ns."""
        self._noted.append(Noted(at_ns, at_ns, action.text))

    def expected(self, step: Step, verdict: StepVerdict, began_ns: int, done_ns: int) -> None:
        """Note an expectation and its verdict, with the virtual times in ns at which it began and was decided."""
        self._noted.append(Noted(began_ns, done_ns, without_when(step.text), step, verdict.detail == OVER))

    def write(self, file: str | Path, end_ns: int) -> None:
        """Write the script.

        Args:
            file: its path.
            end_ns: virtual time at which the run ends.

        Raises:
            UsageError: it cannot be written.
        """
        try:
            Path(file).write_text(self.text(end_ns), encoding="utf-8")
        except OSError as error:
            raise unwritable(file, error) from None

    def text(self, end_ns: int) -> str:
        """Return the whole script, for a run that ends at a virtual time in ns."""
        lines = [*(f"# {line}" for line in self.heading), *self._lines(end_ns), f"at {time_text(end_ns)} end"]
        return "\n".join(lines) + "\n"

    def _lines(self, end_ns: int) -> Iterator[str]:
        noted = sorted((each for each in self._noted if each.began_ns <= end_ns), key=lambda each: each.began_ns)
        done_ns = 0
        for number, each in enumerate(noted):
            rest = noted[number + 1 :]
            next_ns = next((later.began_ns for later in rest if later.step is None), end_ns)
            follows_at_once = each.began_ns == done_ns
            is_last = not rest or rest[0].step is None
            if each.step is None or (each.is_quick and is_last and not follows_at_once and _ends(each, end_ns)):
                yield f"at {time_text(each.began_ns)} {each.text}"
            elif follows_at_once if each.is_quick else _is_done(each, next_ns, follows_at_once):
                yield f"        {each.text}"
            else:
                yield f"# {time_text(each.began_ns)}: {each.text}"
                continue
            done_ns = each.done_ns if each.step is None or not each.step.must_not else each.began_ns

    def _words(self, packet: bytes) -> str:
        """Return a packet as a script writes it: by its name if that yields exactly the same bytes."""
        if get_header_size(packet) == CMD_HEADER_SIZE:
            decoded = self._dictionary.decode(packet)
            command = self._dictionary.commands.get(decoded.name)
            words = f"{decoded.name} {line_of(_given(decoded.values))}".rstrip()
            try:
                if command is not None and not decoded.problem and packet_of(command, _split(words)) == packet:
                    return words
            except UsageError:
                pass  # a text that cannot be written
        return f"raw {packet.hex()}"


def _is_done(each: Noted, next_ns: int, follows_at_once: bool) -> bool:
    """Return True if an expectation is decided before the next packet, also when a file expects it."""
    return not each.was_over and each.done_ns + (0 if follows_at_once else LOOK_NS) <= next_ns


def _ends(each: Noted, end_ns: int) -> bool:
    """Return True if the watch for an unwanted condition does not outlast the run."""
    assert each.step is not None
    has_limit = each.step.within_ns is not None or each.step.until_ns is not None
    return not has_limit or not each.was_over


def _given(values: dict[str, object]) -> dict[str, object]:
    """Return the values that are not zero."""
    return {name: value for name, value in values.items() if value not in (0, "", b"")}


def _split(words: str) -> list[str]:
    from shlex import split

    return split(words)[1:]


def time_text(ns: int) -> str:
    """Format a virtual time in seconds, exact to the ns."""
    whole, rest = divmod(max(0, ns), NS_PER_S)
    return f"{whole}.{rest:09d}".rstrip("0").rstrip(".")


def when_of(step: Step, before_ns: int) -> int:
    """Return when a step began, if it could have begun at `before_ns`, a virtual time in ns."""
    if step.at_ns is not None:
        return max(step.at_ns, before_ns)
    return before_ns + (step.after_ns or 0)
