"""SCH_LAB's default schedule, NASA's: a housekeeping request to every core service and lab app about once a second.

After a change, `python -m apps.sch_lab.tables.sch_lab_table` rewrites sch_lab_table.tbl.
"""

from __future__ import annotations

from cfepy.tbl import TableImage, write_beside

from .. import schedule

TICKS_PER_SECOND = 100
ROWS: list[tuple[int, int, int, bytes]] = [
    (0x1808, 100, 0, b""),  # ES
    (0x180C, 50, 0, b""),  # TBL, which also writes the files of table dumps then
    (0x180D, 98, 0, b""),  # TIME
    (0x180B, 97, 0, b""),  # SB
    (0x1809, 96, 0, b""),  # EVS
    (0x1885, 95, 0, b""),  # CI_LAB
    (0x1881, 94, 0, b""),  # TO_LAB
    (0x1883, 93, 0, b""),  # SAMPLE_APP
]


def image() -> TableImage:
    """Return the table."""
    return schedule.image(TICKS_PER_SECOND, ROWS)


if __name__ == "__main__":
    write_beside(__file__, image())
