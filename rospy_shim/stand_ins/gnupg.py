"""A stand-in for python-gnupg, which rosbag's original source imports for encrypted bags."""

from __future__ import annotations

from typing import Any


class GPG:
    """Refuses to be made.

    Raises:
        ImportError: always; it names the package to install.
    """

    def __init__(self, *args: Any, **options: Any) -> None:
        raise ImportError("encrypted bags need python-gnupg: pip install python-gnupg")
