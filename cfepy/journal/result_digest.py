"""The digest of a run's numbers: the same for runs that came to the same, on whatever they ran.

May import cfepy.mission.
"""

from __future__ import annotations

import json
from hashlib import blake2b

from cfepy.mission.results import Results

_NOT_OF_THE_RUN = ("wall_s", "speed", "tasks", "trace")


def digest_of(results: Results, root: str = "") -> str:
    """32 hexadecimal digits that stand for the numbers of a report, wall-clock time aside.

    Args:
        results: the numbers.
        root: folder that paths begin with, and that does not count.
    """
    plain = results.to_dict()
    for name in _NOT_OF_THE_RUN:
        del plain[name]
    text = json.dumps(plain, sort_keys=True)
    return blake2b((text.replace(root, "") if root else text).encode(), digest_size=16).hexdigest()
