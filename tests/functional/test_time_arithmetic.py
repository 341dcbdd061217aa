"""Adding, subtracting and comparing times, over the end of 32 bits too (time_arithmetic_test.c)."""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.time import A_GT_B, A_LT_B, EQUAL

MAX = 0xFFFFFFFF


def test_time_addition(cfe: Cfe) -> None:
    assert cfe.time.add((1000, 0), (0, 1000)) == (1000, 1000)
    assert cfe.time.add((MAX, MAX), (0, 1)) == (0, 0)
    assert cfe.time.add((MAX, MAX), (MAX, MAX)) == (MAX, MAX - 1)


def test_time_subtraction(cfe: Cfe) -> None:
    assert cfe.time.subtract((1000, 1000), (999, 999)) == (1, 1)
    assert cfe.time.subtract((0, 0), (MAX, MAX)) == (0, 1)
    assert cfe.time.subtract((0, 0), (0, 1)) == (MAX, MAX)


def test_time_comparison(cfe: Cfe) -> None:
    later_and_earlier = [((1000, 1000), (999, 999)), ((1, 1), (MAX, MAX))]
    for later, earlier in later_and_earlier:
        assert cfe.time.compare(later, earlier) == A_GT_B
        assert cfe.time.compare(earlier, later) == A_LT_B
    assert cfe.time.compare((500, 1), (500, 1)) == EQUAL
