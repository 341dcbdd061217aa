"""Reading a tag's attributes: substitutions made, types checked, errors that name tag and attribute.

May import cfepy.status.
"""

from __future__ import annotations

from rospy_shim.roslaunch.document import Tag
from rospy_shim.roslaunch.expression import SubstitutionError
from rospy_shim.roslaunch.scope import Scope
from rospy_shim.roslaunch.substitution import UnsetArgument
from rospy_shim.roslaunch.values import truth


class Attributes:
    """The attributes of one tag, seen from a scope.

    Args:
        tag: the tag.
        scope: where it stands.
    """

    def __init__(self, tag: Tag, scope: Scope) -> None:
        self.tag = tag
        self._scope = scope

    def unknown(self, known: tuple[str, ...]) -> list[str]:
        """Attributes that this kind of tag does not have."""
        return [name for name in self.tag.attributes if name not in (*known, "if", "unless")]

    def optional(self, name: str) -> str | None:
        """The value of an attribute, None when it is not there.

        Raises:
            UsageError: a substitution cannot be made.
        """
        text = self.tag.attributes.get(name)
        return None if text is None else self.resolved(text, name)

    def resolved(self, text: str, name: str | None = None) -> str:
        """A text with its substitutions made; `name` is the attribute it comes from.

        Raises:
            UsageError: a substitution cannot be made.
        """
        try:
            return self._scope.substitutions.resolve(text)
        except UnsetArgument as error:
            hint = f'give {error.name}:=VALUE, or write <arg name="{error.name}" default="..."/> before it'
            raise self.tag.fail(f"{error}; {hint}", name) from None
        except SubstitutionError as error:
            raise self.tag.fail(str(error), name) from None

    def required(self, name: str) -> str:
        """The value of an attribute that must be there.

        Raises:
            UsageError: it is not, or a substitution cannot be made.
        """
        value = self.optional(name)
        if value is None:
            raise self.tag.fail(f'has no {name!r}; write {name}="..."')
        return value

    def flag(self, name: str) -> bool:
        """An attribute that is true or false; False when it is not there.

        Raises:
            UsageError: it is something else.
        """
        value = self.optional(name)
        if value is not None and value.lower() not in ("true", "false"):
            raise self.tag.fail(f"is {value!r}; write true or false", name)
        return value is not None and value.lower() == "true"

    def number(self, name: str, least: float) -> float | None:
        """An attribute that is a number of at least `least`; None when it is not there.

        Raises:
            UsageError: it is something else.
        """
        value = self.optional(name)
        if value is None:
            return None
        try:
            number = float(value)
        except ValueError:
            number = least - 1
        if not number >= least:
            raise self.tag.fail(f"is {value!r}; write a number of at least {least:g}", name)
        return number

    def counts(self) -> bool:
        """Whether `if` and `unless` let the tag count.

        Raises:
            UsageError: both are there, or one is neither true nor false.
        """
        given = {name: self.optional(name) for name in ("if", "unless") if name in self.tag.attributes}
        if len(given) > 1:
            raise self.tag.fail("has both 'if' and 'unless'; leave one of them out")
        for name, value in given.items():
            try:
                return truth(value or "") == (name == "if")
            except ValueError as error:
                raise self.tag.fail(str(error), name) from None
        return True
