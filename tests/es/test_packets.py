"""The packets of Executive Services have NASA's layouts, and their contents are true."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from cfepy.es import packets as pk
from cfepy.msg import Telemetry
from tests.es.harness import Lab
from tests.layouts import DATA, assert_same

RECORDED = json.loads((DATA / "packets.json").read_text(encoding="utf-8"))["telemetry"]


def test_layouts_match_nasas_structures() -> None:
    assert_same(pk.HOUSEKEEPING, "CFE_ES_HousekeepingTlm_Payload_t")
    assert_same(pk.APP_INFO, "CFE_ES_AppInfo_t")
    assert_same(pk.TASK_INFO, "CFE_ES_TaskInfo_t")
    assert_same(pk.POOL_STATS, "CFE_ES_MemPoolStats_t")
    assert_same(pk.ER_LOG_FILE_ENTRY, "CFE_ES_ERLog_FileEntry_t")
    assert_same(pk.CDS_REG_DUMP_RECORD, "CFE_ES_CDSRegDumpRec_t")
    assert_same(pk.PERF_METADATA, "CFE_ES_PerfMetaData_t")
    assert_same(pk.PERF_ENTRY, "CFE_ES_PerfDataEntry_t")
    assert_same(pk.START_APP.payload, "CFE_ES_StartAppCmd_Payload_t")
    assert_same(pk.RELOAD_APP.payload, "CFE_ES_AppReloadCmd_Payload_t")


def test_every_function_code_is_declared_once() -> None:
    assert sorted(each.code for each in pk.COMMANDS if each.code is not None) == [0, 1, 2, *range(4, 25)]
    assert len({each.name for each in pk.COMMANDS}) == len(pk.COMMANDS) == 25


def test_nasas_housekeeping_is_unpacked_and_packed_again() -> None:
    packets = [bytes.fromhex(each["hex"]) for each in RECORDED if each["desc"] == "CFE_ES_HK_TLM"]
    values = pk.HK_TLM.read(packets[0])
    assert (values["CFEMajorVersion"], values["BootSource"], values["RegisteredCoreApps"]) == (7, 1, 5)
    assert (values["SysLogSize"], values["ERLogIndex"], values["ERLogEntries"]) == (3072, 1, 1)
    assert all(pk.HOUSEKEEPING.pack(pk.HK_TLM.read(packet)) == packet[16:] for packet in packets)


def test_housekeeping(tmp_path: Path) -> None:
    lab = Lab(tmp_path, one=lambda cfe: cfe.os.task_delay(10**6))
    lab.start("one")
    lab.mission.run_for(1)
    values = sent(lab, pk.SEND_HK.packet(), pk.HK_TLM)
    assert values["CFEMajorVersion"] == values["OSALMajorVersion"] == values["PSPMajorVersion"] == 7
    assert (values["RegisteredCoreApps"], values["RegisteredExternalApps"]) == (5, 1)
    assert values["RegisteredTasks"] == sum(len(app.tasks) for app in lab.es.apps)
    assert values["SysLogBytesUsed"] == len(lab.es.syslog.read())
    assert values["SysLogEntries"] == lab.es.syslog.read().count(b"\n")
    assert (values["ResetType"], values["ResetSubtype"], values["MaxProcessorResets"]) == (2, 1, 2)
    assert (values["ERLogIndex"], values["ERLogEntries"], values["BootSource"]) == (1, 1, 1)
    assert values["PerfFilterMask"] == [0xFFFFFFFF] * 4
    lab.mission.close()


def test_query_one(tmp_path: Path) -> None:
    lab = Lab(tmp_path, one=lambda cfe: cfe.os.task_delay(10**6), lib=lambda cfe: 0)
    app_id = lab.start("one", exception_action=1, priority=77)
    lib_id = lab.es.load_library("LIB", "/cf/lib.so", "lib_init")
    lab.mission.run_for(1)
    values = sent(lab, pk.QUERY_ONE.packet(Application="ONE"), pk.APP_TLM)
    assert (values["ResourceId"], values["Type"], values["Name"], values["MainTaskName"]) == (app_id, 2, "ONE", "ONE")
    assert (values["ExceptionAction"], values["Priority"], values["StackSize"]) == (1, 77, 8192)
    assert (values["FileName"], values["EntryPoint"]) == ("/cf/one.so", "one_main")
    values = sent(lab, pk.QUERY_ONE.packet(Application="LIB"), pk.APP_TLM)
    assert (values["ResourceId"], values["Type"], values["Name"]) == (lib_id, 3, "LIB")
    assert (values["FileName"], values["EntryPoint"], values["MainTaskId"]) == ("/cf/lib.so", "lib_init", 0)
    lab.mission.close()


def sent(lab: Lab, command: bytes, answer: Telemetry) -> dict[str, Any]:
    """Return the fields of the answer to a command."""
    got: list[bytes] = []

    def listen(pipe: int) -> None:
        packet = lab.cfe.sb.receive_buffer(pipe, 1000)
        assert packet is not None
        got.append(packet)

    pipe = lab.cfe.sb.create_pipe(3, "LISTENER")
    lab.cfe.sb.subscribe(answer.msg_id, pipe)
    lab.mission.kernel.spawn("listener", lambda: listen(pipe))
    lab.cfe.sb.transmit_msg(command)
    lab.mission.run_for(1)
    lab.cfe.sb.delete_pipe(pipe)
    assert (got[0][0] << 8 | got[0][1], len(got[0])) == (answer.msg_id, answer.length)
    return answer.read(got[0])
