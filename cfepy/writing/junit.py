"""Results of tests as JUnit XML, the format that continuous integration servers read.

There is no standard. The elements and attributes here are those that Jenkins (`jenkins-junit.xsd` of its plugin xunit),
GitLab and the reporters of GitHub Actions read.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from xml.etree import ElementTree

from cfepy.writing.ci_findings import FindingPlace, relative
from cfepy.writing.markup import printable

FAILURE, ERROR, SKIPPED = "failure", "error", "skipped"


@dataclass(frozen=True, slots=True)
class Problem:
    """A reason why a test did not pass: `kind` is FAILURE, ERROR or SKIPPED, `text` its message."""

    kind: str
    text: str
    type: str = ""
    detail: str = ""


@dataclass(frozen=True, slots=True)
class Case:
    """One test; `seconds` is virtual time, `properties` are further facts by name."""

    suite: str
    name: str
    seconds: float = 0.0
    problems: tuple[Problem, ...] = ()
    place: FindingPlace | None = None
    properties: Mapping[str, str] = field(default_factory=dict)


@dataclass(slots=True)
class Suite:
    """The tests of one run of a command. It counts its cases, unless `counts` has the numbers of another program."""

    name: str
    cases: Sequence[Case]
    properties: Mapping[str, str] = field(default_factory=dict)
    counts: Mapping[str, int] | None = None

    def xml(self, base: Path) -> bytes:
        """Return the suite as a file.

        Args:
            base: files of cases below this folder are named relative to it.
        """
        counts = {name: str(number) for name, number in (self.counts or self._counted()).items()}
        time = f"{sum(case.seconds for case in self.cases):.3f}"
        root = ElementTree.Element("testsuites", {**counts, "time": time})
        suite = ElementTree.SubElement(root, "testsuite", {"name": printable(self.name), **counts, "time": time})
        if self.properties:
            properties = ElementTree.SubElement(suite, "properties")
            for name, value in self.properties.items():
                ElementTree.SubElement(properties, "property", name=name, value=printable(value))
        for case in self.cases:
            _add(suite, case, base)
        ElementTree.indent(root)
        text: bytes = ElementTree.tostring(root, encoding="utf-8", xml_declaration=True)
        return text + b"\n"

    def _counted(self) -> dict[str, int]:
        kinds = [problem.kind for case in self.cases for problem in case.problems[:1]]
        found = {f"{kind}s" if kind != SKIPPED else kind: kinds.count(kind) for kind in (FAILURE, ERROR, SKIPPED)}
        return {"tests": len(self.cases), **found}


def _add(suite: ElementTree.Element, case: Case, base: Path) -> None:
    about = {"classname": case.suite, "name": case.name, "time": f"{case.seconds:.3f}"}
    if case.place is not None:
        about["file"] = relative(case.place.file, base).as_posix()
        about |= {"line": str(case.place.line)} if case.place.line else {}
    tag = ElementTree.SubElement(suite, "testcase", {name: printable(value) for name, value in about.items()})
    if case.properties:
        properties = ElementTree.SubElement(tag, "properties")
        for name, value in case.properties.items():
            ElementTree.SubElement(properties, "property", name=name, value=printable(value))
    for problem in case.problems:
        why = {"message": problem.text} | ({"type": problem.type} if problem.type else {})
        inside = ElementTree.SubElement(tag, problem.kind, {name: printable(text) for name, text in why.items()})
        inside.text = printable(problem.detail) or None
