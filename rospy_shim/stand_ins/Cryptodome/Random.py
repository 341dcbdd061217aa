"""Random bytes, from the node's own source of random numbers."""

from __future__ import annotations

import os


def get_random_bytes(n: int) -> bytes:
    """Return `n` random bytes."""
    return os.urandom(n)
