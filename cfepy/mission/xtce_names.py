"""Names as XTCE allows them, and payloads laid flat with their padding."""

from __future__ import annotations

import re
from collections.abc import Iterator

from cfepy.msg import Layout
from cfepy.msg.layout import Cell


def xtce_name(path: str) -> str:
    """A name without what XTCE forbids: "/arm_health/samples" becomes arm_health_samples, "Counts[3]" Counts_3."""
    return re.sub(r"[./:\[\]\s]+", "_", path).strip("_")


def cells_with_padding(layout: Layout) -> Iterator[Cell]:
    """The cells of a layout, and one of type "padding" for every gap."""
    at = 0
    for cell in layout.cells():
        if cell.offset > at:
            yield Cell("", "padding", at, cell.offset - at)
        yield cell
        at = cell.offset + cell.size
    if layout.size > at:
        yield Cell("", "padding", at, layout.size - at)
