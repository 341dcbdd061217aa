"""The folder that a conversion becomes: applications for a cFS mission tree, and a mission for cfepy.

roscfe/        the interface library, the headers of messages, and roscfe.cmake, which builds both
packages/      the nodes' own sources and headers, as they are
APP/           an application: CMakeLists.txt and its entry point
tables/        the tables of parameters as files that the ground can load
mission/       a mission of cfepy with the same nodes and MsgIds, those in Python beside them
targets.cmake, startup_lines.scr, README.md, report.md, report.json
"""

from __future__ import annotations

import json
import os
import re
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from cfepy.extra.convert.build import (
    HEAP_SOURCE,
    LANGUAGE,
    BuildOptions,
    core_flags,
    library_folder,
    library_includes,
    library_sources,
    link_flags,
    profile_flags,
    uses_exceptions,
)
from cfepy.extra.convert.capacities import capacities_of
from cfepy.extra.convert.conversion import Conversion, ConvertedNode
from cfepy.extra.convert.cpp_sources import collect, message_types
from cfepy.extra.convert.entry import main_header
from cfepy.extra.convert.message_headers import Profile, write_headers
from cfepy.mission import COMPILED_STACK_BYTES, LOCK_FILE, STARTUP_SCRIPT, CppNodesConfig
from cfepy.status import UsageError
from cfepy.tbl import TableImage
from cfepy.tbl import build as table_file
from rospy_shim.parameters.table import pack

PRIORITY = 60
MADE = "made by cfepy convert"
MAIN_HEADERS = {True: "main_with_arguments.h", False: "main_without_arguments.h"}
EXPORTS = "exports.map"
EXPORTED = "{ global: *_AppMain; RN_*_Main; roscfe_node; local: *; };\n"
"""Exports of a node. If a node exported a copy of a C++ library function and were the first one that needs it, the
library would use that copy too. The node would then stay in memory, and start again with its old state."""
C_ONLY = ("-std=c99", "-pedantic", "-Wstrict-prototypes", "-Wmissing-prototypes", "-Werror")
"""Options that a cFS mission sets for all languages, but that are invalid for C++."""


def project_files(made: Conversion, config: CppNodesConfig, folder: Path) -> dict[str, bytes]:
    """Return all files of the folder, by path.

    Args:
        made: the conversion.
        config: the build settings of the nodes.
        folder: the later folder, for paths that lead out of it.

    Raises:
        CppNodesError: a capacity of a type or field that does not exist, or has none.
        UsageError: a field without a capacity.
    """
    files: dict[str, bytes] = {}
    thrown = any(uses_exceptions(node.sources) for node in made.nodes)
    options = BuildOptions(Profile(config.profile), capacities_of(config, made.library), config.arena_bytes, thrown)
    files |= _library(made, options)
    for node in made.nodes:
        files |= _application(node)
    texts = {
        "targets.cmake": _targets(made, folder),
        "startup_lines.scr": "".join(startup_line(node) for node in made.nodes),
        "README.md": _readme(made, folder),
        "report.md": report_text(made),
        "report.json": json.dumps(report(made), indent=1) + "\n",
        **{f"mission/{name}": text for name, text in _mission(made, config, folder).items()},
    }
    return files | {name: text.encode() for name, text in texts.items()}


def startup_line(node: ConvertedNode) -> str:
    """Return the line of a startup script that starts a node."""
    app = node.node.app
    return f"CFE_APP, {node.file}, {node.entry.symbol}, {app}, {PRIORITY}, {COMPILED_STACK_BYTES}, 0x0, 0;\n"


def origin(node: ConvertedNode) -> str:
    """Return the origin of a node: package and type."""
    return node.node.type if node.entry.nodelet else f"{node.node.package}/{node.node.type}"


# -- sources and build files -------------------------------------------------------------------------------------------


def _library(made: Conversion, options: BuildOptions) -> dict[str, bytes]:
    """Return the interface library with the headers of all messages."""
    root = library_folder()
    found = {
        f"roscfe/{each.relative_to(root)}": each.read_bytes() for each in sorted(root.rglob("*")) if each.is_file()
    }
    used = library_sources(header for node in made.nodes for header in node.headers)
    needed = collect(used, library_includes())
    types = {*message_types(needed.missing, made.library), *(name for node in made.nodes for name in node.types)}
    with tempfile.TemporaryDirectory(prefix="cfepy-convert-") as scratch:
        said = (sorted(types), Path(scratch), options.profile, made.library)
        for header in write_headers(*said, options.capacities):
            found[f"roscfe/msg/{header.relative_to(scratch)}"] = header.read_bytes()
    for node in made.nodes:
        found |= {f"roscfe/msg/{name}": text.encode() for name, text in node.configurations.items()}
    for with_arguments, name in MAIN_HEADERS.items():
        found[f"roscfe/{name}"] = main_header(with_arguments).encode()
    sources = [f"src/{each.relative_to(root / 'src')}" for each in used]
    found[f"roscfe/{EXPORTS}"] = EXPORTED.encode()
    found["roscfe/roscfe.cmake"] = _cmake_of_library(sources, options).encode()
    return found


def _cmake_of_library(sources: Iterable[str], options: BuildOptions) -> str:
    profile = options.profile
    arena = options.flags_of(Path(HEAP_SOURCE))
    words = " ".join(each[2:] for each in arena)
    definitions = f"\n    target_compile_definitions(${{ROSCFE_LIBRARY}} PRIVATE {words})" if arena else ""
    flags = [*LANGUAGE, f"-DROSCFE_PROFILE_{profile.name}"]
    linked = " ".join(link_flags(profile)[1:])  # CMake adds -shared
    listed, hosted = (
        "".join(f"\n      ${{ROSCFE_DIR}}/{each}" for each in sources if each.startswith("src/posix/") == is_hosted)
        for is_hosted in (False, True)
    )
    return f"""# The interface library for ROS nodes, and how a node is built with it; {MADE}.
# A CMakeLists.txt includes this file before anything else.

enable_language(CXX)
set(ROSCFE_DIR ${{CMAKE_CURRENT_LIST_DIR}})
# A mission may have several such folders, with other messages and another profile: each has a library of its own.
get_filename_component(ROSCFE_FOLDER ${{ROSCFE_DIR}} DIRECTORY)
get_filename_component(ROSCFE_FOLDER ${{ROSCFE_FOLDER}} NAME)
set(ROSCFE_LIBRARY roscfe_${{ROSCFE_FOLDER}})
set(ROSCFE_FLAGS {" ".join(flags)})
set(ROSCFE_NODE_FLAGS {" ".join(profile_flags(options)[1:])})

# Options that a mission gives all languages, though they are of C alone.
get_property(ROSCFE_OPTIONS DIRECTORY PROPERTY COMPILE_OPTIONS)
list(REMOVE_ITEM ROSCFE_OPTIONS {" ".join(C_ONLY)})
set_property(DIRECTORY PROPERTY COMPILE_OPTIONS "${{ROSCFE_OPTIONS}}")

# One library for all nodes of the folder. It is linked into each of them, for nodes share no variables.
if(NOT TARGET ${{ROSCFE_LIBRARY}})
    add_library(${{ROSCFE_LIBRARY}} STATIC{listed}
    )
    if(NOT CMAKE_SYSTEM_NAME STREQUAL "Generic") # a computer without an operating system has no POSIX, either
        target_sources(${{ROSCFE_LIBRARY}} PRIVATE{hosted}
        )
    endif()
    target_include_directories(${{ROSCFE_LIBRARY}}
        PUBLIC ${{ROSCFE_DIR}}/include ${{ROSCFE_DIR}}/threads ${{ROSCFE_DIR}}/boost ${{ROSCFE_DIR}}/msg)
    target_include_directories(${{ROSCFE_LIBRARY}}
        SYSTEM PRIVATE $<TARGET_PROPERTY:core_api,INTERFACE_INCLUDE_DIRECTORIES>)
    target_compile_definitions(${{ROSCFE_LIBRARY}} PRIVATE $<TARGET_PROPERTY:core_api,INTERFACE_COMPILE_DEFINITIONS>)
    target_compile_options(${{ROSCFE_LIBRARY}} PRIVATE ${{ROSCFE_FLAGS}} {" ".join(core_flags(options))}){definitions}
endif()

# roscfe_node(NAME MAIN_HEADER ENTRY SOURCE...): a node that is an application of cFE.
function(roscfe_node NAME MAIN_HEADER ENTRY)
    add_cfe_app(${{NAME}} ${{ENTRY}} ${{ARGN}})
    target_compile_options(${{NAME}} PRIVATE ${{ROSCFE_FLAGS}} ${{ROSCFE_NODE_FLAGS}})
    set_source_files_properties(${{ARGN}} PROPERTIES COMPILE_OPTIONS "-include;${{ROSCFE_DIR}}/${{MAIN_HEADER}}")
    target_link_libraries(${{NAME}} ${{ROSCFE_LIBRARY}})
    target_link_options(${{NAME}} PRIVATE {linked} -Wl,--version-script=${{ROSCFE_DIR}}/{EXPORTS})
endfunction()
"""


def _application(node: ConvertedNode) -> dict[str, bytes]:
    files = {f"packages/{_place(node, each)}": node.sources.contents[each] for each in node.sources.contents}
    program = node.program
    sources = "".join(f"\n    {cmake_word(f'../packages/{_place(node, each)}', each)}" for each in program.sources)
    includes = _include_folders(node)
    text = f"""# The ROS node {_line(node.node.full_name)}, {_line(origin(node))}; {MADE}.
include(${{CMAKE_CURRENT_LIST_DIR}}/../roscfe/roscfe.cmake)

roscfe_node({node.file} {MAIN_HEADERS[node.entry.takes_arguments]} fsw/src/{node.file}_entry.cpp{sources}
)
"""
    if includes:
        text += f"target_include_directories({node.file} BEFORE PRIVATE\n    {chr(10).join(includes)}\n)\n"
    if program.definitions:
        definitions = " ".join(cmake_word(each, program.package.folder) for each in program.definitions)
        text += f"target_compile_definitions({node.file} PRIVATE {definitions})\n"
    files[f"{node.file}/CMakeLists.txt"] = text.encode()
    files[f"{node.file}/fsw/src/{node.file}_entry.cpp"] = node.entry.text().encode()
    rows = b"".join(pack(row) for row in node.entry.rows)
    image = TableImage(f"{node.node.app}.Params", rows, f"parameters of {node.node.full_name}"[:31])
    files[f"tables/{node.file}_params.tbl"] = table_file(image)
    return files


def _place(node: ConvertedNode, file: Path) -> str:
    """Return the path of a node's file below packages/: in the folder of its package, at the same place as there."""
    file = Path(os.path.abspath(file))
    roots = [(node.program.package.name, node.program.package.folder)]
    roots += [(each.name, each.parent if each.name == "include" else each) for each in node.program.includes]
    for name, root in roots:
        if file.is_relative_to(root):
            inner = root.name if name == "include" else name
            return f"{inner}/{file.relative_to(root)}"
    return f"others/{file.name}"


def _include_folders(node: ConvertedNode) -> list[str]:
    """Return the include folders of a node's packages that have files here."""
    found: dict[str, None] = {}
    for folder in node.program.includes:
        inside = next((each for each in node.sources.contents if each.is_relative_to(folder)), None)
        if inside is not None:
            depth = len(inside.relative_to(folder).parts)
            found["/".join(Path(_place(node, inside)).parts[:-depth])] = None
    where = node.program.package.folder
    return [cmake_word(each, where, "${CMAKE_CURRENT_LIST_DIR}/../packages/") for each in found]


# -- other files -------------------------------------------------------------------------------------------------------


def cmake_word(text: str, of: Path, before: str = "") -> str:
    """Return a text as one argument of a command of CMake.

    Args:
        text: such as the path of a source, or a definition.
        of: its owner, for errors.
        before: text before it in the argument, in CMake's form.

    Returns:
        The text itself if it needs no quotes, else in quotes, with all special characters escaped.

    Raises:
        UsageError: CMake would split it anyway: lists are divided at semicolons, and paths are lists.
    """
    if _PLAIN_WORD.fullmatch(text):
        return before + text
    if not text.isprintable() or text.endswith("\\") or any(each in text for each in _DIVIDING):
        raise UsageError(f"{text!r} has a character that CMake does not allow in a word; choose another name", file=of)
    return f'"{before}' + re.sub(r'([\\"$])', r"\\\1", text) + '"'


_PLAIN_WORD = re.compile(r'[\w./+@~=,:%-]+("[\w./+@~=,:%-]*")?')
_DIVIDING = (";", "[", "]", "$<")


def _line(text: str) -> str:
    """Return a text for a comment, which ends with its line."""
    return "".join(each if each.isprintable() else "?" for each in text)


def _targets(made: Conversion, folder: Path) -> str:
    names = " ".join(node.file for node in made.nodes)
    where = cmake_word(f"apps/{folder.name}", folder)
    places = "".join(f"set({node.file}_SEARCH_PATH {where})\n" for node in made.nodes)
    name = _line(folder.name)
    return f"""# Lines for the targets.cmake of a mission that has this folder as apps/{name}; {MADE}.
list(APPEND MISSION_GLOBAL_APPLIST {names})
{places}"""


def _mission(made: Conversion, config: CppNodesConfig, folder: Path) -> dict[str, str]:
    """Return a mission of cfepy: the launch file with the compiled-in MsgIds, profile and capacities."""
    launch = made.task.launch
    if launch is None:
        return {}
    file, args = launch
    said: dict[str, Any] = {"file": os.path.relpath(file, folder / "mission")}
    if args:
        said["args"] = dict(args)
    text = f"# {_line(made.task.title)} as a mission of cfepy; {MADE}.\nlaunch:\n  - {json.dumps(said)}\n"
    text += "".join(_cpp_nodes(config, made))
    pins = dict(made.ids.topics)
    if pins:
        text += "topics:\n"
        text += "".join(
            f"  {json.dumps(name)}: {{msg_id: 0x{each.msg_id:04X}, raw: {str(each.raw).lower()}}}\n"
            for name, each in sorted(pins.items())
        )
    return {STARTUP_SCRIPT: "!\n", "mission.yaml": text, LOCK_FILE: _lock(made)}


def _cpp_nodes(config: CppNodesConfig, made: Conversion) -> Iterator[str]:
    """Yield the section `cpp_nodes:`, without default values."""
    usual = CppNodesConfig()
    yield "cpp_nodes:\n  ground:\n"
    for node in made.nodes:
        ground = node.entry.ground
        assert ground is not None  # a conversion gives each node one
        marks = "" if ground.performance_id is None else f", performance_id: {ground.performance_id}"
        yield f"    {json.dumps(node.node.full_name)}: {{msg_id: 0x{ground.msg_id:04X}{marks}}}\n"
    if config.profile == usual.profile:
        return
    yield f"  profile: {config.profile}\n  arena_bytes: {config.arena_bytes}\n"
    by_type: dict[str, dict[str, int]] = {}
    for place, number in sorted(config.capacities.items()):
        kind, _, name = place.partition(".")
        by_type.setdefault(kind, {})[name] = number
    sizes = {name: getattr(config, name) for name in ("text", "array") if getattr(config, name) != getattr(usual, name)}
    if by_type or sizes:
        yield "  capacities:\n"
        yield from (f"    {name}: {json.dumps(said)}\n" for name, said in {**sizes, **by_type}.items())


def _lock(made: Conversion) -> str:
    lines = [f"# MsgIds of topics, of the answers of services, and of housekeeping; {MADE}."]
    for title, ids in (("topics", made.ids.locked_topics), ("services", made.ids.locked_services)):
        lines += [f"{title}:"] if ids else []
        lines += [f"  {json.dumps(name)}: 0x{ids[name]:04X}" for name in sorted(ids)]
    return "\n".join(lines) + "\n"


def _readme(made: Conversion, folder: Path) -> str:
    mission = """
Or fly it on cfepy, which builds it automatically:

    cfepy run mission
"""
    return f"""# {_line(made.task.title)} on cFE

ROS nodes in C++, unmodified, as applications of cFE 7.0.0; {MADE}. `report.md` lists the result for each node.

1. Put this folder into a cFS mission tree as `apps/{folder.name}`.
2. Add the lines of `targets.cmake` to the mission's `targets.cmake`, for instance with
   `include(${{MISSION_SOURCE_DIR}}/apps/{folder.name}/targets.cmake)`.
3. Add the lines of `startup_lines.scr` to the startup script of the processor, before its first `!`.
4. Build as usual: `make SIMULATION=native prep && make && make install`.

`tables/` has the parameters of each node as a table file: put it into `/cf`, and load and activate it to change them.
Convert again after a change of the launch file, of the nodes or of MsgIds, which are compiled in.
{mission if made.task.launch is not None else ""}"""


# -- the report --------------------------------------------------------------------------------------------------------


def report(made: Conversion) -> dict[str, Any]:
    """Return the mapping of nodes and names as plain values."""
    return {
        "made_from": made.task.title,
        "nodes": [_row(node) for node in made.nodes],
        "refused": [{"node": name, "why": why} for name, why in sorted(made.refused.items())],
        "python_nodes": sorted(made.task.scripts),
        "notes": [str(each).replace(f"{made.task.made_from.parent}{os.sep}", "") for each in made.task.notes],
        "topics": {name: f"0x{id_:04X}" for name, id_ in sorted(_topic_ids(made).items())},
        "services": {name: f"0x{id_:04X}" for name, id_ in sorted(made.ids.locked_services.items())},
    }


def _topic_ids(made: Conversion) -> dict[str, int]:
    return {**made.ids.locked_topics, **{name: each.msg_id for name, each in made.ids.topics.items()}}


def _row(node: ConvertedNode) -> dict[str, Any]:
    used = [name for name, _ in node.entry.rows if name and not name.startswith("+")]
    return {
        "node": node.node.full_name,
        "from": origin(node),
        "app": node.node.app,
        "entry": node.entry.symbol,
        "sources": [_place(node, each) for each in node.program.sources],
        "topics": sorted(node.entry.topics),
        "services": sorted(node.entry.services),
        "housekeeping": "" if node.entry.ground is None else f"0x{node.entry.ground.msg_id:04X}",
        "guessed": sorted(name for name, sure in (node.names.topics | node.names.services).items() if not sure),
        "unknown_names": node.names.open,
        "remaps": dict(sorted(node.entry.remaps.items())),
        "parameters": len(used),
        "parameter_rows": len(node.entry.rows),
        "message_types": node.types,
        "libraries_from_outside": node.program.outside,
    }


def report_text(made: Conversion) -> str:
    """Return the report as Markdown."""
    return "\n".join(_report_lines(report(made))) + "\n"


def _report_lines(said: Mapping[str, Any]) -> Iterator[str]:
    yield f"# Conversion of {said['made_from']}"
    yield ""
    yield "| node | from | application | entry point | parameters |"
    yield "|---|---|---|---|---|"
    for row in said["nodes"]:
        count = f"{row['parameters']} in {row['parameter_rows']} rows"
        yield f"| {row['node']} | {row['from']} | {row['app']} | {row['entry']} | {count} |"
    yield ""
    for row in said["nodes"]:
        yield from _node_lines(row)
    for title, key in (("Topics", "topics"), ("Services, by the MsgId of their answers", "services")):
        if said[key]:
            yield f"## {title}"
            yield ""
            yield from (f"- `{name}`: {msg_id}" for name, msg_id in said[key].items())
            yield ""
    if said["python_nodes"]:
        yield f"Nodes in Python, which fly on cfepy only: {', '.join(said['python_nodes'])}."
        yield ""
    yield from (f"- **not converted**: {each['node']}: {each['why']}" for each in said["refused"])
    yield from (f"- note: {each}" for each in said["notes"])


def _node_lines(row: Mapping[str, Any]) -> Iterator[str]:
    yield f"## {row['node']}"
    yield ""
    yield f"- sources: {', '.join(row['sources'])}"
    for title, key in (
        ("topics", "topics"),
        ("services", "services"),
        ("housekeeping", "housekeeping"),
        ("names that a variable holds", "guessed"),
        ("names that are computed, and have no MsgId: write them under `topics:` of a mission file", "unknown_names"),
        ("message types", "message_types"),
        ("libraries from outside, which must be built for cFE", "libraries_from_outside"),
    ):
        if row[key]:
            yield f"- {title}: {row[key] if isinstance(row[key], str) else ', '.join(row[key])}"
    yield from (f"- remap: {one} is {other}" for one, other in row["remaps"].items())
    yield ""
