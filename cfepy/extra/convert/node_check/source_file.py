"""What a C++ source has, as it is read without the compiler: plain data, for each file by itself."""

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
        conditional: whether it stands between `#if` and `#endif`, where the compiler alone knows whether it counts.
    """

    name: str
    place: SourcePlace
    conditional: bool


class Met(NamedTuple):
    """Something that a rule is about.

    Attributes:
        rule: its id.
        place: where.
        message: what it is.
        function: names of the functions around it, without their classes; "lambda" for one that is a callback.
    """

    rule: str
    place: SourcePlace
    message: str
    function: str = ""


class Main(NamedTuple):
    """A definition of main.

    Attributes:
        place: where.
        takes: "nothing", "arguments", or something else that main may not take, as written.
    """

    place: SourcePlace
    takes: str


@dataclass(slots=True)
class SourceFile:
    """What one source has.

    Attributes:
        path: of the file.
        includes, met, mains: as they come.
        names: that it uses in the ROS graph.
        callbacks: names of functions that are given to ROS.
        parameters: the type of the first parameter of each function, by its name without its class.
        constants: variables and macros that hold a text.
        defaults: variables that get a parameter's value, and the default that is written there.
        handlers: the callback of each subscription, by its place.
        classes: names of classes that are defined in it.
        owners: of the functions that are defined outside of classes, the class; "" for those of none. Functions that
            other files cannot call are left out.
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
