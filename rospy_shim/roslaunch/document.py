"""Launch files as XML: every tag knows its file and line, so that an error can say where.

Imports cfepy.status.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from cfepy.status import UsageError


class Tag:
    """One element.

    Args:
        name: of the tag.
        attributes: as written.
        file, line: where it begins.
    """

    def __init__(self, name: str, attributes: dict[str, str], file: Path, line: int) -> None:
        self.name = name
        self.attributes = attributes
        self.file = file
        self.line = line
        self.children: list[Tag] = []
        self.text = ""  # its own, without that of tags inside it

    def fail(self, text: str, attribute: str | None = None) -> UsageError:
        """The error to raise about this tag.

        Args:
            text: what is wrong and what to do.
            attribute: which of its attributes is wrong.
        """
        field = f"<{self.name}>" if attribute is None else f"<{self.name} {attribute}>"
        return UsageError(text, file=self.file, line=self.line, field=field)

    def walk(self) -> Iterator[Tag]:
        """The tag itself and all tags inside it."""
        yield self
        for child in self.children:
            yield from child.walk()


def read_launch_tag(file: Path) -> Tag:
    """The <launch> tag of a file.

    Raises:
        UsageError: it cannot be read, is not XML, or does not have exactly one <launch>.
    """
    root = _parse(file)
    found = [tag for tag in root.walk() if tag.name == "launch"]
    if len(found) != 1:
        raise root.fail(f"the file has {len(found)} <launch> tags; one of them must stand around everything else")
    return found[0]


def _parse(file: Path) -> Tag:
    from xml.parsers import expat

    try:
        data = file.read_bytes()
    except OSError as error:
        raise UsageError(f"cannot be read: {error.strerror}", file=file) from None
    parser = expat.ParserCreate()
    parser.buffer_text = True
    top = Tag("", {}, file, 1)
    open_tags = [top]

    def start(name: str, attributes: dict[str, str]) -> None:
        tag = Tag(name, attributes, file, parser.CurrentLineNumber)
        open_tags[-1].children.append(tag)
        open_tags.append(tag)

    def end(name: str) -> None:
        open_tags.pop()

    def text(data: str) -> None:
        open_tags[-1].text += data

    parser.StartElementHandler, parser.EndElementHandler, parser.CharacterDataHandler = start, end, text
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        raise UsageError(f"is not XML: {expat.ErrorString(error.code)}", file=file, line=error.lineno) from None
    return top.children[0]
