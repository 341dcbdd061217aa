"""TO_LAB's default table, NASA's: the packets that go to the ground, and how many of each may wait for it.

After a change, `python -m apps.to_lab.tables.to_lab_sub` rewrites to_lab_sub.tbl.
"""

from __future__ import annotations

from cfepy.tbl import TableImage, write_beside

from ..packets import SUBSCRIPTIONS

ROWS = [
    (0x0880, 4),  # TO_LAB
    (0x0881, 4),  # TO_LAB, all data types
    (0x0800, 4),  # ES
    (0x0801, 4),  # EVS
    (0x0803, 4),  # SB
    (0x0804, 4),  # TBL
    (0x0805, 4),  # TIME
    (0x0806, 4),  # TIME diagnostics
    (0x080A, 4),  # SB statistics
    (0x080C, 4),  # TBL registry
    (0x0808, 32),  # long events
    (0x0809, 32),  # short events
    (0x080B, 4),  # ES, one application
    (0x0810, 4),  # ES, a memory pool
    (0x0884, 4),  # CI_LAB
    (0x0883, 4),  # SAMPLE_APP
]


def image() -> TableImage:
    """Return the table."""
    return SUBSCRIPTIONS.image([{"Stream": msg_id, "BufLimit": limit} for msg_id, limit in ROWS])


if __name__ == "__main__":
    write_beside(__file__, image())
