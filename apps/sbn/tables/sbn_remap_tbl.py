"""SBN's default remapping, NASA's: one MsgId changes at processor 3, all others stay the same.

After a change, `python -m apps.sbn.tables.sbn_remap_tbl` rewrites sbn_remap_tbl.tbl.
"""

from __future__ import annotations

from cfepy.tbl import TableImage, write_beside

from ..definition import remapping


def image() -> TableImage:
    """Return the table."""
    return remapping([(3, 0x0882, 0x0883)])


if __name__ == "__main__":
    write_beside(__file__, image())
