"""What may differ between a recorded packet of the real cFE and ours: the fields, and why. All else is equal, bit by bit.

Times (the header's, and these fields) come from a processor on which code takes time; addresses are those of a C
process; a build tells when and where it was made.
"""

from __future__ import annotations

TIMES = "a time, or a latch of one"
TIMING = "counts what happened until then: the phase of tasks that wake by themselves is not the recorded one"
ADDRESS = "an address of a C process"
BUILD = "made from the C build"

MASKED: dict[str, dict[str, str]] = {}
