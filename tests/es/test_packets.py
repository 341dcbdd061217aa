"""The packets of Executive Services have NASA's layouts, and what stands in them is true."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.es import packets as pk
from cfepy.msg import Layout
from tests.es.harness import Lab
from tests.layouts import assert_same


def test_layouts_are_nasas() -> None:
    assert_same(pk.HOUSEKEEPING, "CFE_ES_HousekeepingTlm_Payload_t")
    assert_same(pk.APP_INFO, "CFE_ES_AppInfo_t")
    assert_same(pk.POOL_STATS, "CFE_ES_MemPoolStats_t")
    assert_same(pk.START_APP_COMMAND, "CFE_ES_StartAppCmd_Payload_t")
    assert_same(pk.APP_RELOAD_COMMAND, "CFE_ES_AppReloadCmd_Payload_t")


def test_housekeeping(tmp_path: Path) -> None:
    lab = Lab(tmp_path, one=lambda cfe: cfe.os.task_delay(10**6))
    lab.start("one")
    lab.mission.run(1)
    values = sent(lab, pk.SEND_HK_MID, 0, b"", pk.HK_TLM_MID, pk.HOUSEKEEPING)
    assert values["CFEMajorVersion"] == values["OSALMajorVersion"] == values["PSPMajorVersion"] == 7
    assert (values["RegisteredCoreApps"], values["RegisteredExternalApps"]) == (5, 1)
    assert values["RegisteredTasks"] == sum(len(app.tasks) for app in lab.es.apps)
    assert values["SysLogBytesUsed"] == lab.es.syslog.bytes_used
    assert (values["ResetType"], values["ResetSubtype"], values["MaxProcessorResets"]) == (2, 1, 2)
    lab.mission.close()


def test_query_one(tmp_path: Path) -> None:
    lab = Lab(tmp_path, one=lambda cfe: cfe.os.task_delay(10**6))
    app_id = lab.start("one", exception_action=1, priority=77)
    lab.mission.run(1)
    name = pk.APP_NAME_COMMAND.pack(Application="ONE")
    values = sent(lab, pk.CMD_MID, pk.QUERY_ONE_CC, name, pk.APP_TLM_MID, pk.APP_INFO)
    assert (values["ResourceId"], values["Name"], values["MainTaskName"]) == (app_id, "ONE", "ONE")
    assert (values["ExceptionAction"], values["Priority"], values["StackSize"]) == (1, 77, 8192)
    assert (values["FileName"], values["EntryPoint"]) == ("/cf/one.so", "one_main")
    lab.mission.close()


def sent(lab: Lab, msg_id: int, code: int, payload: bytes, answer: int, layout: Layout) -> dict[str, object]:
    """What the answer to a command says."""
    got: list[bytes] = []

    def listen(pipe: int) -> None:
        packet = lab.cfe.sb.receive_buffer(pipe, 1000)
        assert packet is not None
        got.append(packet)

    pipe = lab.cfe.sb.create_pipe(3, "LISTENER")
    lab.cfe.sb.subscribe(answer, pipe)
    lab.mission.kernel.spawn("listener", lambda: listen(pipe))
    lab.cfe.sb.transmit_msg(bytes(lab.cfe.msg.command(msg_id, code, payload)))
    lab.mission.run(1)
    assert got[0][0] << 8 | got[0][1] == answer
    return layout.unpack(got[0], 16)


@pytest.mark.parametrize(("kind", "name"), [(1, "PROCESSOR"), (2, "POWERON")])
def test_a_commanded_reset_ends_the_run_as_what_was_asked_for(tmp_path: Path, kind: int, name: str) -> None:
    lab = Lab(tmp_path)
    payload = pk.RESTART_COMMAND.pack(RestartType=kind)
    lab.cfe.sb.transmit_msg(bytes(lab.cfe.msg.command(pk.CMD_MID, pk.RESTART_CC, payload)))
    lab.mission.run(1)
    assert f"CFE_PSP: Exiting cFE with {name} Reset status." in lab.lines
    assert lab.mission.reset_reason == f"{name} RESET (Commanded)"
    lab.mission.close()
