"""HK's copy table of this mission: what combined packet 1 (0x089C) is put together from; README.md has it as a table.

After a change, `python hk_cpy_tbl.py` writes hk_cpy_tbl.tbl anew.
"""

from __future__ import annotations

from cfepy.apps.hk.packets import COMBINED_PKT1_MID, COPY_TABLE
from cfepy.tbl import TableImage, write_beside

ES_HK, EVS_HK, SB_HK, TIME_HK = 0x0800, 0x0801, 0x0803, 0x0805
SAMPLES, PEAK_CURRENT, PEAK_SPEED, HOTTEST_MOTOR = 0x0901, 0x0902, 0x0903, 0x0904  # topics, see mission.yaml

COPIES = [  # MsgId, from byte, bytes, to byte
    (ES_HK, 16, 2, 16),
    (EVS_HK, 16, 2, 18),
    (SB_HK, 16, 4, 20),
    (EVS_HK, 24, 2, 24),
    (SB_HK, 28, 4, 26),
    (TIME_HK, 16, 2, 30),
    (SAMPLES, 16, 4, 32),
    (PEAK_CURRENT, 16, 4, 36),
    (PEAK_SPEED, 16, 4, 40),
    (HOTTEST_MOTOR, 16, 4, 44),
]


def image() -> TableImage:
    """The table."""
    rows = [
        {
            "InputMid": msg_id,
            "InputOffset": source,
            "OutputMid": COMBINED_PKT1_MID,
            "OutputOffset": target,
            "NumBytes": size,
        }
        for msg_id, source, size, target in COPIES
    ]
    return COPY_TABLE.image(rows)


if __name__ == "__main__":
    write_beside(__file__, image())
