"""The release of cFE that a mission flies on: the effects of `cfe_version` outside of Table Services."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.es import packets as es
from cfepy.mission import Mission, PacketWatch, Seen, read_mission
from cfepy.status import UsageError
from cfepy.writing.console import Console
from tests.mission.flights import write_mission

CALLS = {
    "7.0.0": [
        "CFE_Config_Init",
        "CFE_ES_CDSEarlyInit",
        "CFE_EVS_EarlyInit",
        "CFE_SB_EarlyInit",
        "CFE_TIME_EarlyInit",
        "CFE_TBL_EarlyInit",
        "CFE_FS_EarlyInit",
    ],
    "7.0.1": [f"EarlyInit for CFE_{name}" for name in ("CONFIG", "ES", "EVS", "FS", "SB", "TBL", "TIME")],
}
CORE_APPS = {"7.0.0": ["EVS", "SB", "ES", "TIME", "TBL"], "7.0.1": ["ES", "EVS", "SB", "TBL", "TIME"]}
"""In the order of their AppIDs."""


@pytest.mark.parametrize("version", ["7.0.0", "7.0.1"])
def test_boot(tmp_path: Path, version: str) -> None:
    folder = write_mission(tmp_path, "!", mission_yaml=f'cfe_version: "{version}"')
    packets: list[Seen] = []
    watch = PacketWatch(packets.append, lambda msg_id: msg_id == es.HK_TLM_MID)
    with Mission(folder, console=Console(quiet=True), attachments=[watch]) as mission:
        mission.run_for(1)
        calling = "CFE_ES_CreateObjects: Calling "
        calls = [line.partition(calling)[2] for line in mission.console.lines if calling in line]
        assert calls == CALLS[version]
        assert [app.name for app in mission.cfe.es.apps] == [f"CFE_{name}" for name in CORE_APPS[version]]
        log = "\n".join(mission.console.lines)
        assert f"cfe v{version}+dev0, osal v7.0.0+dev0, psp v7.0.0+dev0." in log
        for name in CORE_APPS[version]:
            text = f"cFE {name} Initialized: CFE_{name} v{version}+dev0 (Draco) v{version} Official Release"
            assert text in log
        mission.cfe.sb.transmit_msg(es.SEND_HK.packet())
        mission.run_for(0.1)
        (packet,) = [seen.packet for seen in packets]
        values = es.HK_TLM.read(packet)
        assert (values["CFERevision"], values["OSALRevision"]) == (int(version[-1]), 0)


def test_default_release_is_7_0_1(tmp_path: Path) -> None:
    assert read_mission(write_mission(tmp_path, "!")).cfe_version == "7.0.1"


@pytest.mark.parametrize("said", ['"6.7.0"', "7.0", "[7]"])
def test_another_release_is_refused(tmp_path: Path, said: str) -> None:
    folder = write_mission(tmp_path, "!", mission_yaml=f"name: m\ncfe_version: {said}")
    with pytest.raises(UsageError, match="unknown release of cFE") as caught:
        read_mission(folder)
    assert (caught.value.field, caught.value.line) == ("cfe_version", 2)
