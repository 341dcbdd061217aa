"""The measured fields of a sweep: one number for each run, from the values of a field of a topic or packet over time.

last:/odom.pose.pose.position.x     the last value
max:CFE_ES_HK_TLM.HeapBytesFree     the largest one; also min: and mean:
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from cfepy.ground import SeriesRecorder, SeriesSet
from cfepy.reading.suggestions import expected
from cfepy.status import UsageError

LAST, LARGEST, SMALLEST, MEAN = "last", "max", "min", "mean"
KINDS = (LAST, LARGEST, SMALLEST, MEAN)
_DIGITS = 12  # of a measured value, so that a sum in another order of numpy's is not seen


class FieldValue(NamedTuple):
    """The result of a measured field.

    Attributes:
        name: the measure.
        value: its value in a run; None if there is none.
        unit: unit of the value; empty if it is not known.
        why: why there is no value.
    """

    name: str
    value: float | None
    unit: str = ""
    why: str = ""


@dataclass(frozen=True, slots=True)
class FieldMeasure:
    """A measured field.

    Attributes:
        kind: one of `KINDS`.
        word: the topic or packet with its field.
    """

    kind: str
    word: str

    @classmethod
    def parse(cls, text: str, option: str) -> FieldMeasure:
        """Return the measure of a text.

        Args:
            text: such as "max:/odom.pose.pose.position.x".
            option: the option with the text, for errors.

        Raises:
            UsageError: the text is not a measure.
        """
        kind, _, word = text.partition(":")
        if kind not in KINDS:
            raise UsageError(f"unknown measure {kind!r}; {expected(kind, KINDS)}", field=option)
        if not word:
            raise UsageError(f"missing field of {kind}; write {kind}:/TOPIC.FIELD", field=option)
        return cls(kind, word)

    @property
    def text(self) -> str:
        """The measure as on the command line."""
        return f"{self.kind}:{self.word}"

    def value_in(self, recorded: SeriesSet) -> FieldValue:
        """Return the value of the measure in a recorded run."""
        try:
            series, field = recorded.found(self.word)
            values = series.to_numpy(field).values
        except UsageError as error:
            return FieldValue(self.text, None, why=error.text)
        if values.ndim != 1 or values.dtype.kind not in "iufb":
            return FieldValue(self.text, None, why="the field is not a single number")
        value = float(_reduced(self.kind, series.engineering(field, values)))
        if value != value or value in (float("inf"), float("-inf")):
            return FieldValue(self.text, None, why=f"the value is {value}")
        return FieldValue(self.text, float(f"{value:.{_DIGITS}g}"), series.unit(field))


def _reduced(kind: str, values: Any) -> Any:
    return values[-1] if kind == LAST else getattr(values, kind)()


def recorder_of(measures: Sequence[FieldMeasure]) -> list[SeriesRecorder]:
    """Return the recorder for a run, in a list that is empty if nothing is to be recorded."""
    return [SeriesRecorder([each.word for each in measures])] if measures else []
