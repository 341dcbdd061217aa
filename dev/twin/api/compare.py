"""Compare the answers of the real cFE and of cfepy to one script, and count the compared calls."""

from __future__ import annotations

import re
from collections import Counter

from dev.twin.api.words import unquote

STAMP = re.compile(r"\d{4}-\d{3}-\d\d:\d\d:\d\d\.\d{5} ?")
ADDRESS = re.compile(r"(ptr=0x|BufPtr 0x|block @ 0x|Addr 0x|Handle=(?:0x)?)[0-9a-fA-F]+")
"""Addresses are not told here; table handles are serial numbers in a build that has what is deprecated."""
OSAL_NUMBER = re.compile(r"\b(?:[1-9]\d{4,5}|0x000[1-9A-Fa-f][0-9A-Fa-f]{4})\b")
OF_ANOTHER_POOL = re.compile(r"(Bad offset\()\d+")
"""The distance of a block of one pool to another pool."""
IN_FULL_HERE = re.compile(r"(Send Err:Invalid MsgId\(0x|Send Err:Msg Too Big .*size=)\w+")
"""NASA's code tells 0 there: rows of docs/reference/differences.md."""
DIFFERENT = re.compile(r"\w MSG_Init 0 ")
"""A call that NASA's 7.0.1 accepts: a row of docs/reference/differences.md."""
ID = re.compile(r"#([0-9a-f]+)")
OSAL_KINDS = 0x10
"""Ids above are cFE's, and exactly the same on both sides. Ids of OSAL count what the core made, too."""


def _blocks(answers: list[str]) -> dict[int, list[str]]:
    """Return the answers by their line number, each with its events and log lines."""
    blocks: dict[int, list[str]] = {}
    for line in answers:
        if line[:1].isdigit():
            number, _, rest = line.partition(" ")
            current = blocks[int(number)] = [rest]
        elif line[:2] in ("E ", "L "):
            head, _, text = line.rpartition(" '")
            plain = _plain_text(unquote("'" + text))
            current.append(f"{head} {plain}")
    return blocks


def _plain_text(text: str) -> str:
    text = OF_ANOTHER_POOL.sub(r"\1", text)
    text = IN_FULL_HERE.sub(r"\1", ADDRESS.sub(r"\1", STAMP.sub("", text, 1)))
    return OSAL_NUMBER.sub(_plain_number, text)


def _plain_number(found: re.Match[str]) -> str:
    return "an id" if 0 < int(found[0], 0) >> 16 < OSAL_KINDS else found[0]


class Ids:
    """OSAL ids as ordinals: kind, and the order in which they first appeared."""

    def __init__(self) -> None:
        self.seen: dict[int, dict[int, int]] = {}

    def plain(self, line: str) -> str:
        """Return a line without numbers that depend on objects created by the core."""
        return line if line[:2] in ("E ", "L ") else ID.sub(self._plain, line)

    def _plain(self, match: re.Match[str]) -> str:
        number = int(match[1], 16)
        if not 0 < number >> 16 < OSAL_KINDS:
            return match[0]
        serials = self.seen.setdefault(number >> 16, {})
        return f"#{number >> 16:x}/{serials.setdefault(number, len(serials))}"


def differences(script: list[str], real: list[str], ours: list[str]) -> list[str]:
    """Return each difference as a text of some lines."""
    found = []
    theirs, mine = _blocks(real), _blocks(ours)
    real_ids, own_ids = Ids(), Ids()
    for number, line in enumerate(script, 1):
        if number not in theirs or number not in mine:
            found.append(f"{number} {line}\n  no answer")
            continue
        first = [real_ids.plain(each) for each in theirs[number]]
        second = [own_ids.plain(each) for each in mine[number]]
        if first != second and not DIFFERENT.match(line):
            sides = [f"  cFE   {each}" for each in first if each not in second]
            sides += [f"  cfepy {each}" for each in second if each not in first]
            found.append("\n".join([f"{number} {line[:200]}", *(sides or ["  another order"])]))
    return found


def counts(script: list[str]) -> Counter[str]:
    """Calls by group."""
    return Counter(line.split()[1].partition("_")[0] for line in script)
