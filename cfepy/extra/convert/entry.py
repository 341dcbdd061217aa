"""The entry point of a converted node: a source file that describes the node to the interface library.

It has the node's names, arguments, remaps, MsgIds and the first contents of its table of parameters as constants
(`roscfe::NodeDescription` in roscfe/include/roscfe/node.h), and the function that ES calls.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from cfepy.mission import NodeGround
from rospy_shim.parameters.table import FREE, NAME_BYTES, VALUE_BYTES, Row, rows_for
from rospy_shim.parameters.values import leaves_of
from rospy_shim.types.names import SEP

LONGEST_SYMBOL = 19
"""Characters of a symbol and of an application's name that OSAL keeps (OS_MAX_API_NAME without its end)."""
ENTRY_SUFFIX = "_AppMain"
MAIN_SYMBOL = "roscfe_node_main"
LONGEST_QUEUE, PIPE_DEPTH = 64, 50
PRIVATE_ARGUMENT = re.compile(r"_(?!_)[^:]*:=")
NO_MARKS = "roscfe::kNoMarks"
FREE_ROWS = 16
"""Free rows of a table of parameters, for parameters that the node sets itself."""


@dataclass(frozen=True, slots=True)
class NodeEntry:
    """The generated entry point of a node.

    Attributes:
        app: name of the application.
        name: of the node, without its namespace; empty for the name in ros::init.
        namespace: of the node, such as "/".
        args: of main, after the program's name.
        topics: MsgId, and whether it is raw, by resolved name.
        services: MsgId of the answers, by resolved name.
        remaps: resolved names, and their replacements.
        rows: of its table of parameters.
        takes_arguments: whether main has parameters.
        nodelet: the C++ class of the node, if it is a nodelet.
        params_are_given: cfepy's parameter server has the parameters before the node starts.
        ground: MsgId of its housekeeping and number of its performance marks; None without both.
    """

    app: str
    name: str
    namespace: str = SEP
    args: tuple[str, ...] = ()
    topics: Mapping[str, tuple[int, bool]] = field(default_factory=dict)
    services: Mapping[str, int] = field(default_factory=dict)
    remaps: Mapping[str, str] = field(default_factory=dict)
    rows: Sequence[Row] = ()
    takes_arguments: bool = True
    nodelet: str = ""
    params_are_given: bool = False
    ground: NodeGround | None = None

    @property
    def symbol(self) -> str:
        """The entry point's name: APP_AppMain, or a short one if OSAL would cut that."""
        return entry_symbol(self.app)

    def text(self) -> str:
        """Return the source file."""
        return "\n".join(_lines(self))


def entry_symbol(app: str) -> str:
    """Return the entry point of an application, no longer than OSAL allows.

    Args:
        app: its name.
    """
    symbol = f"{app}{ENTRY_SUFFIX}"
    if len(symbol) <= LONGEST_SYMBOL:
        return symbol
    return f"RN_{hashlib.blake2b(app.encode(), digest_size=4).hexdigest()}_Main"


def main_header(takes_arguments: bool) -> str:
    """Return the text that is included before each source of a node, which gives its main function its own symbol."""
    parameters = "int, char **" if takes_arguments else ""
    return f'int main({parameters}) __asm__("{MAIN_SYMBOL}");\n'


def parameter_rows(params: Mapping[str, Any], node: str, others: Iterable[str] = ()) -> list[Row]:
    """Return the rows of a node's table: its own parameters, those that belong to no other node, then free rows.

    Args:
        params: the tree of all parameters.
        node: full name of the node.
        others: full names of the other nodes.
    """
    theirs = tuple(f"{each}{SEP}" for each in others if not f"{node}{SEP}".startswith(f"{each}{SEP}"))
    rows: list[Row] = []
    for name, text in leaves_of("", dict(params)):
        if not name.startswith(theirs):
            rows += rows_for(name, text)
    return rows + [FREE] * FREE_ROWS


def needed_parts(node: NodeEntry) -> list[str]:
    """Return the parts of the interface library that a node needs although its code does not call them.

    Args:
        node: the entry point. Rows and arguments of a launch file need the code for parameters.
    """
    parts = ["subscribers"]
    if any(name for name, _ in node.rows):
        parts += ["parameters", "sim_time"]
    if any(PRIVATE_ARGUMENT.match(each) for each in node.args):
        parts += ["private_parameters"]
    if any(raw for _, raw in node.topics.values()):
        parts += ["long_messages"]
    if node.ground is not None:
        parts += ["ground"]
    return parts


def quoted(text: str) -> str:
    """Return a text as a C literal."""
    return '"' + "".join(_escaped(byte) for byte in text.encode()) + '"'


def _field(text: str, size: int) -> str:
    """Return a text for an array of `size` characters. C++ takes no literal for an array without room for its NUL."""
    if len(text) < size:
        return quoted(text)
    return f"{{{', '.join(_character(byte) for byte in text.encode())}}}"


def _character(byte: int) -> str:
    return "'\\''" if byte == ord("'") else f"'{_escaped(byte)}'"


def _escaped(byte: int) -> str:
    if byte in b'"\\':
        return f"\\{byte:c}"
    return f"{byte:c}" if 0x20 <= byte < 0x7F and byte != ord("?") else f"\\{byte:03o}"


def _lines(node: NodeEntry) -> Iterator[str]:
    parameters = "int, char **" if node.takes_arguments else ""
    yield f"// The entry point of the ROS node {quoted(node.name)}, made by cfepy convert."
    if node.nodelet:
        yield "#include <nodelet/nodelet.h>"
    yield '#include "roscfe/node.h"'
    yield '#include "roscfe/parts.h"'
    yield ""
    if node.nodelet:
        yield "static int roscfe_main(int argc, char **argv)"
        yield "{"
        yield f"    return roscfe::run_nodelet({quoted(node.nodelet)}, argc, argv);"
        yield "}"
    else:
        yield f'int roscfe_main({parameters}) __asm__("{MAIN_SYMBOL}");'
    yield ""
    yield "namespace"
    yield "{"
    yield ""
    topics = [f"{{{quoted(name)}, 0x{id_:04X}, {str(raw).lower()}}}" for name, (id_, raw) in node.topics.items()]
    services = [f"{{{quoted(name)}, 0x{id_:04X}}}" for name, id_ in node.services.items()]
    remaps = [f"{{{quoted(one)}, {quoted(other)}}}" for one, other in node.remaps.items()]
    rows = [
        f"{{{_field(name, NAME_BYTES)}, {_field(value, VALUE_BYTES)}}}" if name or value else "{}"
        for name, value in node.rows
    ]
    yield from _table("const char *const", "kArguments", [quoted(each) for each in node.args])
    yield from _table("const roscfe::TopicId", "kTopics", topics)
    yield from _table("const roscfe::ServiceId", "kServices", services)
    yield from _table("const roscfe::Remap", "kRemaps", remaps)
    yield from _table("const roscfe::ParamRow", "kParams", rows)
    yield "} // namespace"
    yield ""
    yield 'extern "C"'
    yield "{"
    yield "// Its name marks the shared object as a ROS node."
    yield '__attribute__((visibility("default"))) extern const roscfe::NodeDescription roscfe_node;'
    yield "const roscfe::NodeDescription roscfe_node = {"
    yield f"    {quoted(node.app)}, {quoted(node.name)}, {quoted(node.namespace)},"
    for name, table in (
        ("kArguments", node.args),
        ("kTopics", topics),
        ("kServices", services),
        ("kRemaps", remaps),
        ("kParams", rows),
    ):
        yield f"    {name if table else 'nullptr'}, {len(table)},"
    msg_id, marks = (0, None) if node.ground is None else (node.ground.msg_id, node.ground.performance_id)
    yield f"    {LONGEST_QUEUE}, {PIPE_DEPTH}, {str(node.params_are_given).lower()},"
    yield f"    0x{msg_id:04X}, {NO_MARKS if marks is None else marks}}};"
    yield ""
    yield f'__attribute__((visibility("default"))) void {node.symbol}(void)'
    yield "{"
    yield from (f"    roscfe::parts::need(roscfe::parts::{part});" for part in needed_parts(node))
    yield "    roscfe::run(roscfe_node, roscfe_main);"
    yield "}"
    yield "}"
    yield ""


def _table(kind: str, name: str, rows: Sequence[str]) -> Iterator[str]:
    if not rows:
        return
    yield f"{kind} {name}[] = {{"
    yield from (f"    {row}," for row in rows)
    yield "};"
    yield ""
