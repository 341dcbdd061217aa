"""Fault plans as text and as values: reading, errors, writing, and that both are equal."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from cfepy.faults import Fault, FaultPlan, Targets, When, random_plan, read_plan
from cfepy.faults.call_faults import call_name
from cfepy.faults.kinds import KINDS
from cfepy.faults.targets import INTENSITIES
from cfepy.status import UsageError

EVERYTHING = """
faults:
  - {drop: [/a, 0x0883], name: lost, from: A, to: B, probability: 0.25, after: 1, until: 2.5}
  - {duplicate: /a, copies: 3, count: 2, unit: segment}
  - {delay: /a, by: [0.1, 0.2], every: 3}
  - {reorder: /a, past: 2, within: 0.5, number: [1, 4]}
  - {corrupt: /a, bits: 3, at: [1, 2]}
  - {corrupt: "udp:1234", bytes: {"0": 0xFF, "-1": 0}, at: 1}
  - {corrupt: ORDER, fields: {a: 1, b.c: x}, checksum: keep}
  - {crash: [A, B], at: 1}
  - {hang: A, message: /a, number: 3, for: 1}
  - {slow: A, times: 2.5, extra: 0.001, until: 3}
  - {compute: A, task: A.1, message: /a, number: 3, for: 0.5}
  - {stop: A, at: 1}
  - {restart: A, at: 1}
  - {fill: P, at: 1, for: 1}
  - {jump_clock: -2.5, at: 1, clock: ros}
  - {drift_clock: 50}
  - {lose_1hz: tone, count: 3}
  - {corrupt_file: /cf/x.tbl, bits: 2}
  - {corrupt_table: A.T, at: 2}
  - {corrupt_memory: cds, block: A.B, at: 1}
  - {fail: OS_QueuePut, app: A, object: Q, status: OS_ERROR, number: 2}
  - {reset: poweron, at: 1}
"""


def write(folder: Path, text: str) -> Path:
    path = folder / "plan.yaml"
    path.write_text(text, encoding="utf-8")
    return path


def test_every_kind_is_read_and_written(tmp_path: Path) -> None:
    plan = read_plan(write(tmp_path, EVERYTHING))
    assert {fault.kind for fault in plan.faults} == set(KINDS)
    assert read_plan(write(tmp_path, plan.to_yaml())) == plan
    assert FaultPlan.from_dict(plan.to_dict()) == plan
    assert pickle.loads(pickle.dumps(plan)) == plan
    assert plan.faults[0].when == When(after_ns=10**9, until_ns=2_500_000_000, probability=0.25)
    assert plan.faults[0].target == ("/a", "0x0883")
    assert plan.faults[2].options["by"] == (100_000_000, 200_000_000)
    assert [fault.name for fault in plan.faults[:3]] == ["lost", "duplicate-1", "delay-1"]
    assert [fault.name for fault in plan.faults[4:7]] == ["corrupt-1", "corrupt-2", "corrupt-3"]
    assert plan.faults[1].line == 4


def test_list_of_faults_needs_no_key(tmp_path: Path) -> None:
    assert read_plan(write(tmp_path, "- drop: /a")).faults == (Fault("drop", ("/a",), "drop-1"),)


@pytest.mark.parametrize(
    ("text", "line", "says"),
    [
        ("faults:\n  - drop: /a\n  - dropp: /b", 3, "unknown kind of fault 'dropp'; did you mean drop?"),
        ("- {drop: /a, crash: B}", 1, "drop cannot be combined with crash"),
        ("- drop: /a\n  probabilty: 1", 2, "unknown option of drop; did you mean probability?"),
        ("- drop: /a\n  probability: 1.5", 2, "a probability greater than 0 and at most 1"),
        ("- drop: /a\n  probability: 0", 2, "a probability greater than 0"),
        ("- drop: /a\n  after: soon", 2, "must be a number of seconds"),
        ("- drop: /a\n  after: .nan", 2, "must be a number of seconds"),
        ("- drop: /a\n  after: 3\n  until: 3", 3, "must be later than `after`"),
        ("- drop: /a\n  at: 1\n  every: 2", 3, "cannot be combined with at"),
        ("- drop: /a\n  count: 0", 2, "at least 1"),
        ("- drop: 1.5", 1, "must be the name of the message"),
        ("- drop: []", 1, "missing target"),
        ("- drop: /a\n  unit: packet", 2, "expected message or segment"),
        ("- delay: /a", 1, "delay requires by, such as `by: 0.01`"),
        ("- delay: /a\n  by: [2, 1]", 2, "must be a shortest and a longest time"),
        ("- crash: A", 1, "crash requires at, after, until"),
        ("- slow: A", 1, "slow requires times or extra"),
        ("- {corrupt: /a, bits: 1, bytes: {'1': 2}}", 1, "cannot be combined with bits"),
        ("- corrupt: /a\n  bytes: {'1': 256}", 2, "at most 255"),
        ("- corrupt: /a\n  bytes: {x: 2}", 2, "invalid position 'x'; expected a whole number"),
        ("- corrupt: /a\n  fields: 3", 2, "must be a mapping of fields"),
        ("- {reset: hard, at: 1}", 1, "processor, poweron, exception or watchdog"),
        ("- {jump_clock: 0, at: 1}", 1, "a number other than 0"),
        ("- jump_clock: 5", 1, "jump_clock requires at"),
        ("- {corrupt_file: x.tbl}", 1, "a path of the virtual file system"),
        ("- {fail: OS_QueuePutt}", 1, "did you mean os.queue_put?"),
        ("- {fail: queue_put}", 1, "invalid call"),
        ("- fail: os.write\n  status: OS_WRONG", 2, "unknown status"),
        ("- fail: os.write\n  status: OS_QUEUE_FUL", 2, "unknown status 'OS_QUEUE_FUL'; did you mean OS_QUEUE_FULL?"),
        ("- {fail: oss.write}", 1, "did you mean os.write?"),
        ("- drop: /a\n  until: 2024-01-01", 2, "must be a number of seconds, such as 2.5, not the date 2024-01-01"),
        ("- {drop: /a, form: B}", 1, "unknown option of drop; did you mean from?"),
        ("- {drop: 'udp:1', to: A}", 1, "to is not an option of faults of datagrams"),
        ("- {drop: ['udp:1', /a]}", 1, "messages cannot be combined with datagrams"),
        ("- {drop: /a, name: x}\n- {drop: /a, name: x}", 2, "the name 'x' is already used by another fault"),
        ("faults: 3", 1, "must be a list"),
        ("{}", 1, "missing faults"),
        ("", 1, "missing faults"),
        ("fauls: []", 1, "unknown field"),
        ("- 3", 1, "must be a mapping"),
        ("- {fill: [A, B], at: 1}", 1, "takes one target"),
    ],
)
def test_mistakes_in_a_plan_are_reported_with_line_and_remedy(tmp_path: Path, text: str, line: int, says: str) -> None:
    path = write(tmp_path, text)
    with pytest.raises(UsageError) as caught:
        read_plan(path)
    assert says in str(caught.value)
    assert (caught.value.file, caught.value.line) == (str(path), line)


def test_all_mistakes_of_a_plan_are_raised_together(tmp_path: Path) -> None:
    text = """\
faults:
- {dorp: /a}
- {drop: /b, evry: 2, count: x, probability: 3}
- {crash: [3, B], at: [x, 1, y]}
- {delay: /a}
- {corrupt: /a, bytes: {a: 1, "2": 300}}
- {drop: /a, name: n}
- {drop: /a, name: n}
fault: []
"""
    with pytest.raises(UsageError) as caught:
        read_plan(write(tmp_path, text))
    fields = "faults[0].dorp faults[1].evry faults[1].count faults[1].probability faults[2].crash[0] faults[2].at[0] "
    fields += "faults[2].at[2] faults[3] faults[4].bytes.a faults[4].bytes.2 faults[6] fault"
    assert [error.field for error in caught.value.each] == fields.split()


def test_missing_file_and_invalid_yaml_are_refused(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="cannot be read"):
        read_plan(tmp_path / "none.yaml")
    with pytest.raises(UsageError, match="is not YAML"):
        read_plan(write(tmp_path, "faults: ["))


def test_nasas_names_of_calls() -> None:
    assert call_name("OS_QueuePut") == call_name("os.queue_put") == call_name("cfe.os.queue_put") == "os.queue_put"
    assert call_name("CFE_ES_GetPoolBuf") == "es.get_pool_buf"
    assert call_name("CFE_SB_TransmitMsg") == "sb.transmit_msg"
    assert call_name("OS_MutSemCreate") == "os.mut_sem_create"
    assert call_name("CFE_PSP_WriteToCDS") == "psp.write_to_cds"
    assert call_name("OS_write") == "os.write"


NAMES = st.lists(st.sampled_from(["A", "B", "/t", "HK.T"]), unique=True, max_size=3).map(tuple)
TARGETS: Any = st.builds(
    Targets,
    apps=NAMES,
    messages=st.lists(st.tuples(st.sampled_from(["/a", "/b", "X"]), st.integers(1, 5000)), max_size=3).map(tuple),
    pipes=NAMES,
    tables=NAMES,
    files=st.just(("/cf/x.tbl",)),
)


@settings(max_examples=30)
@given(st.integers(0, 2**64), TARGETS, st.sampled_from(sorted(INTENSITIES)))
def test_random_plans_are_valid(seed: int, targets: Targets, intensity: str) -> None:
    plan = random_plan(seed, targets, intensity)
    assert plan == random_plan(seed, targets, intensity)
    assert len(plan.faults) == INTENSITIES[intensity]
    assert FaultPlan.from_dict(yaml.safe_load(plan.to_yaml())) == plan
