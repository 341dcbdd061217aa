"""Launch files as XML: tags and their attributes, with substitutions made and types checked.

An error names file, line, tag and attribute. It goes to `LaunchFindings`, which raises the first one or keeps all.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import LAUNCH_NUMBER, XML_BYTES
from cfepy.reading.plain_xml import XmlError, parse_xml
from cfepy.reading.suggestions import did_you_mean, like
from cfepy.status import UsageError
from rospy_shim.roslaunch.model import LaunchRemark
from rospy_shim.roslaunch.scope import Scope
from rospy_shim.roslaunch.substitution import SubstitutionError, UnknownArgument, UnsetArgument, arguments_in
from rospy_shim.roslaunch.values import truth


class Tag:
    """One element.

    Args:
        name: name of the tag.
        attributes: attributes as written.
        file: file that it is in.
        line: line where it begins.
    """

    def __init__(self, name: str, attributes: dict[str, str], file: Path, line: int) -> None:
        self.name = name
        self.attributes = attributes
        self.file = file
        self.line = line
        self.children: list[Tag] = []
        self.text = ""  # its own, without the text of inner tags

    def fail(self, text: str, attribute: str | None = None) -> UsageError:
        """Make the error to raise about this tag.

        Args:
            text: the error and the remedy.
            attribute: the wrong attribute, if there is one.
        """
        field = f"<{self.name}>" if attribute is None else f"<{self.name} {attribute}>"
        return UsageError(text, file=self.file, line=self.line, field=field)

    def remark(self, text: str, *, is_error: bool = False, before_runs: bool = True) -> LaunchRemark:
        """Make a remark about this tag; see `LaunchRemark`."""
        return LaunchRemark(text, self.file, self.line, is_error, before_runs)

    def walk(self) -> Iterator[Tag]:
        """Yield the tag itself and all tags inside it."""
        yield self
        for child in self.children:
            yield from child.walk()


def unused_arguments(launch: Tag) -> list[Tag]:
    """Return the <arg> tags of a file, without those inside an <include>, whose argument is not used in the file.

    The contents of tags that `if` and `unless` leave out count as a use. The result is empty for a file that passes all
    its arguments on, or that has substitutions made in another one.
    """
    tags = list(launch.walk())
    for tag in tags:
        given = tag.attributes
        if given.get("pass_all_args", "false").lower() != "false" or {"file", "subst_value"} <= set(given):
            return []
    used = set().union(*(arguments_in(text) for tag in tags for text in (tag.text, *tag.attributes.values())))
    passed = {id(tag) for include in tags if include.name == "include" for tag in include.walk()}
    declared = [tag for tag in tags if tag.name == "arg" and id(tag) not in passed and tag.attributes.get("name")]
    return [tag for tag in declared if tag.attributes["name"] not in used]


def read_launch_tag(file: Path) -> Tag:
    """Read the <launch> tag of a file.

    Raises:
        UsageError: it cannot be read, is not XML, or does not have exactly one <launch>.
    """
    root = _parse(file)
    found = [tag for tag in root.walk() if tag.name == "launch"]
    if len(found) != 1:
        raise root.fail(f"the file must have one <launch> tag around everything else, not {len(found)}")
    return found[0]


def _parse(file: Path) -> Tag:
    try:
        data = read_limited(file, XML_BYTES)
    except OSError as error:
        raise UsageError(f"cannot be read: {error.strerror}", file=file) from None
    top = Tag("", {}, file, 1)
    open_tags = [top]
    texts: dict[int, tuple[Tag, list[str]]] = {}

    def start(name: str, attributes: dict[str, str], line: int) -> None:
        tag = Tag(name, attributes, file, line)
        open_tags[-1].children.append(tag)
        open_tags.append(tag)

    def end(name: str) -> None:
        open_tags.pop()

    def text(data: str) -> None:
        texts.setdefault(id(open_tags[-1]), (open_tags[-1], []))[1].append(data)

    try:
        parse_xml(data, start, end, text)
    except XmlError as error:
        what = error.text
        if error.is_malformed and len(open_tags) > 1:
            what += f"; the <{open_tags[-1].name}> of line {open_tags[-1].line} is not closed"
        field = None if error.tag is None else f"<{error.tag}>"
        raise UsageError(what, file=file, line=error.line, field=field) from None
    for tag, parts in texts.values():
        tag.text = "".join(parts)
    return top.children[0]


class Attributes:
    """The attributes of one tag, resolved in a scope. Errors go to the findings of the scope.

    Args:
        tag: the tag.
        scope: the scope of the tag.

    Attributes:
        failed: True if the tag has an error, or follows from an earlier one.
    """

    def __init__(self, tag: Tag, scope: Scope) -> None:
        self.tag = tag
        self.failed = False
        self._scope = scope
        self._unknown: list[str] = []

    def wrong(self, text: str, attribute: str | None = None) -> None:
        """Report an error in the tag; see `Tag.fail`.

        Raises:
            UsageError: the error, unless errors are kept; all methods that find one raise it.
        """
        self.failed = True
        self._scope.findings.mistakes.add(self.tag.fail(text, attribute))

    def remark(self, text: str, *, is_error: bool = False) -> None:
        """Add a remark about the tag; see `LaunchRemark`."""
        self._scope.findings.remarks.append(self.tag.remark(text, is_error=is_error))

    def charge(self, work: int) -> None:
        """Add the tag's contribution to the size of the launch (`LAUNCH_WORK` of `cfepy.reading.input_limits`)."""
        self._scope.findings.work += work

    def tell_unknown(self, known: tuple[str, ...]) -> None:
        """Report unknown attributes of the tag; they are ignored, as by roslaunch."""
        allowed = (*known, "if", "unless")
        for name in self.tag.attributes:
            if name not in allowed:
                hint = did_you_mean(name, known, before=", ")
                self.remark(f"<{self.tag.name}> has no attribute {name!r}; it is ignored{hint}", is_error=True)
                self._unknown.append(name)

    def optional(self, name: str) -> str | None:
        """Return the value of an attribute; None if it is missing or a substitution cannot be made."""
        text = self.tag.attributes.get(name)
        return None if text is None else self.resolved(text, name)

    def resolved(self, text: str, name: str | None = None) -> str | None:
        """Return a text with its substitutions made, or None if one cannot be made. `name` is the attribute that it
        comes from.
        """
        try:
            return self._scope.substitutions.resolve(text)
        except UnknownArgument:
            self.failed = True
        except UnsetArgument as error:
            self._tell_unset(error, name)
        except SubstitutionError as error:
            self.wrong(str(error), name)
        return None

    def _tell_unset(self, error: UnsetArgument, attribute: str | None) -> None:
        """Report an argument without a value, once for each time that its file is read."""
        scope, self.failed = self._scope, True
        key = (scope.file, scope.included_at, error.name)
        if key in scope.findings.unset:
            return
        scope.findings.unset.add(key)
        hint = f'give {error.name}:=VALUE, or write <arg name="{error.name}" default="..."/> before it'
        if scope.included_at:
            hint = f'pass it in the <include> of {scope.included_at}, or write <arg name="{error.name}" default="..."/>'
        known = () if error.name in scope.declared else tuple(scope.args)
        other = did_you_mean(error.name, known)
        self.wrong(f"{error}; {other} Or {hint}" if other else f"{error}; {hint}", attribute)

    def required(self, name: str) -> str | None:
        """Return the value of a required attribute; None if it is missing, or a substitution cannot be made."""
        if name not in self.tag.attributes:
            near = like(name, self._unknown)
            self.wrong(f'missing {name!r}; write {name}="..."{f" instead of {near[0]}=" if near else ""}')
        return self.optional(name)

    def flag(self, name: str) -> bool:
        """Return an attribute that is true or false; False if it is missing or invalid."""
        value = self.optional(name)
        if value is not None and value.lower() not in ("true", "false"):
            self.wrong(f"must be true or false, not {value!r}", name)
        return value is not None and value.lower() == "true"

    def number(self, name: str, least: float) -> float | None:
        """Return an attribute that is a number of at least `least`, and not too large; None if it is missing or
        invalid.
        """
        value = self.optional(name)
        if value is None:
            return None
        try:
            number = float(value)
        except ValueError:
            number = least - 1
        if least <= number <= LAUNCH_NUMBER:
            return number
        self.wrong(f"must be a number from {least:g} to {LAUNCH_NUMBER:g}, not {value[:40]!r}", name)
        return None

    def counts(self) -> bool:
        """Return True if `if` and `unless` let the tag count; False if both are given, or one is neither true nor
        false.
        """
        given = {name: self.optional(name) for name in ("if", "unless") if name in self.tag.attributes}
        if len(given) > 1:
            self.wrong("'if' cannot be combined with 'unless'; leave one of them out")
        for name, value in given.items():
            try:
                if value is not None and not self.failed:
                    return truth(value) == (name == "if")
            except ValueError as error:
                self.wrong(str(error), name)
        return not self.failed
