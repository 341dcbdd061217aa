"""Parser of the body of an XML-RPC request or answer, with limits (xmlrpc.com/spec).

Python's own parser accepts any number of values, any depth, and entities that expand to others. This parser stops at
the first value that exceeds a limit.
"""

from __future__ import annotations

from typing import Any
from xml.parsers import expat
from xmlrpc.client import ResponseError, Unmarshaller

from cfepy.reading.input_limits import RPC_BYTES, RPC_DEPTH, RPC_VALUES
from cfepy.status import UsageError

_TAGS_A_LEVEL = 5  # of a struct in a struct: value, struct, member, value, struct
_AROUND = 5  # methodCall, params, param, ...
_VALUE = "value"


class RpcError(UsageError):
    """A body that is not XML-RPC, or exceeds a limit."""


def read_body(body: bytes) -> tuple[tuple[Any, ...], str | None]:
    """Parse a body.

    Returns:
        The values, and the method if it is a request.

    Raises:
        RpcError: it is not XML-RPC, or exceeds a limit.
        xmlrpc.client.Fault: it is the answer to a failed request.
    """
    if len(body) > RPC_BYTES:
        raise RpcError(f"XML-RPC of {len(body):,} bytes; the limit is {RPC_BYTES:,}")
    target: Any = Unmarshaller(use_builtin_types=True)
    reader = _Reader(target)
    try:
        reader.read(body)
        values = target.close()
    except RpcError:
        raise
    except ResponseError:
        raise RpcError("not XML-RPC: the values are missing") from None
    except (ValueError, TypeError, LookupError, AttributeError, ArithmeticError, expat.ExpatError) as error:
        raise RpcError(f"not XML-RPC: {error}") from None
    return values, target.getmethodname()


class _Reader:
    """Passes elements on to Python's `Unmarshaller`, and counts them."""

    def __init__(self, target: Any) -> None:
        self._target = target
        self._parser = expat.ParserCreate()
        self._parser.buffer_text = True
        self._parser.StartElementHandler = self._start
        self._parser.EndElementHandler = self._end
        self._parser.CharacterDataHandler = target.data
        self._parser.StartDoctypeDeclHandler = self._doctype
        self._depth = self._values = 0

    def read(self, body: bytes) -> None:
        self._target.xml(None, None)
        try:
            self._parser.Parse(body, True)
        finally:
            del self._parser  # the two objects refer to each other, and would keep the body alive

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        self._depth += 1
        if self._depth > _AROUND + _TAGS_A_LEVEL * RPC_DEPTH:
            raise RpcError(f"XML-RPC with more than {RPC_DEPTH} nested values")
        if tag == _VALUE:
            self._values += 1
            if self._values > RPC_VALUES:
                raise RpcError(f"XML-RPC of more than {RPC_VALUES:,} values")
        self._target.start(tag, attributes)

    def _end(self, tag: str) -> None:
        self._depth -= 1
        self._target.end(tag)

    def _doctype(self, *about: object) -> None:
        raise RpcError("a document type is not allowed in XML-RPC")
