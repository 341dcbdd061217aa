"""How many public ROS nodes in C++ convert: `python -m dev.convert.survey SOURCES [--json FILE] [--missing FILE]`.

survey.tsv lists nodes of public repositories by commit. SOURCES has a folder OWNER/NAME for each repository, with the
sources at that commit. Repositories of kind "messages", which only provide definitions, are in _messages/OWNER/NAME.
All packages of a node's repository are visible, as in a catkin workspace. Each node is checked for the host. If it
converts there, it is also checked for pool and strict. `--report` writes the counts of a JSON file into
docs/how_to/convertor.md.

The JSON file is written node by node, and a survey continues it: a verdict remains valid as long as the check, the
interface library and the definitions of messages are bitwise the same.
"""

from __future__ import annotations

import argparse
import csv
import hashlib
import json
import os
import re
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

from cfepy.extra.convert import Profile
from cfepy.extra.convert.node_check import ABOUT_HEADERS, Level, RuleFinding, check_program, programs_of
from cfepy.status import UsageError

LIST = Path(__file__).parent / "survey.tsv"
FRESH = LIST.with_name("fresh.tsv")
"""Nodes that were drawn at random from repositories of no other list."""
DOCUMENT = Path(__file__).parents[2] / "docs" / "how_to" / "convertor.md"
BEGIN, END = "<!-- survey: made by python -m dev.convert.survey --report -->", "<!-- end of survey -->"
CODE = ("cfepy/extra/convert", "roscfe", "rospy_shim/types/msgs")
"""Folders of what checks, and of what nodes are compiled with."""
UNREAD = "cmake"
"""Stands for a rule where a node's CMakeLists.txt does not say what it is made of."""


class Node(NamedTuple):
    """A node of the list.

    Attributes:
        repository: OWNER/NAME.
        commit: of its sources.
        file: that has its main, or its nodelet.
        kind: "node", "nodelet", or "messages" for a repository that has definitions for others.
    """

    repository: str
    commit: str
    file: str
    kind: str


class Verdict(NamedTuple):
    """Verdict of the check on a node.

    Attributes:
        repository, file, kind: identify the node.
        refused: the rules that refuse it, by profile; none if it converts.
        blockers: the rules that refuse it for the host: "rule thing".
        code: digest of the checking code; see `code_digest`.
    """

    repository: str
    file: str
    kind: str
    refused: dict[str, list[str]]
    blockers: list[str]
    code: str = ""


def code_digest() -> str:
    """Return a digest of all that affects verdicts beside the nodes: check, interface library, definitions."""
    root = Path(__file__).parents[2]
    digest = hashlib.sha256()
    for folder in CODE:
        for file in sorted(each for each in (root / folder).rglob("*") if each.suffix not in (".pyc", "")):
            digest.update(f"{file.relative_to(root)}\n".encode() + file.read_bytes())
    return digest.hexdigest()


def listed(file: Path = LIST) -> list[Node]:
    """Return all nodes of a list. It may have more columns than a node."""
    with file.open(encoding="utf-8") as stream:
        return [Node(*(row[name] for name in Node._fields)) for row in csv.DictReader(stream, delimiter="\t")]


def verdict_of(node: Node, sources: Path) -> Verdict:
    """Check a node."""
    refused: dict[str, list[str]] = {}
    blockers: list[str] = []
    folder = sources / node.repository
    environ = {"ROS_PACKAGE_PATH": f"{folder}{os.pathsep}{sources / '_messages'}"}
    try:
        program = programs_of([str(folder / node.file)], environ)[0]
        for profile in Profile:
            errors = check_program(program, profile, environ, compile_refused=False).at(Level.ERROR)
            refused[profile.value] = sorted({each.rule for each in errors})
            if profile is Profile.HOST and errors:
                about_headers = [each for each in errors if each.rule in ABOUT_HEADERS]
                blockers = sorted({blocker_of(each) for each in about_headers or errors})
                refused |= {other.value: refused[profile.value] for other in Profile}
                break
    except UsageError as error:
        refused = {profile.value: [UNREAD] for profile in Profile}
        blockers = [f"{UNREAD} {error.text}"]
    return Verdict(node.repository, node.file, node.kind, refused, blockers)


def blocker_of(finding: RuleFinding) -> str:
    """Return the blocking rule and its subject, in words that are the same for all nodes."""
    text = finding.message
    if finding.rule in ("ros-library", "boost-header", "include-unknown", "library-outside"):
        name = text.split()[0]
        text = name if finding.rule == "boost-header" else name.partition("/")[0]
    else:
        text = re.sub(r"; did you mean.*", "", text)[:160]
    return f"{finding.rule} {text}"


def missing(verdicts: Iterable[Verdict]) -> Iterator[str]:
    """Yield the blockers of most nodes, most first: number of nodes blocked by it alone, and in total."""
    alone: Counter[str] = Counter()
    among: Counter[str] = Counter()
    example: dict[str, str] = {}
    for each in verdicts:
        direct = {blocker for blocker in each.blockers if not blocker.startswith("compile-error ")}
        groups = direct or set(each.blockers)  # errors without a rule follow from those with one, mostly
        for blocker in groups:
            among[blocker] += 1
            example.setdefault(blocker, f"{each.repository}/{each.file}")
        if len(groups) == 1:
            alone[next(iter(groups))] += 1
    yield "alone among blocker (example)"
    for blocker, count in sorted(among.items(), key=lambda item: (-alone[item[0]], -item[1], item[0])):
        yield f"{alone[blocker]:5} {count:5} {blocker} ({example[blocker]})"


def table(verdicts: list[Verdict]) -> str:
    """Return the counts as a part of docs/how_to/convertor.md."""
    total = len(verdicts)
    lines = [f"{total} nodes of {len({each.repository for each in verdicts})} public repositories, by commit:", ""]
    lines += ["| profile | convert | refused |", "|---|---|---|"]
    for profile in Profile:
        converts = sum(not each.refused[profile.value] for each in verdicts)
        lines.append(f"| {profile.value} | {converts} ({converts * 100 // total} %) | {total - converts} |")
    rules = Counter(rule for each in verdicts for rule in each.refused[Profile.HOST.value])
    lines += ["", "Rules that refuse nodes in the host profile (several rules may refuse one node):", ""]
    lines += ["| rule | nodes |", "|---|---|"]
    lines += [f"| {rule} | {count} |" for rule, count in sorted(rules.items(), key=lambda item: (-item[1], item[0]))]
    return "\n".join(lines)


def write_report(verdicts: list[Verdict]) -> None:
    """Put the counts into docs/how_to/convertor.md."""
    text = DOCUMENT.read_text(encoding="utf-8")
    DOCUMENT.write_text(between(text, BEGIN, END, table(verdicts)), encoding="utf-8")


def between(text: str, begin: str, end: str, part: str) -> str:
    """Return a text with another part between two marks."""
    before, _, rest = text.partition(begin)
    _, _, after = rest.partition(end)
    return f"{before}{begin}\n\n{part}\n\n{end}{after}"


def read_verdicts(file: Path | None) -> list[Verdict]:
    """Return the verdicts of a file, or none if the file does not exist."""
    if file is None or not file.is_file():
        return []
    return [Verdict(**each) for each in json.loads(file.read_text(encoding="utf-8"))]


def write_verdicts(file: Path | None, verdicts: Iterable[Verdict]) -> None:
    """Write the verdicts, if to a file."""
    if file is not None:
        file.write_text(json.dumps([each._asdict() for each in verdicts], indent=1) + "\n", encoding="utf-8")


def main() -> None:
    """Check all nodes, or the nodes of some repositories."""
    parser = argparse.ArgumentParser(prog="python -m dev.convert.survey", description=__doc__)
    parser.add_argument("sources", type=Path, nargs="?", help="folder OWNER/NAME/...")
    parser.add_argument("--list", type=Path, default=LIST, help=f"another list, such as {FRESH.name}")
    parser.add_argument("--only", default="", help="a part of OWNER/NAME/file")
    parser.add_argument("--json", type=Path, help="verdicts, read by --report")
    parser.add_argument("--missing", type=Path, help="write the missing features, most frequent first")
    parser.add_argument("--report", action="store_true", help=f"write the counts of --json into {DOCUMENT.name}")
    arguments = parser.parse_args()
    if arguments.report:
        write_report(read_verdicts(arguments.json))
        return
    code = code_digest()
    known = {(each.repository, each.file): each for each in read_verdicts(arguments.json) if each.code == code}
    verdicts: list[Verdict] = []
    for node in listed(arguments.list):
        if node.kind != "messages" and arguments.only in f"{node.repository}/{node.file}":
            verdict = known.get((node.repository, node.file))
            if verdict is None:
                verdict = verdict_of(node, arguments.sources)._replace(code=code)
                known[node.repository, node.file] = verdict
                print(verdict.repository, verdict.file, verdict.refused, flush=True)
                write_verdicts(arguments.json, known.values())
            verdicts.append(verdict)
    if arguments.missing is not None:
        arguments.missing.write_text("\n".join(missing(verdicts)) + "\n", encoding="utf-8")
    for profile in Profile:
        print(profile.value, sum(not each.refused[profile.value] for each in verdicts), "of", len(verdicts), "convert")


if __name__ == "__main__":
    main()
