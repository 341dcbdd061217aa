"""The graph of a mission as text, and for graphviz."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Sequence

from cfepy.ground.traffic_graph.model import APP, CORE, NODE, Channel, MissionGraph, Taker, Unit

_SHAPES = {NODE: "ellipse", APP: "box", CORE: "box3d"}
_MARGIN = " " * 4
_NO_BREAK = "\N{NO-BREAK SPACE}"


def graph_text(graph: MissionGraph, width: int = 100) -> str:
    """Return a paragraph for each application and node: the messages that it sends, with receivers, and those that it
    receives, with pipes.

    Args:
        graph: the graph.
        width: of a line, in characters; names are never broken.
    """
    paragraphs = [[f"{graph.mission}: {graph.summary}"], *(_paragraph(graph, unit) for unit in graph.units)]
    return "\n\n".join("\n".join(_wrapped(line, width) for line in lines) for lines in paragraphs) + "\n"


def _wrapped(line: str, width: int) -> str:
    """Return a line, wrapped below its own second word if it is too long. Text in brackets stays together."""
    own = line[: len(line) - len(line.lstrip())]
    below = own + " " * 7 if own == _MARGIN else own + "  "
    head, bracket, rest = line.lstrip().partition("  (")
    filled = textwrap.fill(
        head + bracket + rest.replace(" ", _NO_BREAK),
        width,
        initial_indent=own,
        subsequent_indent=below,
        break_long_words=False,
        break_on_hyphens=False,
    )
    return filled.replace(_NO_BREAK, " ")


def _paragraph(graph: MissionGraph, unit: Unit) -> Iterator[str]:
    yield f"{unit.name} ({kind_text(unit)})"
    lines = [*_sent(graph, unit), *_taken(graph, unit), *_offered(graph, unit)]
    yield from lines or ["  sends nothing, and takes nothing"]


def _sent(graph: MissionGraph, unit: Unit) -> Iterator[str]:
    sent = [channel for channel in graph.channels if unit.name in channel.senders]
    if sent:
        yield "  sends"
    for channel in sent:
        takers = ", ".join(dict.fromkeys(each.unit for each in channel.subscriptions)) or "nobody"
        about = about_text(channel)
        yield f"{_MARGIN}{_number(channel)} {channel.name} -> {takers}{f'  ({about})' if about else ''}"


def _taken(graph: MissionGraph, unit: Unit) -> Iterator[str]:
    pipes: dict[tuple[str, int], list[tuple[Channel, Taker]]] = {}
    for channel in graph.channels:
        for each in channel.subscriptions:
            if each.unit == unit.name:
                pipes.setdefault((each.pipe, each.depth), []).append((channel, each))
    for (pipe, depth), taken in sorted(pipes.items()):
        yield f"  takes out of pipe {pipe}, depth {depth}"
        for channel, each in taken:
            senders = ", ".join(channel.senders) or "nobody yet"
            limit = f"  (limit {each.limit})" if each.limit < depth else ""
            yield f"{_MARGIN}{_number(channel)} {channel.name} <- {senders}{limit}"


def _offered(graph: MissionGraph, unit: Unit) -> Iterator[str]:
    for offer in graph.offers:
        if offer.unit == unit.name:
            yield f"  offers the {offer.kind} {offer.name}  ({offer.type})"


def _number(channel: Channel) -> str:
    return f"0x{channel.msg_id:04X}"


def kind_text(unit: Unit) -> str:
    """Return the kind of a unit."""
    if unit.kind == CORE:
        return "the core"
    if unit.kind == NODE:
        return "node" if unit.app == unit.name else f"node, in cFE {unit.app}"
    return "application"


def about_text(channel: Channel) -> str:
    """Return the type of a topic's messages, and their number per virtual second."""
    parts = [channel.type] if channel.is_topic else []
    if channel.hz:
        parts.append(f"{channel.hz:,.1f} Hz")
    return ", ".join(parts)


def room_text(takers: Sequence[Taker]) -> str:
    """Return the limit of a pipe, and the limits of messages that are lower."""
    depth = takers[0].depth
    limits = sorted({each.limit for each in takers if each.limit < depth})
    if not limits:
        return f"depth {depth}"
    return f"depth {depth}, limit {limits[0]}" + (f" to {limits[-1]}" if len(limits) > 1 else "")


def graph_dot(graph: MissionGraph) -> str:
    """Return the graph in graphviz's language: applications are boxes, nodes ellipses, messages notes, pipes on the
    arrows.
    """
    lines = [f"digraph {_quoted(graph.mission)} {{", "rankdir=LR;", 'node [fontname="sans-serif", fontsize=10];']
    lines.append('edge [fontname="sans-serif", fontsize=8];')
    lines += [f"{_quoted(unit.name)} [shape={_SHAPES[unit.kind]}, style=bold];" for unit in graph.units]
    for channel in graph.channels:
        number = _number(channel)
        about = [channel.name, number, *([channel.type] if channel.is_topic else [])]
        lines.append(f'"{number}" [shape=note, label={_quoted(chr(10).join(about))}];')
        lines += [f'{_quoted(sender)} -> "{number}";' for sender in channel.senders]
        for each in channel.subscriptions:
            label = _quoted(f"{each.pipe}\n{room_text([each])}")
            lines.append(f'"{number}" -> {_quoted(each.unit)} [label={label}];')
    return "\n".join([*lines, "}"]) + "\n"


def _quoted(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return f'"{escaped}"'
