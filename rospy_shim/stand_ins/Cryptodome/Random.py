"""Random bytes, from the node's own source of them."""

from __future__ import annotations

import os


def get_random_bytes(n: int) -> bytes:
    """So many bytes."""
    return os.urandom(n)
