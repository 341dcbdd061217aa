"""The targets of a CMake project, and generator expressions about them.

A target keeps its include folders and definitions as the files write them. `CMakeTargets` evaluates them when all files
have been read, as CMake does, because an expression may refer to a target of a later file.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field

from cfepy.extra.c.toolchain.generator_expressions import OBJECTS, GeneratorExpressions

MODULE, OBJECT, STATIC, SHARED, INTERFACE = "MODULE", "OBJECT", "STATIC", "SHARED", "INTERFACE"
KINDS = (MODULE, OBJECT, STATIC, SHARED, INTERFACE)
_MOST_CHARACTERS = 1 << 20  # of one evaluated expression
_MOST_DEPTH = 24
_OBJECTS = f"$<{OBJECTS}:"

INCLUDES, DEFINITIONS, LINKS = "INCLUDE_DIRECTORIES", "COMPILE_DEFINITIONS", "LINK_LIBRARIES"
USED = (INCLUDES, DEFINITIONS, LINKS)
"""Properties that a target uses itself; those with INTERFACE_ in front are used by the targets that link it."""


@dataclass(slots=True)
class Target:
    """A target of CMake.

    Attributes:
        name: its name.
        kind: one of `KINDS`.
        folder: of the file that defines it.
        sources: words of its sources; paths are absolute.
        properties: words by the name of a property, such as INCLUDE_DIRECTORIES.
        is_application: whether `add_cfe_app` made it.
    """

    name: str
    kind: str
    folder: str
    sources: list[str] = field(default_factory=list)
    properties: dict[str, list[str]] = field(default_factory=dict)
    is_application: bool = False

    def add(self, name: str, words: Sequence[str]) -> None:
        """Add words to a property."""
        self.properties.setdefault(name, []).extend(words)


class CMakeTargets:
    """The targets of a project.

    Args:
        find: makes a target that no file has defined yet, such as one of another application's folder; None if there is
            none.
        spend: charges characters to the reader's budget, because expressions of targets that refer to each other can
            multiply.

    Attributes:
        all: the targets by name.
    """

    def __init__(self, find: Callable[[str], Target | None], spend: Callable[[int], object]) -> None:
        self._find = find
        self._spend = spend
        self._known: dict[tuple[str, str], list[str]] = {}
        self._asking: set[tuple[str, str]] = set()
        self.all: dict[str, Target] = {}

    def forget(self) -> None:
        """Forget evaluated properties, after a file has changed targets."""
        self._known.clear()

    def get(self, name: str) -> Target | None:
        """Return a target, from the files that define it if necessary."""
        return self.all.get(name) or self._find(name)

    def includes(self, target: Target) -> list[str]:
        """Return the include folders of a target, evaluated, without duplicates."""
        return self._used(target, INCLUDES)

    def definitions(self, target: Target) -> list[str]:
        """Return the compiler's -D of a target, without `-D`."""
        return [each.removeprefix("-D") for each in self._used(target, DEFINITIONS)]

    def sources(self, target: Target) -> list[str]:
        """Return the sources of a target, and of object libraries that it names or links."""
        found = [each for word in target.sources for each in self.evaluated(word, target)]
        for each in self._linked(target):
            if each.kind in (OBJECT, STATIC, SHARED):
                found += [source for word in each.sources for source in self.evaluated(word, each)]
        return list(dict.fromkeys(found))

    def parts(self, target: Target) -> list[Target]:
        """Return the other targets whose sources are part of a target, which have settings of their own."""
        named: list[Target] = []
        for word in target.sources:
            if word.startswith(_OBJECTS):
                other = self.get(word.removeprefix(_OBJECTS).rstrip(">"))
                named += [other] if other is not None else []
        named += [each for each in self._linked(target) if each.kind in (OBJECT, STATIC, SHARED)]
        return list({each.name: each for each in named}.values())

    def libraries(self, target: Target) -> list[str]:
        """Return the names of linked libraries that no file of the tree builds."""
        words = [each for of in (target, *self._linked(target)) for each in self._property(of, LINKS, 0)]
        return [each for each in dict.fromkeys(words) if each not in self.all and self.get(each) is None]

    def _linked(self, target: Target) -> list[Target]:
        """Return the targets that a target links, with theirs."""
        found: dict[str, Target] = {}
        waiting = [target]
        while waiting:
            one = waiting.pop(0)
            for name in self._property(one, LINKS, 0) + self._property(one, f"INTERFACE_{LINKS}", 0):
                other = self.get(name)
                if other is not None and other.name not in found and other is not target:
                    found[other.name] = other
                    waiting.append(other)
        return list(found.values())

    def _used(self, target: Target, name: str) -> list[str]:
        found = self._property(target, name, 0)
        for each in self._linked(target):
            found += self._property(each, f"INTERFACE_{name}", 0)
        return list(dict.fromkeys(found))

    def _property(self, target: Target, name: str, depth: int) -> list[str]:
        words = target.properties.get(name, [])
        self._spend(len(words) + sum(map(len, words)))
        return [each for word in words for each in self._words(word, depth)]

    def evaluated(self, word: str, target: Target) -> list[str]:
        """Return a word with its generator expressions evaluated, as a list."""
        return self._words(word, 0)

    def _words(self, word: str, depth: int) -> list[str]:
        if "$<" not in word:
            return [word]
        if depth > _MOST_DEPTH:
            return []

        def property_of(name: str, key: str) -> str:
            return ";".join(self._asked(name, key, depth + 1))[:_MOST_CHARACTERS]

        expressions = GeneratorExpressions(lambda name: self.get(name) is not None, property_of, language="C")
        return [part for each in expressions.words([word]) for part in self._objects(each)]

    def _objects(self, word: str) -> list[str]:
        """Return the sources of an object library that a word names; other words unchanged."""
        if not word.startswith(_OBJECTS):
            return [word]
        other = self.get(word.removeprefix(_OBJECTS).rstrip(">"))
        return [] if other is None else self.sources(other)

    def _asked(self, name: str, key: str, depth: int) -> list[str]:
        """Return a property for TARGET_PROPERTY, with the one that it gets from the targets that it links."""
        target, asked = self.get(name), (name, key)
        if target is None or asked in self._asking:  # properties can refer to each other
            return []
        if asked not in self._known:
            self._asking.add(asked)
            found = self._property(target, key, depth)
            plain = key.removeprefix("INTERFACE_")
            for each in self._linked(target) if plain in USED else ():
                found += self._property(each, f"INTERFACE_{plain}", depth)
            self._asking.discard(asked)
            self._known[asked] = list(dict.fromkeys(found))
        return self._known[asked]


def absolute(folder: str, words: Sequence[str]) -> Iterator[str]:
    """Yield paths below a folder; an expression stays."""
    for each in words:
        yield each if each.startswith(("$<", "/")) else os.path.normpath(os.path.join(folder, each))
