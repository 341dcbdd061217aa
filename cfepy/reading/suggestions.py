"""`did you mean X?`: what was probably meant by a name that is not there, in one form for all that is named."""

from __future__ import annotations

from collections.abc import Iterable

LIKENESS = 0.6  # of 1, as difflib counts
_LONGEST, _MOST = 100, 2_000  # characters of a name, and names, that are looked at; more would take long


def like(name: str, known: Iterable[str], most: int = 1, likeness: float = LIKENESS) -> list[str]:
    """The names that are most like one that is not there; capitals count for nothing.

    Args:
        name: as it was written.
        known: the names that there are.
        most: how many.
        likeness: of 1, what makes a name like another.
    """
    from difflib import get_close_matches

    by_folded: dict[str, str] = {}
    for each in [each for each in known if len(each) <= _LONGEST][: _MOST if len(name) <= _LONGEST else 0]:
        by_folded.setdefault(each.casefold(), each)
    return [by_folded[each] for each in get_close_matches(name.casefold(), by_folded, most, likeness)]


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
    """The end of an error about a name that is not there.

    Args:
        name: as it was written.
        known: the names that there are.
        otherwise: what to say when none is like it.
        before: what stands before either, such as "; ".
        form: how a name is shown, such as "<{}>".
        most: how many names to offer.
        likeness: as of `like`.
    """
    near = like(name, known, most, likeness)
    text = f"did you mean {' or '.join(form.format(each) for each in near)}?" if near else otherwise
    return f"{before}{text}" if text else ""
