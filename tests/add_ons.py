"""Which tests need which add-ons: those of an add-on that was taken out of a copy of the checkout are not collected.

`tests/extra/NAME` needs the add-on NAME; the table has every other file and folder that needs one. The program
`python -m dev.take_out --tests` takes add-ons out and runs the rest, so a file that the table lacks fails there.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
SHELF = "ros_libraries"

NEEDS: dict[str, str] = {}
"""By file or folder below `tests`: the add-ons that it needs, separated by blanks."""


def needed(path: Path) -> Iterator[str]:
    """Yield the add-ons that a file or folder of tests needs.

    Args:
        path: of the file or folder, absolute.
    """
    inside = path.relative_to(ROOT / "tests")
    for each in (inside, *inside.parents):
        yield from NEEDS.get(each.as_posix(), "").split()
    if inside.parts[:1] == ("extra",) and len(inside.parts) > 1:
        yield inside.parts[1]


def is_there(name: str) -> bool:
    """Return whether this checkout has an add-on."""
    return (ROOT / name if name == SHELF else ROOT / "cfepy" / "extra" / name).is_dir()


def lacks_add_on(path: Path) -> bool:
    """Return whether a file or folder of tests needs an add-on that was taken out of this checkout."""
    return not all(map(is_there, needed(path)))
