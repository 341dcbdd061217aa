"""SCH's clock: the major frame, which is TIME's tone, and the minor frames between two of them (sch_custom.c).

cFE 7 refuses OS_TimerSet in the callback of a timer, where SCH 2.2.2 uses it to make the last slot of a second longer.
So the timer ticks evenly here, every half slot, and the callback counts: two ticks make a slot, three the last slot,
one the slot after a missing tone. Only the major frame, in TIME's task, sets the timer.
"""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.time.telemetry import FLAG_FLYING

from .packets import SLOTS
from .slots import slot_of_us

SECOND_US = 1_000_000
SLOT_US = SECOND_US // SLOTS
DRIFT_WINDOW_US = 5000
"""How much longer the last slot waits for the tone (SCH_SYNC_SLOT_DRIFT_WINDOW)."""

WORST_ACCURACY_US = SLOT_US // (SLOTS - 1)
STARTUP_US = 5 * SECOND_US
LAST_SLOT = SLOTS - 1
MAX_SYNC_ATTEMPTS = 3 * SLOTS
MAX_NOISY_FRAMES = 2
TIMER_NAME = "SCH_MINOR_TIMER"
SEMAPHORE_NAME = "SCH_TIME_SEM"

NOT_SYNCHRONIZED, MINOR_SYNCHRONIZED, PENDING_MAJOR_SYNCH, MAJOR_SYNCHRONIZED = 0, 1, 2, 4
"""Bits of SyncToMET."""

SOURCE_NONE, SOURCE_CFE_TIME, SOURCE_MINOR_FRAME_TIMER = 0, 1, 2
"""What makes the major frame."""


class Frames:
    """Counts minor frames and wakes SCH at each. Names of attributes are those of the housekeeping packet.

    Attributes:
        semaphore: given at every frame.
        worst_slots: how many slots a wake-up may have to do if the timer is coarse.
    """

    def __init__(self, cfe: Cfe) -> None:
        self._cfe = cfe
        self.sync_to_met = NOT_SYNCHRONIZED
        self.source = SOURCE_NONE
        self.since_tone = LAST_SLOT
        self.last_sync_met_slot = 0
        self.ignored = self.unexpected = False
        self.valid_count = self.missed_count = self.unexpected_count = 0
        self.worst_slots = 1
        self.following = 0  # the slot that SCH does next; kept by SCH
        self.semaphore = 0
        self._noisy_in_a_row = 0
        self._attempts_left = 0
        self._ticks_left = 1

    # -- start -----------------------------------------------------------------------------------------------------

    def create_timer(self) -> int:
        """Create the timer of minor frames.

        Returns:
            Its accuracy in us.

        Raises:
            OsalError: no timer is available.
        """
        os = self._cfe.os
        self._timer = os.timer_create(TIMER_NAME, self._on_tick)
        accuracy_us = os.timer_get_info(self._timer).accuracy
        self._tick_us = SLOT_US if DRIFT_WINDOW_US % accuracy_us else DRIFT_WINDOW_US
        if accuracy_us > WORST_ACCURACY_US:
            self.sync_to_met = MINOR_SYNCHRONIZED
            self.worst_slots = accuracy_us * 2 // SLOT_US + 1
        return accuracy_us

    def create_semaphore(self) -> None:
        """Create the semaphore that wakes SCH.

        Raises:
            OsalError: no semaphore is available.
        """
        self.semaphore = self._cfe.os.bin_sem_create(SEMAPHORE_NAME, 0)

    def start(self) -> None:
        """Wait for tones from now on. If there is none in 5 s, SCH uses the mission elapsed time.

        Raises:
            CfeError: TIME refused the callback.
            OsalError: the timer cannot be set.
        """
        self._cfe.time.register_synch_callback(self.on_major_frame)
        self._cfe.os.timer_set(self._timer, STARTUP_US, self._tick_us)

    # -- frames ----------------------------------------------------------------------------------------------------

    def current_slot(self) -> int:
        """Return the current slot."""
        if self.sync_to_met == NOT_SYNCHRONIZED:
            return self.since_tone
        return (self.met_slot() - self.last_sync_met_slot) % SLOTS

    def met_slot(self) -> int:
        """Return the slot of the mission elapsed time."""
        time = self._cfe.time
        return slot_of_us(time.sub2micro_secs(time.get_met_subsecs()), SLOT_US)

    def trust_again(self) -> None:
        """Forget that the major frame was noisy."""
        self.ignored = self.unexpected = False
        self._noisy_in_a_row = 0

    def on_major_frame(self) -> None:
        """Handle the tone (SCH_MajorFrameCallback), in TIME's task."""
        if not self._cfe.time.get_clock_info() & FLAG_FLYING:
            self._judge_noise()
            if not self.ignored:
                self._cfe.os.timer_set(self._timer, self._tick_us, self._tick_us)
                self._ticks_left = self._ticks(SLOT_US)
                self.valid_count += 1
                self.since_tone = 0
                self.source = SOURCE_CFE_TIME
                self.sync_to_met &= MINOR_SYNCHRONIZED
                self._cfe.os.bin_sem_give(self.semaphore)
        self.last_sync_met_slot = self.met_slot()

    def _judge_noise(self) -> None:
        """A tone belongs into the last slot, or near the end of the table when the timer is coarse."""
        early = self.sync_to_met == NOT_SYNCHRONIZED and self.since_tone != LAST_SLOT
        window = SLOTS - self.worst_slots - 1
        far = self.sync_to_met == MINOR_SYNCHRONIZED and 0 < self.following < window
        self.unexpected = early or far
        if not self.unexpected:
            self._noisy_in_a_row = 0
            return
        self.unexpected_count += 1
        if not self.ignored:
            self._noisy_in_a_row += 1
            self.ignored = self._noisy_in_a_row >= MAX_NOISY_FRAMES

    def _on_tick(self, timer_id: int) -> None:
        self._ticks_left -= 1
        if self._ticks_left <= 0:
            self._on_minor_frame()

    def _on_minor_frame(self) -> None:
        """Handle the end of a slot (SCH_MinorFrameCallback)."""
        self._ticks_left = self._ticks(SLOT_US)
        if self.source == SOURCE_NONE:  # no tone in the time for it
            self.source = SOURCE_MINOR_FRAME_TIMER
            self.sync_to_met |= PENDING_MAJOR_SYNCH
            self._attempts_left = MAX_SYNC_ATTEMPTS
        if self.sync_to_met & PENDING_MAJOR_SYNCH and self.source == SOURCE_MINOR_FRAME_TIMER:
            if not self._found_begin_of_second():
                return
        else:
            self.since_tone += 1
        if self.since_tone >= SLOTS:  # the tone that should have ended the long slot did not come
            self._ticks_left = self._ticks(SLOT_US - DRIFT_WINDOW_US)
            self.since_tone = 0
            self.missed_count += 1
        if self.since_tone == LAST_SLOT:
            self._ticks_left = self._ticks(SLOT_US + DRIFT_WINDOW_US)
        self._cfe.os.bin_sem_give(self.semaphore)

    def _found_begin_of_second(self) -> bool:
        self._attempts_left -= 1
        slot = self.met_slot()
        if slot and self._attempts_left > 0:
            return False
        self.sync_to_met = self.sync_to_met & ~PENDING_MAJOR_SYNCH | MAJOR_SYNCHRONIZED
        self.since_tone = slot
        self.last_sync_met_slot = 0
        return True

    def _ticks(self, period_us: int) -> int:
        """Return ticks of the timer in a time, rounded up."""
        return -(-period_us // self._tick_us)
