"""SCH's clock: the tone, the slots between tones, and late, early or missing tones."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from apps.sch.frames import (
    LAST_SLOT,
    MAJOR_SYNCHRONIZED,
    MINOR_SYNCHRONIZED,
    NOT_SYNCHRONIZED,
    PENDING_MAJOR_SYNCH,
    SOURCE_CFE_TIME,
    SOURCE_MINOR_FRAME_TIMER,
    Frames,
)
from cfepy.time import micro2sub_secs, sub2micro_secs
from cfepy.time.telemetry import FLAG_FLYING

MS = 1000


class Board:
    """A timer and a clock that the test controls.

    Attributes:
        now_us: mission elapsed time.
        wakes: times at which SCH was woken.
        flying: the clock is in flywheel mode.
    """

    def __init__(self, accuracy_us: int = 1) -> None:
        self.now_us = 0
        self.wakes: list[int] = []
        self.flying = False
        self._due_us: int | None = None
        self._period_us = 0
        self._accuracy_us = accuracy_us
        os = SimpleNamespace(
            timer_create=self._create,
            timer_set=self._set,
            timer_get_info=lambda timer: SimpleNamespace(accuracy=accuracy_us),
            bin_sem_create=lambda name, value: 1,
            bin_sem_give=lambda semaphore: self.wakes.append(self.now_us),
        )
        time = SimpleNamespace(
            register_synch_callback=lambda callback: None,
            get_clock_info=lambda: FLAG_FLYING if self.flying else 0,
            get_met_subsecs=lambda: micro2sub_secs(self.now_us % 1_000_000),
            sub2micro_secs=sub2micro_secs,
        )
        cfe: Any = SimpleNamespace(os=os, time=time)
        self.frames = Frames(cfe)
        self.frames.create_timer()
        self.frames.create_semaphore()
        self.frames.start()

    def _create(self, name: str, callback: Any) -> int:
        self._callback = callback
        return 7

    def _set(self, timer: int, start_us: int, interval_us: int) -> None:
        assert timer == 7
        assert start_us % self._accuracy_us == interval_us % self._accuracy_us == 0
        self._due_us, self._period_us = self.now_us + start_us, interval_us

    def run_to(self, until_us: int) -> None:
        """Let the timer tick up to a time, this included."""
        while self._due_us is not None and self._due_us <= until_us:
            self.now_us = self._due_us
            self._due_us += self._period_us
            self._callback(7)
        self.now_us = until_us

    def tone(self, at_us: int) -> None:
        """Send the tone at a time. A tick due at the same time comes after it."""
        self.run_to(at_us - 1)
        self.now_us = at_us
        self.frames.on_major_frame()


def test_a_second_has_a_hundred_slots_and_the_next_tone_ends_the_last() -> None:
    board = Board()
    for second in (1, 2, 3):
        board.tone(second * 1_000_000)
    board.run_to(3_050_000)
    assert board.wakes[:200] == [1_000_000 + slot * 10 * MS for slot in range(200)]
    frames = board.frames
    assert (frames.since_tone, frames.valid_count, frames.missed_count, frames.unexpected_count) == (5, 3, 0, 0)
    assert (frames.source, frames.sync_to_met) == (SOURCE_CFE_TIME, NOT_SYNCHRONIZED)
    assert frames.current_slot() == 5


def test_late_tone_within_its_window_is_accepted() -> None:
    board = Board()
    board.tone(1_000_000)
    board.tone(2_004_000)
    assert board.wakes[-2:] == [1_990_000, 2_004_000]
    assert (board.frames.missed_count, board.frames.valid_count) == (0, 2)
    assert not board.frames.unexpected


def test_a_slot_after_a_missing_tone_is_short() -> None:
    board = Board()
    board.tone(1_000_000)
    board.run_to(2_021_000)
    assert board.wakes[-4:] == [1_990_000, 2_005_000, 2_010_000, 2_020_000]
    assert (board.frames.missed_count, board.frames.since_tone) == (1, 2)
    board.run_to(3_000_000)
    assert board.wakes[-1] == 2_990_000


def test_mission_elapsed_time_is_used_without_a_tone() -> None:
    board = Board()
    board.run_to(4_999_999)
    assert board.wakes == []
    board.run_to(5_000_000)
    assert board.wakes == [5_000_000]
    assert (board.frames.source, board.frames.sync_to_met) == (SOURCE_MINOR_FRAME_TIMER, MAJOR_SYNCHRONIZED)
    board.run_to(5_030_000)
    assert (board.frames.current_slot(), len(board.wakes)) == (3, 4)


def test_start_within_a_second_is_synchronized() -> None:
    board = Board()
    board._due_us = 5_740_000  # started in the middle of a second
    board.run_to(5_990_000)
    assert board.frames.sync_to_met == PENDING_MAJOR_SYNCH
    assert board.wakes == []
    board.run_to(6_000_000)
    assert (board.wakes, board.frames.sync_to_met) == ([6_000_000], MAJOR_SYNCHRONIZED)


def test_first_tone_synchronizes_again() -> None:
    board = Board()
    board.run_to(5_985_000)
    board.tone(6_000_000)
    assert (board.frames.source, board.frames.sync_to_met) == (SOURCE_CFE_TIME, NOT_SYNCHRONIZED)


def test_two_noisy_frames_in_a_row_make_the_source_ignored() -> None:
    board = Board()
    board.tone(1_000_000)
    board.tone(1_500_000)
    assert (board.frames.unexpected, board.frames.ignored, board.frames.valid_count) == (True, False, 2)
    board.tone(1_800_000)
    assert (board.frames.ignored, board.frames.valid_count, board.frames.unexpected_count) == (True, 2, 2)
    board.tone(1_900_000)
    assert (board.frames.valid_count, board.frames.unexpected_count) == (2, 3)
    board.frames.trust_again()
    assert not board.frames.ignored
    board.tone(2_500_000)
    assert board.frames.valid_count == 3


def test_valid_frame_cancels_a_noisy_one() -> None:
    board = Board()
    for at_us in (1_000_000, 1_500_000, 2_500_000, 2_700_000, 3_700_000):
        board.tone(at_us)
    assert not board.frames.ignored
    assert board.frames.unexpected_count == 2


def test_clock_in_flywheel_gives_no_frames() -> None:
    board = Board()
    board.flying = True
    board.tone(1_000_000)
    assert (board.frames.valid_count, board.wakes) == (0, [])


@pytest.mark.parametrize(("accuracy_us", "worst"), [(1000, 1), (5000, 2), (10_000, 3)])
def test_coarse_timer_follows_the_mission_elapsed_time(accuracy_us: int, worst: int) -> None:
    board = Board(accuracy_us)
    assert (board.frames.sync_to_met, board.frames.worst_slots) == (MINOR_SYNCHRONIZED, worst)
    board.tone(1_000_000)
    board.run_to(1_250_000)
    assert board.frames.current_slot() == 25
    assert board.wakes[-1] == 1_250_000


def test_slots_of_a_coarse_timer_count_from_the_last_tone() -> None:
    board = Board(10_000)
    board.tone(1_020_000)
    board.run_to(1_050_000)
    assert (board.frames.last_sync_met_slot, board.frames.current_slot()) == (2, 3)
    board.now_us = 2_010_000
    assert board.frames.current_slot() == LAST_SLOT


def test_a_coarse_timer_has_a_window_for_the_tone() -> None:
    board = Board(10_000)
    board.tone(1_000_000)
    for following, unexpected in ((0, False), (50, True), (96, False)):
        board.frames.following = following
        board.frames.trust_again()
        board.frames.on_major_frame()
        assert board.frames.unexpected == unexpected
