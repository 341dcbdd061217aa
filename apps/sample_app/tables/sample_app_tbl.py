"""SAMPLE_APP's default table.

After a change, `python -m apps.sample_app.tables.sample_app_tbl` rewrites sample_app_tbl.tbl.
"""

from __future__ import annotations

from cfepy.tbl import TableImage, write_beside

from ..packets import TABLE


def image() -> TableImage:
    """Return the table."""
    return TABLE.image({"Int1": 1, "Int2": 2})


if __name__ == "__main__":
    write_beside(__file__, image())
