"""HK's default copy table: the first four bytes of every core service's housekeeping, side by side in packet 0x089C.

NASA's own default copies from offset 12, four spare bytes before the payload. Here the data starts at 16, where
telemetry payloads start. After a change, `python -m apps.hk.tables.hk_cpy_tbl` rewrites hk_cpy_tbl.tbl.
"""

from __future__ import annotations

from cfepy.msg import TLM_HEADER_SIZE
from cfepy.tbl import TableImage, write_beside

from ..packets import COMBINED_PKT1_MID, COPY_TABLE

CORE_HK_MIDS = (0x0801, 0x0805, 0x0803, 0x0800, 0x0804)
"""Housekeeping of EVS, TIME, SB, ES and TBL."""

PART = 4
ROWS = [
    {
        "InputMid": msg_id,
        "InputOffset": TLM_HEADER_SIZE,
        "OutputMid": COMBINED_PKT1_MID,
        "OutputOffset": TLM_HEADER_SIZE + PART * place,
        "NumBytes": PART,
    }
    for place, msg_id in enumerate(CORE_HK_MIDS)
]


def image() -> TableImage:
    """Return the table."""
    return COPY_TABLE.image(ROWS)


if __name__ == "__main__":
    write_beside(__file__, image())
