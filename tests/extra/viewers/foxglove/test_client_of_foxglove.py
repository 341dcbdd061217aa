"""Foxglove's own client library, run by node, with a robot that runs in real time."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.extra.viewers.robot import PATIENCE_S, robot

CLIENT = Path(__file__).with_name("ws_protocol_client.js")
PACKAGES = (
    "@foxglove/ws-protocol@0.8.0",
    "@foxglove/rosmsg@5.0.5",
    "@foxglove/rosmsg-serialization@2.0.4",
    "ws@8.18.3",
)
CAN_RUN = shutil.which("node") is not None and shutil.which("npm") is not None
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not CAN_RUN, reason="needs node and npm: install the package npm"),
]


@pytest.fixture(scope="module")
def packages(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of the packages. Their install scripts do not run."""
    folder = tmp_path_factory.mktemp("packages")
    install = ["npm", "install", "--silent", "--no-fund", "--no-audit", "--ignore-scripts", "--prefix", str(folder)]
    subprocess.run([*install, *PACKAGES], cwd=folder, check=True, timeout=4 * PATIENCE_S)
    return folder / "node_modules"


def test_foxgloves_own_client_sees_decodes_sets_publishes_and_calls(tmp_path: Path, packages: Path) -> None:
    journal = tmp_path / "run.cfepy"
    with robot(tmp_path, "--record", str(journal), "--quiet", server="--foxglove") as port:
        client = ["node", str(CLIENT), f"ws://127.0.0.1:{port}/"]
        environ = {**os.environ, "NODE_PATH": str(packages)}
        done = subprocess.run(client, capture_output=True, text=True, env=environ, timeout=4 * PATIENCE_S)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout) == {
        "protocols": ["foxglove.websocket.v1", "foxglove.sdk.v1", "Unexpected server response: 400"],
        "capabilities": ["clientPublish", "connectionGraph", "parameters", "parametersSubscribe", "services", "time"],
        "channel": ["ros1", "ros1msg", "std_msgs/String"],
        "fields": ["string data"],
        "chatter": "first",
        "numbers": ["Float64Array", "1.5", "NaN", "-2"],
        "log": ["json", "jsonschema", "foxglove.Log"],
        "speed": [{"name": "/speed", "value": 3}],
        "faster": [{"name": "/speed", "value": 4}],
        "loud": "LOUD",
        "event": "CFE_ES",
        "on": {"success": True, "message": "on"},
        "off": "error processing request: off is not possible",
        "publishers": ["/robot"],
        "time": "bigint",
        "errors": [],
    }
    replay = [sys.executable, "-m", "cfepy", "replay", str(journal), "--quiet"]
    again = subprocess.run(replay, capture_output=True, text=True, timeout=4 * PATIENCE_S)
    assert "the same run as" in again.stderr, again.stderr
