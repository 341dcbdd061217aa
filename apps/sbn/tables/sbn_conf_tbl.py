"""SBN's default configuration, NASA's: three processors of a spacecraft on one computer, by UDP.

After a change, `python -m apps.sbn.tables.sbn_conf_tbl` rewrites sbn_conf_tbl.tbl.
"""

from __future__ import annotations

from cfepy.tbl import TableImage, write_beside

from ..definition import configuration, peer

SPACECRAFT = 0x42


def image() -> TableImage:
    """Return the table."""
    return configuration([peer(number, f"127.0.0.1:{2233 + number}", SPACECRAFT) for number in (1, 2, 3)])


if __name__ == "__main__":
    write_beside(__file__, image())
