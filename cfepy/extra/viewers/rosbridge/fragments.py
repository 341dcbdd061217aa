"""Fragments of rosbridge messages, the op `fragment` (ROSBRIDGE_PROTOCOL.md 3.1): splitting and reassembly."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from cfepy.status import UsageError

PATIENCE_S = 600.0  # wall time for the next fragment of a message, as in rosbridge
MOST_BEGUN = 16  # incomplete messages of a client
MOST_PIECES = 100_000
PIECE_BYTES = 150  # memory of a fragment besides its characters


def fragments(text: str, size: int, name: object) -> Iterator[dict[str, Any]]:
    """Yield the fragments of a text.

    Args:
        text: a message.
        size: characters of a fragment.
        name: the message's id.
    """
    total = -(-len(text) // size)
    for number in range(total):
        piece = text[number * size : (number + 1) * size]
        yield {"op": "fragment", "id": name, "data": piece, "num": number, "total": total}


class _Begun:
    """An incomplete message, with the wall time of its last fragment."""

    def __init__(self, total: int, at_s: float) -> None:
        self.total = total
        self.pieces: dict[int, str] = {}
        self.size = self.held = 0  # characters; estimated bytes of memory
        self.at_s = at_s


class Assembly:
    """Reassembles the fragments of one client.

    Args:
        longest: maximum characters of a message, and of all incomplete messages together; longer ones are refused.
    """

    def __init__(self, longest: int) -> None:
        self._longest = longest
        self._begun: dict[str, _Begun] = {}

    @property
    def size(self) -> int:
        """Estimated bytes of the fragments of incomplete messages."""
        return sum(each.held for each in self._begun.values())

    def add(self, message: dict[str, Any], now_s: float) -> str | None:
        """Add a fragment.

        Args:
            message: the op.
            now_s: wall time in s since an arbitrary instant.

        Returns:
            The whole message if this was the last missing fragment, otherwise None.

        Raises:
            UsageError: it is not a fragment, does not fit its message, or there are too many.
        """
        name, number, total, data = (message.get(key) for key in ("id", "num", "total", "data"))
        if name is None or type(number) is not int or type(total) is not int or not isinstance(data, str):
            raise UsageError("received invalid fragment!")
        for old in [each for each, begun in self._begun.items() if now_s - begun.at_s > PATIENCE_S]:
            del self._begun[old]
        key = repr(name)
        begun = self._begun.get(key)
        if begun is None:
            if not 0 < total <= MOST_PIECES or len(self._begun) >= MOST_BEGUN:
                raise UsageError(
                    f"too many fragments: a message of {total}, with {len(self._begun)} incomplete messages"
                )
            begun = _Begun(total, now_s)
        if total != begun.total or not 0 <= number < total or number in begun.pieces:
            raise UsageError(f"error while trying to append fragment {number}")
        self._begun[key] = begun  # not earlier: a refused fragment does not begin a message
        begun.pieces[number] = data
        begun.size += len(data)
        begun.held += PIECE_BYTES + len(data) * (1 if data.isascii() else 4)
        begun.at_s = now_s
        if sum(each.size for each in self._begun.values()) > self._longest:
            del self._begun[key]
            raise UsageError(f"incomplete messages have more than {self._longest:,} characters")
        if len(begun.pieces) < total:
            return None
        del self._begun[key]
        return "".join(begun.pieces[each] for each in range(total))
