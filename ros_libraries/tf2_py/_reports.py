"""The content of a buffer as text: YAML for tf2's tools, a graph for dot. Imports tf2_py only."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from tf2_py._cache import seconds
from tf2_py._tree import Tree

_SHORTEST = 0.0001  # a span of s below which a rate would mean nothing


class Row(NamedTuple):
    """One frame that has a sample; times in s."""

    name: str
    parent: str
    authority: str
    rate: float
    latest: float
    oldest: float


def rows(tree: Tree, authorities: Mapping[str, str]) -> Iterator[Row]:
    """Yield the frames that have a sample."""
    for name, cache in tree.caches.items():
        stamp, parent = (0, "") if cache is None else cache.latest()
        if cache is not None and parent:
            latest, oldest = seconds(stamp), seconds(cache.oldest_stamp())
            authority = authorities.get(name, "no recorded authority")
            yield Row(name, parent, authority, len(cache) / max(latest - oldest, _SHORTEST), latest, oldest)


def as_yaml(tree: Tree, authorities: Mapping[str, str]) -> str:
    """Return a mapping from each frame to its data (BufferCore::allFramesAsYAML)."""
    if not tree.caches:
        return "{}"
    return "".join(
        f"{row.name}: \n"
        f"  parent: '{row.parent}'\n"
        f"  broadcaster: '{row.authority}'\n"
        f"  rate: {row.rate:.3f}\n"
        f"  most_recent_transform: {row.latest:.3f}\n"
        f"  oldest_transform: {row.oldest:.3f}\n"
        f"  buffer_length: {row.latest - row.oldest:.3f}\n"
        for row in rows(tree, authorities)
    )


def as_dot(tree: Tree, authorities: Mapping[str, str], now: int) -> str:
    """Return a graph in dot's language (BufferCore::_allFramesAsDot).

    Args:
        tree: the frames.
        authorities: name of the last sender of each frame's transform.
        now: present time in ns, for the ages; 0 leaves them out.
    """
    lines = ["digraph G {"] if tree.caches else ['digraph G {\n"no tf data recieved"']
    lines += [_edge(row, seconds(now)) for row in rows(tree, authorities)]
    for name, cache in tree.caches.items():
        is_root = now > 0 if cache is None else not cache.latest()[1]
        if is_root:
            lines += _legend(name, seconds(now))
    return "\n".join(lines) + ("\n}" if tree.caches else "}")


def _edge(row: Row, now: float) -> str:
    age = f"( {now - row.latest:.3f} sec old)" if now > 0 else ""
    return (
        f'"{row.parent}" -> "{row.name}"[label="'
        f"Broadcaster: {row.authority}\\n"
        f"Average rate: {row.rate:.3f} Hz\\n"
        f"Most recent transform: {row.latest:.3f} {age}\\n"
        f"Buffer length: {row.latest - row.oldest:.3f} sec\\n"
        '"];'
    )


def _legend(name: str, now: float) -> list[str]:
    """Return the box with the title, which hangs on a root."""
    recorded = [f'"Recorded at time: {now:.3f}"[ shape=plaintext ] ;\n }}->"{name}";'] if now else [f'}}->"{name}";']
    head = ' subgraph cluster_legend { style=bold; color=black; label ="view_frames Result";'
    return ["edge [style=invis];", "\n".join([head, *recorded])]
