"""Journals: a run written down so that it can be done again, on this computer or another, and compared with others.

May import cfepy.mission and what is left of it.
"""

from __future__ import annotations

from cfepy.journal.journal import Journal, read_journal
from cfepy.journal.recorder import JournalRecorder, record
from cfepy.journal.replay import Replay, replay

__all__ = ["Journal", "JournalRecorder", "Replay", "read_journal", "record", "replay"]
