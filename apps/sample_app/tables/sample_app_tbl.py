"""SAMPLE_APP's default table.

After a change: `python -m apps.sample_app.tables.sample_app_tbl` writes sample_app_tbl.tbl anew.
"""

from __future__ import annotations

from cfepy.tbl import TableImage, write_beside

from ..messages import EXAMPLE_TABLE


def image() -> TableImage:
    """The table."""
    return TableImage("SAMPLE_APP.ExampleTable", EXAMPLE_TABLE.pack(Int1=1, Int2=2), "Table Utility Test Table")


if __name__ == "__main__":
    write_beside(__file__, image())
