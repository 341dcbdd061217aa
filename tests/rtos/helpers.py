"""What kernel tests share."""

from __future__ import annotations

from collections.abc import Callable


class Log(list[str]):
    """Lines in the order in which tasks wrote them."""

    def __call__(self, text: str) -> None:
        self.append(text)

    def writer(self, text: str) -> Callable[[], None]:
        """A task's entry point that writes one line."""
        return lambda: self.append(text)
