"""`cfepy new schema`: the schemas describe the files that the readers accept, and no others."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

import jsonschema
import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from cfepy.cli.main import main
from cfepy.faults import read_plan
from cfepy.faults.fault_plan import FaultPlan
from cfepy.faults.kinds import KINDS
from cfepy.mission.mission_file import NODE_FIELDS, SECTIONS, read_mission_file
from cfepy.monitors.run_rules import read_demands
from cfepy.psp import load_profile
from cfepy.psp.profile import BoardProfile
from cfepy.reading.marked_yaml import Marked
from cfepy.reading.mistakes import Mistakes
from cfepy.status import UsageError
from dev.pages.schemas import FOLDER, schemas

ROOT = Path(__file__).parents[2]
SCHEMAS = {name.split(".")[0]: json.loads(text) for name, text in schemas().items()}
VALIDATORS = {name: jsonschema.Draft7Validator(schema) for name, schema in SCHEMAS.items()}


def test_shipped_schemas_are_current() -> None:
    texts = {path.name: path.read_text(encoding="utf-8") for path in FOLDER.iterdir()}
    assert texts == schemas(), "run `python -m dev.pages.schemas`"


@pytest.mark.parametrize("name", SCHEMAS)
def test_schema_is_valid_draft_7(name: str) -> None:
    jsonschema.Draft7Validator.check_schema(SCHEMAS[name])


@pytest.mark.parametrize("name", SCHEMAS)
def test_reference_of_a_schema_stays_inside_it(name: str) -> None:
    references = [each.split('"')[0] for each in json.dumps(SCHEMAS[name]).split('"$ref": "')[1:]]
    known = SCHEMAS[name].get("definitions", {})
    assert all(each.removeprefix("#/definitions/") in known for each in references)


def files_of(pattern: str) -> list[Path]:
    folders = ("missions", "examples", "boards", "tests/data")
    return sorted(path for folder in folders for path in (ROOT / folder).rglob(pattern))


@pytest.mark.parametrize(
    "path", [*files_of("mission.yaml"), *files_of("flight.yaml")], ids=lambda path: path.parent.name
)
def test_mission_files_of_the_repository_match_the_schema(path: Path) -> None:
    VALIDATORS["mission"].validate(yaml.safe_load(path.read_text(encoding="utf-8")))


@pytest.mark.parametrize("path", sorted((ROOT / "boards").glob("*.yaml")), ids=lambda path: path.stem)
def test_boards_of_the_repository_match_the_schema(path: Path) -> None:
    VALIDATORS["board"].validate(yaml.safe_load(path.read_text(encoding="utf-8")))


# -- readers and schemas agree -----------------------------------------------------------------------------------------


def mission_is_accepted(text: str, folder: Path) -> bool:
    """Return whether the readers of a mission file accept it."""
    (folder / "mission.yaml").write_text(text, encoding="utf-8")
    mistakes = Mistakes()
    sections = read_mission_file(folder / "mission.yaml", mistakes)
    read_demands(sections.demands, mistakes)
    return not mistakes.errors


def as_an_editor_has_it(text: str) -> Any:
    """Return a file's values; a date is text, as in YAML 1.2."""
    return json.loads(json.dumps(yaml.safe_load(text), default=lambda date: date.isoformat()))


def is_read(read: Callable[[Path], object], text: str, folder: Path) -> bool:
    """Return whether a reader of a file accepts it."""
    (folder / "file.yaml").write_text(text, encoding="utf-8")
    try:
        read(folder / "file.yaml")
    except UsageError:
        return False
    return True


MISSIONS = {
    "name: rover": True,
    "name: 3": False,
    "names: rover": False,
    'cfe_version: "7.0.0"': True,
    "cfe_version: 7.0": False,
    "epoch: 2026-05-01T12:00:00Z": True,
    "epoch: 2026-05-01": True,
    "epoch: tomorrow": False,
    "compiled: {guard: true}": True,
    "compiled: {guard: 1}": False,
    "cpp_nodes: {profile: strict, capacities: {text: 3, demo/Scan: {name: 4}}}": True,
    "cpp_nodes: {profile: small}": False,
    "cpp_nodes: {arena_bytes: 1}": False,
    "cpp_nodes: {capacities: {Scan: {name: 4}}}": False,
    "limits: {nodes: 5, es_max_libraries: 12, time_cfg_client: true, tbl_valid_scid: [1]}": True,
    "limits: {nodes: 0}": False,
    "limits: {es_max_applications: 0}": False,
    "limits: {es_max_apps: 3}": False,
    "limits: {time_cfg_client: 1}": False,
    "nodes: {ARM: {namespace: /a, remap: {b: c}, keys: [w, 2.0], compute: {/scan: 4 ms}, args: [--x]}}": True,
    "nodes: {ARM: {namespace: a}}": False,
    "nodes: {ARM: {env: {MODEL: 3, DEBUG: true}}}": True,
    "nodes: {ARM: {env: {MODEL: [3]}}}": False,
    "nodes: {ARM: {remap: {scan: }}}": False,
    "nodes: {ARM: {args: [{a: b}]}}": False,
    "nodes: {ARM: {keys: [-1]}}": False,
    "nodes: {ARM: {respawn: maybe}}": False,
    "nodes: {ARM: {compute: {/scan: 4 hours}}}": False,
    "topics: {/a: {msg_id: 0x0901, raw: true}}": True,
    "topics: {a: {msg_id: 0x0901}}": False,
    "topics: {/a: {raw: true}}": False,
    "topics: {/a: {msg_id: 0x2000}}": False,
    "params: {a: {b: [1, 2.5, x]}}": True,
    "params: [1]": False,
    "connection_delay: 50 ms": True,
    "connection_delay: .5": True,
    "connection_delay: fast": False,
    "connection_delay: -1": False,
    "ros_bridge: {publish: {/hk: CFE_ES_HK_TLM}, subscribe: [/cmd], clock: 100}": True,
    "ros_bridge: {clock: 2000}": False,
    "ros_bridge: {publish: {/hk: {raw: true}}}": False,
    "ros_bridge: {publish: {/hk: [CFE_ES_HK_TLM]}}": False,
    "sweep: {rate: [/arm/rate], topics: [/odom]}": True,
    "sweep: {topics: [odom]}": False,
    "sweep: {draw: {/left/rate: 'uniform:80,120'}}": True,
    "sweep: {draw: {/left/rate: 'evenly:80,120'}}": False,
    "invariants: {near: {topic: /scan, holds: msg.range > 0.2}}": True,
    "invariants: {near: {topic: scan, holds: msg.range > 0.2}}": False,
    "invariants: {near: {topic: /scan, hold: msg.range > 0.2}}": False,
    "invariants: {cold: {packet: HEATER_HK_TLM, limits: red}}": True,
    "invariants: {cold: {packet: HEATER_HK_TLM, limits: orange}}": False,
    "invariants: {answer: {topic: /a, within: 0.5 s, then: {topic: /b}}}": True,
    "results: {/odom: last}": True,
    "results: {/odom: {compare: last, ignore: [header.stamp]}}": True,
    "results: {/odom: newest}": False,
    "deadlines: {apps: {ARM: {response: 2 ms}}, topics: {/a: {latency: 1 ms, at_most_every: 5 Hz}}}": True,
    "deadlines: {apps: {ARM: {response: 2}}}": False,
    "deadlines: {topics: {/a: {late: 1 ms}}}": False,
    "inversions: 1 ms": True,
    "inversions: [1]": False,
    "launch: demo.launch": False,
}


@pytest.mark.parametrize("text", MISSIONS)
def test_mission_schema_agrees_with_the_readers(text: str, tmp_path: Path) -> None:
    assert mission_is_accepted(text, tmp_path) == MISSIONS[text]
    assert VALIDATORS["mission"].is_valid(as_an_editor_has_it(text)) == MISSIONS[text]


BOARDS = {
    "{name: a, cpu_hz: 100, sram: [{name: b, size: 4 KiB, retained: true}], limits: {sb_max_pipes: 4}}": True,
    "{cpu_hz: 100}": False,
    "{name: a, cpu_hz: fast}": False,
    "{name: a, sram: [{name: b}]}": False,
    "{name: a, sram: [{name: b, size: 4 KB}]}": False,
    "{name: a, ports: [{name: b, address: 1, size: 4}], memory_costs: {mutex: 10}}": True,
    "{name: a, memory_costs: {mutexes: 10}}": False,
    "{name: a, limits: {sb_max_pipes: 0}}": False,
}


@pytest.mark.parametrize("text", BOARDS)
def test_board_schema_agrees_with_the_reader(text: str, tmp_path: Path) -> None:
    assert is_read(load_profile, text, tmp_path) == BOARDS[text]
    assert VALIDATORS["board"].is_valid(yaml.safe_load(text)) == BOARDS[text]


PLANS = {
    "faults: [{drop: /odom, probability: 0.1, after: 4, until: 5}]": True,
    "[{drop: [/odom, 0x0883], number: [1, 5]}]": True,
    "faults: [{drop: /odom, probability: 2}]": False,
    "faults: [{dropp: /odom}]": False,
    "faults: [{drop: /odom, by: 0.1}]": False,
    "faults: [{delay: /odom}]": False,
    "faults: [{delay: /odom, by: [0.01, 0.02]}]": True,
    "faults: [{hang: ARM, at: 6, for: 0.5}]": True,
    "faults: [{reset: processor, at: 8}]": True,
    "faults: [{reset: board, at: 8}]": False,
    "faults: [{jump_clock: -2.5, at: 1, clock: cfe}]": True,
    "faults: [{corrupt_file: /cf/a.tbl, bytes: {'16': 255}}]": True,
    "faults: [{corrupt_file: a.tbl}]": False,
    "faults: [{corrupt: /odom, checksum: keep, bits: 2}]": True,
    "fault: []": False,
}


@pytest.mark.parametrize("text", PLANS)
def test_fault_schema_agrees_with_the_reader(text: str, tmp_path: Path) -> None:
    assert is_read(read_plan, text, tmp_path) == PLANS[text]
    assert VALIDATORS["faults"].is_valid(yaml.safe_load(text)) == PLANS[text]


scalars = (
    st.none()
    | st.booleans()
    | st.integers(-2, 1 << 34)
    | st.floats(-1, 1e10, allow_nan=False)
    | st.sampled_from(["", "/a", "a", "3 ms", "1.5s", "512 KiB", "7.0.1", "last", "strict", "processor", "5 Hz"])
)
names = st.sampled_from(["a", "/a", "file", "msg_id", "packet", "name", "size", "compare", "topic", "holds", "rate"])
values = st.recursive(scalars, lambda inner: st.lists(inner, max_size=2) | st.dictionaries(names, inner, max_size=2))


def marked(value: Any) -> Marked:
    inner = value
    if isinstance(value, Mapping):
        inner = {name: marked(item) for name, item in value.items()}
    elif isinstance(value, list):
        inner = [marked(item) for item in value]
    return Marked(inner, Path("mission.yaml"), 1, "x")


@given(st.sampled_from(sorted(NODE_FIELDS)), values)
def test_schema_accepts_each_field_of_a_node_that_the_reader_accepts(name: str, value: Any) -> None:
    mistakes = Mistakes()
    mistakes.attempt(partial(NODE_FIELDS[name], marked(value)))
    if not mistakes.errors:
        VALIDATORS["mission"].validate({"nodes": {"ARM": {name: value}}})


@given(st.sampled_from(sorted(KINDS)), values, st.dictionaries(st.sampled_from(["at", "by", "for", "count"]), values))
def test_schema_accepts_each_fault_that_the_reader_accepts(kind: str, target: Any, options: dict[str, Any]) -> None:
    plan = {"faults": [{kind: target, **options}]}
    try:
        FaultPlan.from_dict(plan)
    except UsageError:
        return
    VALIDATORS["faults"].validate(plan)


# -- the command -------------------------------------------------------------------------------------------------------


def test_command_writes_the_schemas_and_the_line_for_the_editor(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["new", "schema"]) == 0
    assert {path.name: path.read_text(encoding="utf-8") for path in (tmp_path / "schemas").iterdir()} == schemas()
    assert "  # yaml-language-server: $schema=schemas/mission.schema.json" in capsys.readouterr().out.splitlines()


def test_folder_that_cannot_be_made_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "taken").write_text("", encoding="utf-8")
    assert main(["new", "schema", str(tmp_path / "taken")]) == 2
    assert "FOLDER" in capsys.readouterr().err


def test_every_section_has_a_description() -> None:
    described = SCHEMAS["mission"]["properties"]
    assert [name for name in SECTIONS if "description" not in described[name]] == []
    assert [name for name in BoardProfile.__slots__ if "description" not in SCHEMAS["board"]["properties"][name]] == []
