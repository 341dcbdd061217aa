"""The code blocks of docs/how_to/ground_tools.md by section."""

from __future__ import annotations

from tests.docs import pages

PAGE = pages.ROOT / "docs/how_to/ground_tools.md"


def blocks(section: str) -> list[pages.Block]:
    """Return the code blocks of a section of the page, in their order."""
    return pages.blocks(PAGE, section)
