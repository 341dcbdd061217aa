"""XML from others, read without other files and within the limits of `cfepy.reading.input_limits`.

Entities may only be short texts, so that they cannot multiply. The number and the nesting of tags are limited.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from cfepy.reading.input_limits import XML_BYTES, XML_DEPTH, XML_ENTITY, XML_TAGS

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element


class XmlError(ValueError):
    """Exception for a text that is not XML or exceeds a limit.

    Args:
        text: the error.
        line: its line, from 1.
        tag: the tag that exceeds a limit; None for other errors.
        is_malformed: whether the parser cannot continue there.
    """

    def __init__(self, text: str, line: int, tag: str | None = None, is_malformed: bool = False) -> None:
        super().__init__(f"{text}, line {line} of it")
        self.text = text
        self.line = line
        self.tag = tag
        self.is_malformed = is_malformed


def plain_xml(data: bytes) -> Element:
    """Parse a document.

    Args:
        data: the document.

    Returns:
        Its outermost element.

    Raises:
        XmlError: if it is not XML or exceeds a limit.
    """
    from xml.etree.ElementTree import TreeBuilder

    builder = TreeBuilder()
    parse_xml(data, lambda name, attributes, line: builder.start(name, attributes), builder.end, builder.data)
    return builder.close()


def parse_xml(
    data: bytes,
    start: Callable[[str, dict[str, str], int], object],
    end: Callable[[str], object],
    text: Callable[[str], object],
) -> None:
    """Parse a document, part by part.

    Args:
        data: the document.
        start: gets the name, attributes and line of each tag that begins.
        end: gets the name of each tag that ends.
        text: gets the text between them, in one or several parts.

    Raises:
        XmlError: if it is not XML or exceeds a limit.
    """
    from xml.parsers import expat

    if len(data) > XML_BYTES:
        raise XmlError(f"has more than {XML_BYTES:,} bytes; split it", 1)
    parser = expat.ParserCreate()
    parser.buffer_text = True
    depth = count = 0

    def begin(name: str, attributes: dict[str, str]) -> None:
        nonlocal depth, count
        depth, count, line = depth + 1, count + 1, parser.CurrentLineNumber
        if depth > XML_DEPTH:
            raise XmlError(f"is nested more than {XML_DEPTH} tags deep; check for a missing end tag", line, name)
        if count > XML_TAGS:
            raise XmlError(f"exceeds the limit of {XML_TAGS:,} tags in a file; split the file", line, name)
        start(name, attributes, line)

    def finish(name: str) -> None:
        nonlocal depth
        depth -= 1
        end(name)

    def entity(name: str, *declared: object) -> None:
        value = declared[1]
        if isinstance(value, str) and len(value) <= XML_ENTITY and not set(value) & {"&", "%", "<"}:
            return
        what = f"entity {name!r} must be a short text; write the text where it is used"
        raise XmlError(what, parser.CurrentLineNumber)

    parser.EntityDeclHandler = entity
    parser.StartElementHandler, parser.EndElementHandler, parser.CharacterDataHandler = begin, finish, text
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        what = f"is not XML: {expat.ErrorString(error.code)}, column {error.offset + 1}"
        raise XmlError(what, error.lineno, is_malformed=True) from None
    except XmlError:
        raise
    except (LookupError, ValueError) as error:  # an error of the encoding that the file names
        raise XmlError(f"is not XML: {error}", 1) from None
