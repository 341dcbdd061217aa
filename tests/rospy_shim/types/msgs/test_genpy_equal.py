"""Every built-in message and service type against real genpy: generated values, their bytes and texts, the md5sums.

It needs the genpy of Debian (python3-genpy), and reports if it is missing. Classes are made there from our own
definitions, so none of Debian's message packages has to be installed. The recorded md5sums of `test_golden` show that
the definitions are ROS's.
"""

from __future__ import annotations

import json
import subprocess
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, Phase, given, settings

from rospy_shim.types.msgs import message_class, service_class, shipped
from tests.rospy_shim.golden_msgs import build
from tests.rospy_shim.types.msgs.values import plain

ROS_PYTHON = "/usr/bin/python3"
PEER = Path(__file__).parent / "genpy_batch.py"
SERVICES = [f"{package}/{name}" for package in shipped().packages() for name in shipped().names(package, "srv") or ()]
MESSAGES = [f"{package}/{name}" for package in shipped().packages() for name in shipped().names(package) or ()]
PARTS = ("Request", "Response")
TYPES = list(dict.fromkeys([*MESSAGES, *(name + part for name in SERVICES for part in PARTS)]))
GROUP = 8  # types in one file, which is about the quickest
SHARES = 8  # of all types, so that several processes have work


@cache
def has_genpy() -> bool:
    try:
        return (
            subprocess.run([ROS_PYTHON, "-c", "import genpy.dynamic"], capture_output=True, check=False).returncode == 0
        )
    except OSError:
        return False


def values_of(name: str, count: int) -> list[Any]:
    """Return `count` generated values of a type, the same in every run. The first one is all zeros."""
    found: list[Any] = []
    how = settings(
        max_examples=count,
        phases=[Phase.generate],
        derandomize=True,
        database=None,
        deadline=None,
        suppress_health_check=list(HealthCheck),
    )

    @how
    @given(plain(name))
    def collect(value: Any) -> None:
        found.append(value)

    collect()
    return found


def with_nested(names: Sequence[str]) -> list[str]:
    """Types, and all types in them."""
    found = dict.fromkeys(names)
    waiting = list(names)
    while waiting:
        nested = [name for name in shipped().spec(waiting.pop()).message_types if name not in found]
        found.update(dict.fromkeys(nested))
        waiting += nested
    return list(found)


def ask(values: dict[str, list[Any]], services: Sequence[str]) -> dict[str, Any]:
    """Return the answer of real genpy, in one process."""
    library, names = shipped(), list(values)
    known = with_nested([*names, *(name + part for name in services for part in PARTS)])
    request = {
        "groups": [with_nested(names[at : at + GROUP]) for at in range(0, len(names), GROUP)],
        "texts": {name: library.full_text(name).partition("\n" + "=" * 80)[0] for name in known},
        "services": {name: library.text(name, "srv") for name in services},
        "values": values,
    }
    done = subprocess.run(
        [ROS_PYTHON, str(PEER)], input=json.dumps(request), capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr[-2000:]
    answers: dict[str, Any] = json.loads(done.stdout)
    return answers


def compare(names: Sequence[str], services: Sequence[str], count: int) -> None:
    if not has_genpy():
        pytest.skip(f"{ROS_PYTHON} has no genpy (Debian: python3-genpy); recorded bytes are compared all the same")
    values = {name: values_of(name, count) for name in names}
    theirs = ask(values, services)
    library = shipped()
    for name in names:
        cls = message_class(name)
        assert cls._md5sum == theirs["md5sums"][name], name
        for value, answer in zip(values[name], theirs["answers"][name], strict=True):
            message = build(library, name, value)
            octets = message.__pack__()
            ours = {"hex": octets.hex(), "again": cls.__unpack__(octets).__pack__().hex(), "text": str(message)}
            assert ours == answer, f"{name}: {value}"
    assert {name: service_class(name)._md5sum for name in services} == theirs["services"]


def test_sixtieth_of_all_types_equals_genpy() -> None:
    compare(TYPES[::60], SERVICES[::60], count=3)


@pytest.mark.slow
@pytest.mark.parametrize("part", range(SHARES))
def test_all_types_equal_genpy_with_several_values(part: int) -> None:
    assert len(TYPES) > 700
    compare(TYPES[part::SHARES], SERVICES[part::SHARES], count=4)
