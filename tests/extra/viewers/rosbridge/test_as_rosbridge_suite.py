"""A client sees the same as with the real rosbridge_websocket and rosapi, whose answers are on record."""

from __future__ import annotations

import json
from base64 import b64encode
from pathlib import Path
from typing import Any

import pytest

from cfepy.mission import spec_of_node
from dev.record.exchanges import RESPONSE, comparable
from tests.extra.viewers.rosbridge.bridged import Client, bridged_mission

DATA = Path(__file__).parents[3] / "data" / "rosbridge" / "exchanges.json"
PEER = Path(__file__).parents[3] / "ros_nodes" / "rosbridge_peer.py"


@pytest.mark.slow
def test_recorded_exchanges_are_reproduced() -> None:
    rows = json.loads(DATA.read_text(encoding="utf-8"))
    assert len(rows) > 140
    with bridged_mission(spec_of_node([str(PEER)])) as run:
        client = run.client()
        while not client.call("/rosapi/service_type", "/t/ready")["type"]:
            run.step()
        last: Any = {}
        unlike = []
        for row in rows:
            for op in row["sent"]:
                client.send(**({**op, "id": last["id"]} if op == RESPONSE else op))
            came = [_answer(client) for _ in row["came"]]
            if not came:  # a late message would arrive in the next step
                client.send(op="call_service", service="/t/ready", id="in between")
                between = _answer(client)
                assert between.get("id") == "in between", (row, between)
            last = came[-1] if came else last
            found = [comparable(each) for each in came]
            if found != row["came"]:
                unlike.append((row["sent"], found, row["came"]))
        client.send(op="call_service", service="/rosapi/get_time", id="last")
        assert _answer(client)["id"] == "last", "more has come than on record"
        assert not unlike
        client.close()


def _answer(client: Client) -> Any:
    """Return the next answer other than a status, which rosbridge_suite does not send."""
    found = client.next()
    while isinstance(found, dict) and found["op"] == "status":
        found = client.next()
    return found if isinstance(found, dict) else {"binary": b64encode(found).decode()}
