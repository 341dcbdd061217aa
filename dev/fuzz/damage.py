"""Ways to damage an input: bytes, words, lines, and pieces of other inputs of its kind."""

from __future__ import annotations

import re
from collections.abc import Sequence
from random import Random

WORDS = (
    b"-1 0 1e999 -1e999 inf nan 99999999999999999999 0x7fffffff 4294967295 0x 1_0 '' \"\" [] {} null ~ true \" ' : :: ="
    b" ; [ ] { } ( ) < > </ /> & &amp; &a *a !!binary !!timestamp !!int !!python/name:os.system | > % $( ) $(eval ) $$"
    b" \t \xff \xc3\x28 \xed\xa0\x80 \x00 \x1b 2001-01-01 2001-99-99 .5 0o9 .. ../../x /../../x /dev/zero /etc/passwd"
    b" ~/x // a/b __class__ 9**9**9 'a'*999999999 -9223372036854775809 \xe2\x80\xa8 <!-- --> <![CDATA[ # --- ..."
).split(b" ")
NUMBERS = (b"\xff" * 4, bytes(4), b"\x7f\xff\xff\xff", b"\xff\xff\xff\x7f", b"\x80\0\0\0", b"\xff" * 8, b"\0\0\0\x40")
_NUMBER = re.compile(rb"-?\d+(\.\d+)?")
_WORD = re.compile(rb"[\w./$-]+")


def damaged(samples: Sequence[bytes], random: Random) -> bytes:
    """Return one of the samples, damaged in one to four ways. Occasionally returns it unchanged, or noise."""
    found = bytearray(random.choice(samples))
    if random.random() < 0.02:
        return random.randbytes(random.randrange(300))
    for _ in range(random.choice((0, 1, 1, 1, 2, 2, 3, 4))):
        random.choice(_WAYS)(found, samples, random)
    return bytes(found)


def _place(found: bytearray, random: Random) -> int:
    """Somewhere, and often near the beginning, where headers are."""
    return random.randrange(min(len(found), 200) + 1 if random.random() < 0.3 else len(found) + 1)


def _flip(found: bytearray, samples: Sequence[bytes], random: Random) -> None:
    for _ in range(random.randint(1, 10)):
        if found:
            found[random.randrange(len(found))] ^= 1 << random.randrange(8)


def _cut(found: bytearray, samples: Sequence[bytes], random: Random) -> None:
    del found[_place(found, random) :]


def _drop(found: bytearray, samples: Sequence[bytes], random: Random) -> None:
    at = _place(found, random)
    del found[at : at + random.choice((1, 2, 4, 20, 200))]


def _noise(found: bytearray, samples: Sequence[bytes], random: Random) -> None:
    at = _place(found, random)
    found[at : at + random.choice((0, 0, 4, 20))] = random.randbytes(random.choice((1, 2, 4, 30)))


def _number(found: bytearray, samples: Sequence[bytes], random: Random) -> None:
    at, number = _place(found, random), random.choice(NUMBERS)
    found[at : at + len(number)] = number


def _word(found: bytearray, samples: Sequence[bytes], random: Random) -> None:
    at = _place(found, random)
    found[at:at] = random.choice(WORDS)


def _replace(found: bytearray, samples: Sequence[bytes], random: Random) -> None:
    """Another word or number in place of one."""
    places = list((_NUMBER if random.random() < 0.5 else _WORD).finditer(found))
    if places:
        start, end = random.choice(places).span()
        others = _WORD.findall(random.choice(samples)) or [b""]
        found[start:end] = random.choice(WORDS) if random.random() < 0.6 else random.choice(others)


def _lines(found: bytearray, samples: Sequence[bytes], random: Random) -> None:
    """A line is lost, doubled, moved, indented, or comes from elsewhere."""
    lines = bytes(found).split(b"\n")
    at, kind = random.randrange(len(lines)), random.randrange(5)
    line = lines.pop(at)
    if kind == 1:
        lines[at:at] = [line] * random.choice((2, 3, 50))
    elif kind == 2:
        lines.insert(random.randrange(len(lines) + 1), line)
    elif kind == 3:
        lines.insert(at, random.choice((b"  ", b"\t", b"- ")) + line)
    elif kind == 4:
        lines.insert(at, random.choice(random.choice(samples).split(b"\n")))
    found[:] = b"\n".join(lines)


def _repeat(found: bytearray, samples: Sequence[bytes], random: Random) -> None:
    """A piece comes many times."""
    at = _place(found, random)
    piece = bytes(found[at : at + random.choice((1, 2, 5, 30))])
    found[at:at] = piece * random.choice((2, 20, 300))


def _splice(found: bytearray, samples: Sequence[bytes], random: Random) -> None:
    """The end comes from another sample."""
    other = random.choice(samples)
    found[_place(found, random) :] = other[random.randrange(len(other) + 1) :]


_WAYS = (_flip, _cut, _drop, _noise, _number, _word, _word, _replace, _replace, _replace, _lines, _repeat, _splice)
