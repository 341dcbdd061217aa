"""Journals: recorded runs that can be repeated, on this computer or another, and compared with others.

Code that defines the contents and file of a journal (`journal`), writes it during a run (`recorder`), or repeats the
run and compares it (`replay_files`, `replay`, `header_diff`) belongs here. Flying a run belongs to `cfepy.pilot`; input
from outside belongs to `cfepy.mission`. Commands that show journals are in `cfepy.cli`. The central file is
`cfepy/journal/journal.py`.
"""

from __future__ import annotations

from cfepy.journal.computer_facts import environ_of, versions
from cfepy.journal.header_diff import differences
from cfepy.journal.journal import Journal, is_journal, read_journal
from cfepy.journal.mission_files import CARRIED, Carrier, MissionFile, ReadFiles, files_of
from cfepy.journal.recorder import JournalRecorder, record
from cfepy.journal.replay import Replay, ReplayVerdict, replay
from cfepy.journal.replay_files import HiddenRoot, Stage, moved_environ, settled, staged

__all__ = [
    "CARRIED",
    "Carrier",
    "HiddenRoot",
    "Journal",
    "JournalRecorder",
    "MissionFile",
    "ReadFiles",
    "Replay",
    "ReplayVerdict",
    "Stage",
    "differences",
    "environ_of",
    "files_of",
    "is_journal",
    "moved_environ",
    "read_journal",
    "record",
    "replay",
    "settled",
    "staged",
    "versions",
]
