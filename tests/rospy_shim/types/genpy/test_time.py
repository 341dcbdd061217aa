"""genpy.Time and genpy.Duration against recorded behaviour of real ROS."""

from __future__ import annotations

import copy
import json
import pickle
from pathlib import Path
from typing import Any

import pytest

from rospy_shim.types import genpy

RECORDED = json.loads((Path(__file__).parents[3] / "data" / "golden_time.json").read_text(encoding="utf-8"))


class T(genpy.Time):
    """Stands for rospy.Time, a subclass with a repr of its own."""

    __slots__ = ["secs", "nsecs"]  # noqa: RUF023

    def __repr__(self) -> str:
        return f"rospy.Time[{self.to_nsec()}]"

    @classmethod
    def from_seconds(cls, float_secs: float) -> T:
        return cls.from_sec(float_secs)


class D(genpy.Duration):
    """Stands for rospy.Duration."""

    __slots__ = ["secs", "nsecs"]  # noqa: RUF023

    def __repr__(self) -> str:
        return f"rospy.Duration[{self.to_nsec()}]"


T.__module__ = D.__module__ = "rospy.rostime"
T.__name__, D.__name__ = "Time", "Duration"


@pytest.mark.parametrize(("expression", "outcome"), RECORDED, ids=[each[0] for each in RECORDED])
def test_recorded(expression: str, outcome: dict[str, Any]) -> None:
    assert _outcome(expression) == outcome


def _outcome(expression: str) -> dict[str, Any]:
    try:
        value = eval(expression, {"T": T, "D": D, "genpy": genpy})
    except Exception as error:
        return {"raises": type(error).__name__, "text": str(error)}
    if isinstance(value, list):
        return {"is": [repr(each) for each in value]}
    return {"is": value if isinstance(value, (bool, int, float, str)) else repr(value)}


def test_truncation_and_float_remainders() -> None:
    assert genpy.Time(2.9999999999).nsecs == 999999999
    assert genpy.Duration(-1, 5) % genpy.Duration(1) == genpy.Duration(0, 4)
    assert repr(genpy.Duration(-1) - genpy.Duration(0, 1)) == "genpy.Duration[-1000000001]"


@pytest.mark.parametrize("value", [genpy.Time(1, 2), genpy.Duration(-1, 5), genpy.TVal(3, 4)])
def test_copies(value: genpy.TVal) -> None:
    assert copy.deepcopy(value) == value
    assert copy.copy(value) is not value
    assert pickle.loads(pickle.dumps(value)) == value
    assert type(copy.copy(value)) is type(value)


def test_canon() -> None:
    value = genpy.Duration()
    value.set(-5, 2_000_000_000)
    assert (value.secs, value.nsecs) == (-5, 2_000_000_000)
    value.canon()
    assert (value.secs, value.nsecs) == (-3, 0)
