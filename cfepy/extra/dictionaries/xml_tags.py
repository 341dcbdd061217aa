"""XML documents of a dictionary: elements with their lines, so that each error names file, line and field."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import XML_BYTES
from cfepy.reading.plain_xml import XmlError, parse_xml
from cfepy.status import UsageError


@dataclass(slots=True)
class XmlTag:
    """A tag with everything inside; its name has no namespace."""

    name: str
    attributes: dict[str, str]
    file: Path
    line: int
    tags: list[XmlTag] = field(default_factory=list)
    text: str = ""

    def all(self, *names: str) -> Iterator[XmlTag]:
        """Yield the tags directly inside that have one of the names, in order."""
        return (each for each in self.tags if each.name in names)

    def first(self, *way: str) -> XmlTag | None:
        """Return the tag at the end of a way of names from here, or None."""
        found: XmlTag | None = self
        for name in way:
            found = None if found is None else next(found.all(name), None)
        return found

    def inside(self, *way: str) -> Iterator[XmlTag]:
        """Yield all tags at the end of a way of names from here."""
        if not way:
            yield self
            return
        for each in self.all(way[0]):
            yield from each.inside(*way[1:])

    def need(self, name: str) -> str:
        """Return an attribute that must be there.

        Raises:
            UsageError: if it is not.
        """
        if name not in self.attributes:
            raise self.fail(f"missing attribute {name}; add it to <{self.name}>")
        return self.attributes[name]

    @property
    def label(self) -> str:
        """The tag in errors, with its name attribute: "<Entry Count>"."""
        name = self.attributes.get("name", "")
        return f"<{self.name} {name}>" if name else f"<{self.name}>"

    def fail(self, text: str) -> UsageError:
        """Return an error at this tag."""
        return UsageError(text, file=self.file, line=self.line, field=self.label)


def read_document(file: Path) -> XmlTag:
    """Return the outermost tag of a file.

    Raises:
        UsageError: if it cannot be read, is not XML, or exceeds a limit.
    """
    try:
        data = read_limited(file, XML_BYTES)
    except OSError as error:
        raise UsageError(f"cannot be read: {error.strerror}; correct the path", file=file) from None
    open_tags: list[XmlTag] = []
    roots: list[XmlTag] = []

    def start(name: str, attributes: dict[str, str], line: int) -> None:
        tag = XmlTag(name.rpartition(":")[2], attributes, file, line)
        (open_tags[-1].tags if open_tags else roots).append(tag)
        open_tags.append(tag)

    def text(part: str) -> None:
        if open_tags:
            open_tags[-1].text += part

    try:
        parse_xml(data, start, lambda name: open_tags.pop(), text)
    except XmlError as error:
        what = error.text
        if error.is_malformed:
            what += f"; the {open_tags[-1].label} of line {open_tags[-1].line} is not closed" if open_tags else ""
        tag = None if error.tag is None else f"<{error.tag}>"
        raise UsageError(what, file=file, line=error.line, field=tag) from None
    return roots[0]
