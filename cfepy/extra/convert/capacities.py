"""Capacities of texts and arrays of messages in the strict profile, in which nothing allocates."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from cfepy.mission import ARRAY, MOST_ITEMS, TEXT, CppNodesConfig, CppNodesError, MissionSections, mission_environment
from cfepy.pilot import MissionProblem, problem_of
from cfepy.reading.marked_yaml import Marked
from cfepy.reading.suggestions import did_you_mean, listed
from cfepy.status import UsageError, together
from rospy_shim.types.msgs import Library, OnDisk, Packages, shipped
from rospy_shim.types.msgs.spec import BUILTINS, Field, Spec


@dataclass(frozen=True, slots=True)
class Capacities:
    """Capacities of texts and arrays.

    Attributes:
        fields: items by "package/Type.field"; characters of a text. The key "...field[]" is for the texts in an array.
        text: characters of other texts.
        array: items of other arrays of numbers or texts. An array of messages has no default.
    """

    fields: Mapping[str, int] = field(default_factory=dict)
    text: int = TEXT
    array: int = ARRAY

    def of_text(self, place: str) -> int:
        """Return the characters of a text."""
        return self._checked(place, self.fields.get(place, self.text))

    def of_array(self, place: str, item: str) -> int:
        """Return the items of an array.

        Args:
            place: the field, as in `fields`.
            item: their type.

        Raises:
            UsageError: an array of messages without a capacity, or an invalid capacity.
        """
        if place not in self.fields and item not in BUILTINS:
            kind, _, name = place.partition(".")
            raise UsageError(
                f"missing capacity of {place}, an array of {item}; the strict profile reserves memory for "
                "each item. Add to cpp_nodes in the mission file: "
                f"`capacities: {{{kind}: {{{name}: 8}}}}`"
            )
        return self._checked(place, self.fields.get(place, self.array))

    def _checked(self, place: str, number: int) -> int:
        if isinstance(number, bool) or not isinstance(number, int) or not 0 < number <= MOST_ITEMS:
            raise UsageError(f"{place}: a capacity must be a number from 1 to {MOST_ITEMS:,}, not {number!r}")
        return number


def capacities_of(config: CppNodesConfig, library: Library) -> Capacities:
    """Return the capacities of a mission file, checked against the definitions of their types.

    Args:
        config: its section `cpp_nodes:`.
        library: the definitions.

    Raises:
        CppNodesError: a type or field does not exist, or has a fixed length.
    """
    wrong = wrong_capacities(config, library)
    if wrong:
        raise together(wrong)
    return Capacities(config.capacities, config.text, config.array)


def wrong_capacities(config: CppNodesConfig, library: Library) -> list[CppNodesError]:
    """Return all errors in the capacities of a mission file; see `capacities_of`."""
    found = []
    for place, number in config.capacities.items():
        kind, _, name = place.partition(".")
        text = _wrong(kind, name, number, library)
        if text is not None:
            found.append(_error(config.places.get(place), place, text))
    return found


def _error(mark: Marked | None, place: str, text: str) -> CppNodesError:
    if mark is None:
        return CppNodesError(text, field=place)
    return CppNodesError(text, file=mark.file, line=mark.line, field=mark.field)


def _wrong(kind: str, name: str, number: int, library: Library) -> str | None:
    """Return the error of a field's capacity; None if there is none."""
    package = kind.partition("/")[0]
    if library.has(kind, "srv") and not library.has(kind):
        return f"is the service {kind}; name one of its messages, {kind}Request or {kind}Response"
    try:
        spec = library.spec(kind)
    except UsageError as error:
        if library.has(kind):
            return f"cannot be read: {error}"
        near = [f"{package}/{each}" for each in library.names(package) or ()]
        packages = "put its package next to the packages of the nodes, or on ROS_PACKAGE_PATH"
        return f"unknown message type {kind}; {did_you_mean(kind, near, packages)}"
    return _wrong_field(spec, name, number)


def _wrong_field(spec: Spec, name: str, number: int) -> str | None:
    variable = [place for each in spec.fields for place in _places(each)]
    has = f"fields of {spec.full_name} with a capacity: {listed(variable, 'and')}"
    each = next((each for each in spec.fields if each.name == name.removesuffix("[]")), None)
    if each is None:
        return f"unknown field of {spec.full_name}; {did_you_mean(name, variable, has)}"
    if name not in variable:
        own = "" if each.base in BUILTINS else f"; give the capacities of {each.base} instead"
        return f"cannot have a capacity: {each.name} is {each.type}, which has a fixed size{own}; {has}"
    constants = [constant for constant in spec.constants if constant.type == "string"]
    is_only_text = [each.type for each in spec.fields].count("string") == 1 and each.type == "string"
    for constant in constants if is_only_text else ():
        needed = len(constant.value.encode())
        if number < needed:
            return f"is {number}, too small for the constant {constant.name}, which has {needed} characters"
    return None


def _places(each: Field) -> list[str]:
    """Return the keys of a field's capacities: of a text or an array, and of the texts in an array."""
    places = [each.name] if (each.is_array and each.length is None) or each.type == "string" else []
    return [*places, f"{each.name}[]"] if each.is_array and each.base == "string" else places


def check_cpp_nodes(said: MissionSections) -> Iterator[MissionProblem]:
    """Yield errors for capacities of missing types and fields, searched from the packages of the launch files."""
    if not said.cpp_nodes.capacities:
        return
    section = said.places["cpp_nodes"]
    near = said.launch[0][0] if said.launch else section.file
    library = Library([OnDisk(Packages(near, mission_environment()))], base=shipped())
    for error in wrong_capacities(said.cpp_nodes, library):
        yield problem_of(error, section.file)
