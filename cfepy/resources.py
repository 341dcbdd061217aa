"""Where the files are that cfepy brings along: boards, ready missions, apps.

In a source checkout they lie beside the package, in an installed wheel under cfepy/share. Imports only cfepy.status.
"""

from __future__ import annotations

from pathlib import Path

from cfepy.status import UsageError


def shipped(kind: str) -> Path:
    """The directory of one kind of shipped files.

    Args:
        kind: "boards", "apps" or "missions".

    Raises:
        UsageError: this installation has no such directory.
    """
    package = Path(__file__).resolve().parent
    places = [package / "share" / kind, package.parent / kind]
    for place in places:
        if place.is_dir():
            return place
    looked = " nor ".join(str(place) for place in places)
    raise UsageError(f"this installation of cfepy has no {kind}: neither {looked} exists; install cfepy again")
