"""Write the JSON schemas of mission files, board profiles and fault plans, from the tables of their readers.

`python -m dev.pages.schemas` writes them into `cfepy/cli/run/schemas`, and `cfepy new schema` copies them for editors.
Names, choices and ranges come from the readers, and descriptions from the tables of the documentation. A name without a
shape here, or a shape without a name, is an error.
"""

from __future__ import annotations

import argparse
import json
import re
from collections.abc import Iterable, Mapping
from dataclasses import asdict, fields
from pathlib import Path
from typing import Any

from cfepy.config.platform import COUNTED_BY_ID, IDENTITIES, MAY_BE_ZERO, MOST_ID, SCHEDULINGS, PlatformConfig
from cfepy.config.versions import RELEASES
from cfepy.faults import fault_plan, kinds
from cfepy.mission import cpp_nodes, device_config, drawn_parameters, limits, mission_file, parameter_files
from cfepy.monitors import deadlines, invariants, selected_results
from cfepy.msg import HIGHEST_VALID_MSG_ID, RED, YELLOW
from cfepy.psp import profile
from cfepy.reading.marked_yaml import MOST_SECONDS
from cfepy.units import TIME_UNITS

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "cfepy/cli/run/schemas"
DIALECT = "http://json-schema.org/draft-07/schema#"

Schema = dict[str, Any]

TEXT: Schema = {"type": "string"}
FLAG: Schema = {"type": "boolean"}
SCALAR: Schema = {"type": ["string", "number", "boolean"]}
GLOBAL_NAME: Schema = {"type": "string", "pattern": "^/"}
TEXTS: Schema = {"type": ["object", "null"], "additionalProperties": SCALAR}
TREE: Schema = {"type": ["object", "null"]}
TIME: Schema = {
    "anyOf": [
        {"type": "number", "minimum": 0, "exclusiveMaximum": MOST_SECONDS},
        {"type": "string", "pattern": rf"^\s*[0-9.+][0-9.eE+_-]*\s*({'|'.join(TIME_UNITS)})?\s*$"},
    ],
    "examples": [0.5, "20 ms"],
}
TIME_WITH_UNIT: Schema = {"type": "string", "pattern": f"^{deadlines.TIME.pattern}$", "examples": ["2 ms", "50 Hz"]}
DATE: Schema = {"type": "string", "pattern": r"^\d{4}-\d\d-\d\d", "examples": ["2026-05-01T12:00:00Z"]}
SECONDS: Schema = {"type": "number", "minimum": 0, "maximum": fault_plan.LONGEST_S}
DURATION: Schema = {"type": "number", "exclusiveMinimum": 0, "maximum": fault_plan.LONGEST_S}
POSITIVE: Schema = {"type": "integer", "minimum": 1}


def main() -> None:
    """Write the schemas."""
    argparse.ArgumentParser(prog="python -m dev.pages.schemas", description=__doc__).parse_args()
    FOLDER.mkdir(exist_ok=True)
    for name, text in schemas().items():
        (FOLDER / name).write_text(text, encoding="utf-8")
        print("wrote", (FOLDER / name).relative_to(ROOT))


def schemas() -> dict[str, str]:
    """Return the texts of all schemas, by file name."""
    made = {"mission": mission_schema(), "board": board_schema(), "faults": faults_schema()}
    return {
        f"{name}.schema.json": json.dumps({"$schema": DIALECT, **schema}, indent=1) + "\n"
        for name, schema in made.items()
    }


# -- parts -------------------------------------------------------------------------------------------------------------


def integer(lowest: int = 0, highest: int | None = None) -> Schema:
    """Return the schema of a whole number from `lowest` to `highest`."""
    return {"type": "integer", "minimum": lowest, **({} if highest is None else {"maximum": highest})}


def one_of(choices: Iterable[str]) -> Schema:
    """Return the schema of a text out of a few."""
    return {"enum": list(choices)}


def several(item: Schema) -> Schema:
    """Return the schema of one item or a list of them."""
    return {"anyOf": [item, {"type": "array", "items": item}]}


def named(shape: Schema) -> Schema:
    """Return the schema of a mapping of any names to one shape."""
    return {"type": ["object", "null"], "additionalProperties": shape}


def record(
    known: Iterable[str],
    shapes: Mapping[str, Schema],
    texts: Mapping[str, str] | None = None,
    needed: Iterable[str] = (),
) -> Schema:
    """Return the schema of a mapping with known fields.

    Args:
        known: the names that the reader knows.
        shapes: the schema of each name.
        texts: the description of each name, as far as there is one.
        needed: names that must be there.

    Raises:
        ValueError: names and shapes differ.
    """
    names = list(known)
    if set(names) != set(shapes):
        raise ValueError(f"fields without a shape, or shapes without a field: {sorted(set(names) ^ set(shapes))}")
    described = texts or {}
    properties = {
        name: {**({"description": described[name]} if name in described else {}), **shapes[name]} for name in names
    }
    schema: Schema = {"type": ["object", "null"], "properties": properties, "additionalProperties": False}
    required = list(needed)
    return {**schema, "type": "object", "required": required} if required else schema


def described_in(page: str, heading: str) -> dict[str, str]:
    """Return the descriptions in the first table below a heading: `| field | value | meaning |`.

    Args:
        page: below docs.
        heading: its line.

    Raises:
        ValueError: the page has no such heading.
    """
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    _, found, below = text.partition(f"\n{heading}\n")
    if not found:
        raise ValueError(f"{page} has no heading {heading!r}")
    rows = re.findall(r"^\| *(.+?) *\|.*\| *(.+?) *\|$", below.split("\n#")[0], re.MULTILINE)
    meanings: dict[str, str] = {}
    for names, meaning in rows:
        for name in re.findall(r"`([^`]+)`", names):
            meanings.setdefault(name, _plain(meaning))
    return meanings


def _plain(meaning: str) -> str:
    """Return a cell of a table without Markdown."""
    return re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", meaning).replace("`", "").replace("**", "")


# -- mission files -----------------------------------------------------------------------------------------------------


def mission_schema() -> Schema:
    """Return the schema of a mission file."""
    shapes: dict[str, Schema] = {
        "name": TEXT,
        "board": TEXT,
        "memory": one_of(profile.MEMORIES),
        "cfe_version": one_of(RELEASES),
        "safe": FLAG,
        "scheduling": one_of(SCHEDULINGS),
        "epoch": DATE,
        "compiled": record(mission_file.COMPILED_FIELDS, dict.fromkeys(mission_file.COMPILED_FIELDS, FLAG)),
        "cpp_nodes": _cpp_nodes(),
        "limits": record((limits.NODES, *profile.LIMIT_NAMES), {"nodes": integer(1, limits.MOST_NODES), **_limits()}),
        "nodes": named(_node()),
        "topics": {
            "type": ["object", "null"],
            "propertyNames": GLOBAL_NAME,
            "additionalProperties": record(
                mission_file.TOPIC_FIELDS,
                {"msg_id": integer(1, HIGHEST_VALID_MSG_ID), "raw": FLAG},
                described_in("reference/mission_file.md", "### A topic"),
                ["msg_id"],
            ),
        },
        "params": TREE,
        "params_from": _files(),
        "ordered_sets": FLAG,
        "connection_delay": TIME,
        "ros_bridge": _bridge(),
        "launch": _list(
            {"anyOf": [TEXT, record(mission_file.LAUNCH_FIELDS, {"file": TEXT, "args": TEXTS}, needed=["file"])]}
        ),
        "sweep": _sweep(),
        "dictionary": _list(TEXT),
        "devices": named(_device()),
        "invariants": named(_invariant()),
        "results": named(_result()),
        "deadlines": _deadlines(),
        "inversions": TIME,
    }
    texts = described_in("reference/mission_file.md", "## Fields")
    return {"title": "Mission file of cfepy", **record(mission_file.SECTIONS, shapes, texts)}


def _list(item: Schema) -> Schema:
    return {"type": ["array", "null"], "items": item}


def _device() -> Schema:
    port = {"type": "integer", "minimum": 1, "maximum": device_config.MOST_PORT}
    shapes = {"python": TEXT, "udp": port, "topic": TEXT, "to": SCALAR, "type": one_of(device_config.TOPIC_TYPES)}
    return record(device_config.DEVICE_FIELDS, shapes)


def _files() -> Schema:
    entry = record(parameter_files.FILE_FIELDS, {"file": TEXT, "namespace": TEXT}, needed=["file"])
    return {"anyOf": [TEXT, _list({"anyOf": [TEXT, entry]})]}


def _node() -> Schema:
    shapes: dict[str, Schema] = {
        "name": TEXT,
        "namespace": GLOBAL_NAME,
        "remap": TEXTS,
        "params": TREE,
        "params_from": _files(),
        "args": _list(SCALAR),
        "env": TEXTS,
        "ordered_sets": FLAG,
        "keys": _list({"anyOf": [TEXT, {"type": "number", "minimum": 0}]}),
        "compute": named(TIME),
        "respawn": FLAG,
        "respawn_delay": TIME,
        "required": FLAG,
        "ros": {"enum": [1, 2]},
        "executable": {"type": "string"},
    }
    return record(mission_file.NODE_FIELDS, shapes, described_in("reference/mission_file.md", "### A node"))


def _cpp_nodes() -> Schema:
    capacity = integer(1, cpp_nodes.MOST_ITEMS)
    capacities: Schema = {
        "type": ["object", "null"],
        "properties": dict.fromkeys(cpp_nodes.DEFAULTS, capacity),
        "patternProperties": {"^[^/]+/[^/]+$": named(capacity)},
        "additionalProperties": False,
    }
    ground: dict[str, Schema] = {
        "msg_id": integer(cpp_nodes.LOWEST_GROUND_ID, cpp_nodes.HIGHEST_GROUND_ID),
        "performance_id": integer(0, cpp_nodes.MOST_PERFORMANCE_ID),
    }
    shapes = {
        "profile": one_of(cpp_nodes.PROFILES),
        "arena_bytes": integer(cpp_nodes.SMALLEST_ARENA, cpp_nodes.LARGEST_ARENA),
        "capacities": capacities,
        "ground": {
            "type": ["object", "null"],
            "propertyNames": GLOBAL_NAME,
            "additionalProperties": record(cpp_nodes.GROUND_FIELDS, ground, needed=["msg_id"]),
        },
    }
    return record(cpp_nodes.FIELDS, shapes)


def _bridge() -> Schema:
    packet = record(mission_file.PACKET_FIELDS, {"packet": SCALAR, "raw": FLAG}, needed=["packet"])
    shapes: dict[str, Schema] = {
        "publish": {
            "type": ["object", "null"],
            "propertyNames": GLOBAL_NAME,
            "additionalProperties": {"anyOf": [SCALAR, packet]},
        },
        "subscribe": _list(GLOBAL_NAME),
        "clock": integer(1, mission_file.MOST_CLOCK_HZ),
    }
    return record(mission_file.BRIDGE_FIELDS, shapes)


def _sweep() -> Schema:
    drawn: Schema = {
        "type": "string",
        "pattern": f"^({'|'.join(drawn_parameters.KINDS)}):",
        "examples": ["normal:90,5"],
    }
    shapes = {"rate": _list(TEXT), "topics": _list(GLOBAL_NAME), "draw": named(drawn)}
    return record(mission_file.SWEEP_FIELDS, shapes)


def _invariant() -> Schema:
    source: dict[str, Schema] = {
        "topic": several({"type": "string", "pattern": "^[/*]"}),
        "packet": several({"type": ["string", "integer"]}),
    }
    answer = record(invariants.ANSWER_FIELDS, {**source, "holds": TEXT})
    shapes: dict[str, Schema] = {
        **source,
        "holds": {**TEXT, "examples": ["msg.data < 3"]},
        "when": TEXT,
        "within": TIME,
        "then": answer,
        "again": TIME,
        "eventually": TEXT,
        "limits": one_of((YELLOW, RED)),
        "file": TEXT,
        "function": TEXT,
        "after": TIME,
    }
    return record(invariants.FIELDS, shapes)


def _result() -> Schema:
    compare = one_of(selected_results.COMPARISONS)
    rule = record(selected_results.FIELDS, {"compare": compare, "ignore": _list(TEXT)}, needed=["compare"])
    return {"anyOf": [compare, rule]}


def _deadlines() -> Schema:
    app: dict[str, Schema] = {**dict.fromkeys(deadlines.APP_FIELDS, TIME_WITH_UNIT), "task": TEXT}
    topic = dict.fromkeys(deadlines.TOPIC_FIELDS, TIME_WITH_UNIT)
    texts = described_in("reference/mission_file.md", "### Deadlines")
    shapes = {
        "apps": named(record(deadlines.APP_FIELDS, app, texts)),
        "topics": named(record(deadlines.TOPIC_FIELDS, topic, texts)),
    }
    return record(deadlines.PARTS, shapes)


def _limits() -> dict[str, Schema]:
    """Return the schema of each value of the platform configuration; see `cfepy.psp.profile.read_limit`."""
    usual = asdict(PlatformConfig())
    return {name: {**_limit(name, usual[name]), "default": usual[name]} for name in profile.LIMIT_NAMES}


def _limit(name: str, default: object) -> Schema:
    if isinstance(default, str):
        return TEXT
    if isinstance(default, bool):
        return FLAG
    if isinstance(default, tuple):
        return _list(integer())
    if name in IDENTITIES:
        return integer(0, MOST_ID)
    assert isinstance(default, int)
    lowest = 0 if name in MAY_BE_ZERO else min(1, default)
    return integer(lowest, profile.MOST_OBJECTS if name in COUNTED_BY_ID else profile.MOST_LIMIT)


# -- board profiles ----------------------------------------------------------------------------------------------------


def board_schema() -> Schema:
    """Return the schema of a board profile."""
    units = "|".join(profile.SIZE_UNITS)
    size: Schema = {
        "anyOf": [integer(0, profile.MOST_BYTES), {"type": "string", "pattern": f"^[0-9]+ ({units})$"}],
        "examples": ["512 KiB"],
    }
    region = record(profile.REGION_FIELDS, {"name": TEXT, "size": size, "retained": FLAG}, needed=["name", "size"])
    port = record(
        profile.PORT_FIELDS,
        {"name": TEXT, "address": integer(0, profile.MOST_BYTES), "size": size},
        needed=profile.PORT_FIELDS,
    )
    numbers: dict[str, Schema] = {
        name: size if name in profile.SIZES else {"type": ["integer", "null"], "minimum": 0} for name in profile.NUMBERS
    }
    costs = [each.name for each in fields(profile.MemoryCosts)]
    shapes: dict[str, Schema] = {
        "name": TEXT,
        "description": TEXT,
        **numbers,
        "sram": _list(region),
        "ports": _list(port),
        "memory": one_of(profile.MEMORIES),
        "limits": record(profile.LIMIT_NAMES, _limits()),
        "memory_costs": record(costs, dict.fromkeys(costs, integer())),
    }
    known = [each.name for each in fields(profile.BoardProfile)]
    texts = described_in("reference/board_profiles.md", "## Writing one")
    return {"title": "Board profile of cfepy", **record(known, shapes, texts, ["name"])}


# -- fault plans -------------------------------------------------------------------------------------------------------


def faults_schema() -> Schema:
    """Return the schema of a fault plan."""
    texts = described_in("how_to/faults.md", "## The plan")
    options = {
        name: {**({"description": texts[name]} if name in texts else {}), **OPTIONS[name]}
        for name in fault_plan.READERS
    }
    faults = {"type": "array", "items": {"anyOf": [_fault(name) for name in kinds.KINDS]}}
    return {
        "title": "Fault plan of cfepy",
        "anyOf": [faults, record(("faults",), {"faults": faults}, needed=["faults"])],
        "definitions": options,
    }


def _fault(name: str) -> Schema:
    kind = kinds.KINDS[name]
    options: dict[str, Schema] = {option: {"$ref": f"#/definitions/{option}"} for option in kind.options}
    shapes = {name: _target(kind.strikes), "name": TEXT, **options}
    schema = record((name, "name", *kind.options), shapes, {name: kind.text}, [name])
    return {**schema, "anyOf": [{"required": [each]} for each in kind.needed]} if kind.needed else schema


def _target(strikes: str) -> Schema:
    choices = {kinds.SIGNAL: kinds.SIGNALS, kinds.MEMORY: kinds.MEMORIES, kinds.RESET: kinds.RESETS}
    if strikes in choices:
        return one_of(choices[strikes])
    if strikes in (kinds.SECONDS, kinds.PPM):
        return {"type": "number"}
    if strikes == kinds.MESSAGE:
        return several({"anyOf": [TEXT, integer(1, 0xFFFF)]})
    if strikes == kinds.FILE:
        return GLOBAL_NAME
    return several(TEXT) if strikes == kinds.APP else TEXT


OPTIONS: dict[str, Schema] = {
    "at": several(SECONDS),
    "after": SECONDS,
    "until": SECONDS,
    "number": several(POSITIVE),
    "every": POSITIVE,
    "probability": {"type": "number", "exclusiveMinimum": 0, "maximum": 1},
    "count": POSITIVE,
    "explored": POSITIVE,
    "from": TEXT,
    "to": TEXT,
    "unit": one_of(kinds.UNITS),
    "copies": POSITIVE,
    "by": {"anyOf": [DURATION, {"type": "array", "items": DURATION, "minItems": 2, "maxItems": 2}]},
    "past": POSITIVE,
    "within": DURATION,
    "bits": POSITIVE,
    "bytes": {"type": "object", "minProperties": 1, "additionalProperties": integer(0, 255)},
    "fields": {"type": "object", "minProperties": 1},
    "checksum": one_of(kinds.CHECKSUMS),
    "message": TEXT,
    "task": TEXT,
    "for": DURATION,
    "times": {"type": "number", "exclusiveMinimum": 0, "maximum": 1e6},
    "extra": DURATION,
    "clock": one_of(kinds.CLOCKS),
    "block": TEXT,
    "app": TEXT,
    "object": TEXT,
    "status": TEXT,
}
"""The schema of each option, whose reader is in `cfepy.faults.fault_plan.READERS`."""

if __name__ == "__main__":
    main()
