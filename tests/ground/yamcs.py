"""A real Yamcs that reads our XTCE, configured as in docs/how_to/ground_tools.md.

The variable CFEPY_YAMCS names the folder of an installed one, with `lib` and `bin/yamcsd`. The tests use its HTTP API
(https://docs.yamcs.org/yamcs-http-api/).
"""

from __future__ import annotations

import base64
import json
import os
import shutil
import struct
import subprocess
import urllib.error
import urllib.request
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from tests.ground.page import blocks

VARIABLE = "CFEPY_YAMCS"
INSTALLED = Path(os.environ.get(VARIABLE, "/nowhere"))
URL = "http://127.0.0.1:8090/api"
LAB = "lab"
TM_PORT, TC_PORT = 1235, 1234
_STARTED = "Yamcs started in"
_VALUES = {
    "UINT32": "uint32Value",
    "SINT32": "sint32Value",
    "UINT64": "uint64Value",
    "SINT64": "sint64Value",
    "FLOAT": "floatValue",
    "DOUBLE": "doubleValue",
    "STRING": "stringValue",
    "BOOLEAN": "booleanValue",
    "ENUMERATED": "stringValue",
    "BINARY": "binaryValue",
}


def is_installed() -> bool:
    """Return whether there is a Yamcs."""
    return (INSTALLED / "bin/yamcsd").exists()


def install(home: Path) -> None:
    """A Yamcs of one's own in a folder, with the files of the page and no mission database yet."""
    for name in ("bin", "etc", "mdb"):
        (home / name).mkdir(parents=True)
    shutil.copy(INSTALLED / "bin/yamcsd", home / "bin")
    (home / "lib").symlink_to(INSTALLED.resolve() / "lib")
    files = [block.text for block in blocks("Yamcs") if block.language == "yaml"]
    for name, text in zip(("yamcs.yaml", f"yamcs.{LAB}.yaml", "processor.yaml"), files, strict=True):
        (home / "etc" / name).write_text(text, encoding="utf-8")


def add_instances(home: Path, names: Iterable[str]) -> None:
    """Give it other instances than the page's, each with its links at ports of its own (`ports_of`)."""
    names, page = list(names), (home / f"etc/yamcs.{LAB}.yaml").read_text(encoding="utf-8")
    server = home / "etc/yamcs.yaml"
    server.write_text(
        server.read_text(encoding="utf-8").replace(f"instances: [{LAB}]", f"instances: {json.dumps(names)}"),
        encoding="utf-8",
    )
    for number, name in enumerate(names):
        tm_port, tc_port = ports_of(number)
        text = page.replace(f"mdb/{LAB}.xml", f"mdb/{name}.xml")
        text = text.replace(f"port: {TM_PORT}", f"port: {tm_port}").replace(f"port: {TC_PORT}", f"port: {tc_port}")
        (home / f"etc/yamcs.{name}.yaml").write_text(text, encoding="utf-8")


def ports_of(number: int) -> tuple[int, int]:
    """Return the port of an instance's telemetry, and the port of its commands."""
    return 13_000 + number, 14_000 + number


@contextmanager
def running(home: Path) -> Iterator[None]:
    """The server, from when it has started."""
    [[command]] = [block.commands for block in blocks("Yamcs") if block.text.startswith("bin/")]
    with (
        subprocess.Popen(command, cwd=home, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as process,
        (home / "log").open("w") as log,
    ):
        assert process.stdout is not None
        said: list[str] = []
        try:
            for line in process.stdout:
                said.append(line)
                if _STARTED in line:
                    break
            assert process.poll() is None, "".join(said)
            copying = subprocess.Popen(["cat"], stdin=process.stdout, stdout=log)  # or it would wait for a reader
            yield
            process.terminate()
            copying.wait()
        finally:
            process.kill()


def call(path: str, body: Mapping[str, Any] | None = None) -> Any:
    """Send it a request, as JSON. Returns the answer.

    Raises:
        AssertionError: it refused; the text is its answer.
    """
    data = None if body is None else json.dumps(body).encode()
    request = urllib.request.Request(URL + path, data, {"Content-Type": "application/json"})
    try:
        with urllib.request.urlopen(request) as answer:
            return json.load(answer)
    except urllib.error.HTTPError as error:
        raise AssertionError(f"{path}: {error.read().decode()}") from None


def value_of(said: Mapping[str, Any]) -> object:
    """Return a value of a parameter from its JSON, in which floats are as short as possible."""
    kind = said["type"]
    value = said[_VALUES[kind]]
    if kind in ("UINT64", "SINT64"):
        return int(value)
    if kind == "FLOAT":
        return struct.unpack("<f", struct.pack("<f", float(value)))[0]
    if kind == "BINARY":
        return base64.b64decode(value)
    return float(value) if kind == "DOUBLE" else value


def parameters(instance: str, names: Iterable[str]) -> dict[str, object]:
    """Return the newest values of parameters, by name; missing ones are left out.

    Args:
        instance: instance of the server.
        names: with their space system, such as "/lab/SRC_SEQ_CTR".
    """
    ids = [{"name": name} for name in names]
    said = call(f"/processors/{instance}/realtime/parameters:batchGet", {"id": ids, "fromCache": True})
    return {each["id"]["name"]: value_of(each["engValue"]) for each in said.get("value", ())}
