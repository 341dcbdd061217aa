"""`did you mean X?`: suggestions for an unknown name, in one form for all kinds of names."""

from __future__ import annotations

from collections.abc import Iterable

LIKENESS = 0.6  # out of 1, as difflib counts
_LONGEST, _MOST = 100, 2_000  # characters of a name and number of names to compare; more would take long


def like(name: str, known: Iterable[str], most: int = 1, likeness: float = LIKENESS) -> list[str]:
    """Return the known names most similar to an unknown one, ignoring case.

    Args:
        name: the unknown name.
        known: the existing names.
        most: maximum number of names.
        likeness: minimum similarity, out of 1.
    """
    from difflib import get_close_matches

    by_folded: dict[str, str] = {}
    for each in [each for each in known if len(each) <= _LONGEST][: _MOST if len(name) <= _LONGEST else 0]:
        by_folded.setdefault(each.casefold(), each)
    return [by_folded[each] for each in get_close_matches(name.casefold(), by_folded, most, likeness)]


def known_as(name: str, known: Iterable[str]) -> str:
    """Return the known name that a user means who types small letters for capitals; the name itself if none or several
    differ from it only in that.

    A known name with an index, such as `Wheel[3]`, is also known without it.
    """
    folded = name.casefold()
    found = {each[: len(name)] for each in known if f"{each}[".casefold().startswith(f"{folded}[")}
    return found.pop() if len(found) == 1 else name


def did_you_mean(
    name: str,
    known: Iterable[str],
    otherwise: str = "",
    *,
    before: str = "",
    form: str = "{}",
    most: int = 1,
    likeness: float = LIKENESS,
) -> str:
    """Return the end of an error text about an unknown name.

    Args:
        name: the unknown name.
        known: the existing names.
        otherwise: the text if no name is similar.
        before: text before either, such as "; ".
        form: the format of a name, such as "<{}>".
        most: maximum number of names.
        likeness: minimum similarity; see `like`.
    """
    near = like(name, known, most, likeness)
    text = f"did you mean {' or '.join(form.format(each) for each in near)}?" if near else otherwise
    return f"{before}{text}" if text else ""
