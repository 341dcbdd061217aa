"""The cipher of encrypted bags, which requires the real package."""

from __future__ import annotations

from typing import Any, NoReturn

MODE_CBC = 2
block_size = 16


def new(*args: Any, **options: Any) -> NoReturn:
    """Refuse.

    Raises:
        ImportError: always; it names the package to install.
    """
    raise ImportError("encrypted bags need PyCryptodomex: pip install pycryptodomex")
