"""The contents of a C++ source, read without the compiler: plain data, separately for each file."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from cfepy.extra.convert.node_check.findings import GraphName, SourcePlace


class Include(NamedTuple):
    """An `#include`.

    Attributes:
        name: of the header.
        place: of the line.
        conditional: whether it is between `#if` and `#endif`, where only the compiler knows whether it counts.
    """

    name: str
    place: SourcePlace
    conditional: bool


class Met(NamedTuple):
    """A place that matches a rule.

    Attributes:
        rule: its id.
        place: its place.
        message: the message for the finding.
        function: names of the functions around it, without their classes; "lambda" for one that is a callback.
    """

    rule: str
    place: SourcePlace
    message: str
    function: str = ""


class Main(NamedTuple):
    """A definition of main.

    Attributes:
        place: its place.
        takes: "nothing", "arguments", or invalid parameters, as written.
    """

    place: SourcePlace
    takes: str


@dataclass(slots=True)
class SourceFile:
    """The contents of one source.

    Attributes:
        path: of the file.
        includes, met, mains: in the order of the file.
        names: names in the ROS graph that it uses.
        callbacks: names of functions that are passed to ROS.
        parameters: the type of the first parameter of each function, by its name without its class.
        constants: variables and macros that hold a text.
        defaults: variables that get a parameter's value, with the default value in the source.
        handlers: the callback of each subscription, by its place.
        classes: names of classes that are defined in it.
        owners: of the functions that are defined outside of classes, the class; "" for functions without a class.
            Functions that other files cannot call are left out.
        has_objects: whether there are variables of the whole program that may be made when it is loaded.
        unparsed: places that the parser does not understand.
    """

    path: Path
    includes: list[Include] = field(default_factory=list)
    met: list[Met] = field(default_factory=list)
    mains: list[Main] = field(default_factory=list)
    names: list[GraphName] = field(default_factory=list)
    callbacks: set[str] = field(default_factory=set)
    classes: set[str] = field(default_factory=set)
    owners: set[str] = field(default_factory=set)
    parameters: dict[str, str] = field(default_factory=dict)
    constants: dict[str, str] = field(default_factory=dict)
    defaults: dict[str, str] = field(default_factory=dict)
    handlers: dict[SourcePlace, str] = field(default_factory=dict)
    has_objects: bool = False
    unparsed: int = 0
