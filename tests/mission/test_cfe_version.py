"""The release of cFE that a mission flies on: the effects of `cfe_version` outside of Table Services."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

from cfepy.config import versions
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


@pytest.mark.parametrize(
    ("revision", "text"),
    [(0, "v7.0.1 Official Release"), (255, "DEV BUILD, based on v7.0.1"), (12, "M12, based on v7.0.1")],
)
def test_mission_revision_decides_the_text_of_a_version(revision: int, text: str) -> None:
    assert versions.Version((7, 0, 1, revision), "Draco", 0).status == text


def test_development_branch_is_a_build_behind_7_0_1(tmp_path: Path) -> None:
    folder = write_mission(tmp_path, "!", mission_yaml='cfe_version: "dev"')
    with Mission(folder, console=Console(quiet=True)) as mission:
        mission.run_for(1)
        log = "\n".join(mission.console.lines)
        assert "cfe v7.0.1+dev1, osal v7.0.0+dev0, psp v7.0.0+dev0." in log
        assert "CFE_ES v7.0.1+dev1 (Draco) DEV BUILD, based on v7.0.1, EDS disabled" in log
        config = mission.cfe.config
        assert config.get_value(config.get_id_by_name("CORE_VERSION_MISSION_REV")) == 255


def test_default_release_is_7_0_1(tmp_path: Path) -> None:
    assert read_mission(write_mission(tmp_path, "!")).cfe_version == "7.0.1"


def test_third_release_is_only_another_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The made-up release 7.2.9 flies and reports its numbers without a change of code."""
    text = (versions.FOLDER / "7.0.1.toml").read_text(encoding="utf-8")
    for old, new in (
        ("cfe = [7, 0, 1, 0]", "cfe = [7, 2, 9, 255]"),
        ("osal = [7, 0, 0, 0]", "osal = [7, 1, 3, 255]"),
        ("psp = [7, 0, 0, 0]", "psp = [7, 1, 4, 0]"),
        ('"Draco"', '"Equuleus"'),
        ("build_number = 0", "build_number = 17"),
        ('core_apps = ["ES", "EVS", "SB", "TBL", "TIME"]', 'core_apps = ["EVS", "TIME", "TBL", "SB", "ES"]'),
    ):
        assert text.count(old) == 1
        text = text.replace(old, new)
    text += "limits.evs_log_max = 7\n"
    releases = tmp_path / "releases"
    releases.mkdir()
    (releases / "7.2.9.toml").write_text(text, encoding="utf-8")
    monkeypatch.setattr(versions, "FOLDER", releases)
    packets: list[Seen] = []
    watch = PacketWatch(packets.append, lambda msg_id: msg_id == es.HK_TLM_MID)
    folder = write_mission(tmp_path, "!", mission_yaml='cfe_version: "7.2.9"')
    with Mission(folder, console=Console(quiet=True), attachments=[watch]) as mission:
        mission.run_for(1)
        log = "\n".join(mission.console.lines)
        assert "cfe v7.2.9+dev17, osal v7.1.3+dev17, psp v7.1.4+dev0." in log
        assert "CFE_ES v7.2.9+dev17 (Equuleus) DEV BUILD, based on v7.2.9, EDS disabled" in log
        assert "Module OSAL, version git:v7.1.3" in log
        assert [app.name for app in mission.cfe.es.apps] == ["CFE_EVS", "CFE_TIME", "CFE_TBL", "CFE_SB", "CFE_ES"]
        assert mission.cfe.os.get_version_number() == (7, 1, 3, 255)
        config = mission.cfe.config
        assert config.get_value(config.get_id_by_name("PLATFORM_EVS_LOG_MAX")) == 7
        assert mission.cfe.psp.get_version_code_name() == "Equuleus"
        mission.cfe.sb.transmit_msg(es.SEND_HK.packet())
        mission.run_for(0.1)
        values = es.HK_TLM.read(packets[0].packet)
    assert [values[f"CFE{part}"] for part in ("MinorVersion", "Revision", "MissionRevision")] == [2, 9, 255]
    assert [values["OSALRevision"], values["PSPRevision"]] == [3, 4]


def test_files_of_releases_are_toml() -> None:
    """They have no escapes and no nested tables, so cfepy's own reader gives the library's values."""
    for name, release in versions.RELEASES.items():
        whole = tomllib.loads((versions.FOLDER / f"{name}.toml").read_text(encoding="utf-8"))
        read = vars(release)
        whole.setdefault("limits", {})
        assert {key: list(value) if isinstance(value, tuple) else value for key, value in read.items()} == whole


@pytest.mark.parametrize(
    ("line", "error"),
    [
        ("codename = Draco", "file.toml:1: codename: must be a text in quotation marks, not Draco"),
        ("cfe = [7, 0]", "file.toml:1: cfe: must be a list of four numbers, not [7, 0]"),
        ("sizes_of_32_bits = 1", "file.toml:1: sizes_of_32_bits: must be true or false, not 1"),
        ("color = true", "file.toml:1: unknown value 'color' of a release"),
    ],
)
def test_mistake_in_the_file_of_a_release_is_reported(tmp_path: Path, line: str, error: str) -> None:
    file = tmp_path / "file.toml"
    file.write_text(line, encoding="utf-8")
    with pytest.raises(UsageError) as caught:
        versions.read_release(file)
    assert str(caught.value).endswith(error)


def test_value_that_the_file_of_a_release_lacks_is_reported(tmp_path: Path) -> None:
    file = tmp_path / "file.toml"
    text = (versions.FOLDER / "7.0.1.toml").read_text(encoding="utf-8")
    file.write_text(text.replace("longest_entry = 127", ""), encoding="utf-8")
    with pytest.raises(UsageError, match="missing longest_entry; add it"):
        versions.read_release(file)


@pytest.mark.parametrize("said", ['"6.7.0"', "7.0", "[7]"])
def test_another_release_is_refused(tmp_path: Path, said: str) -> None:
    folder = write_mission(tmp_path, "!", mission_yaml=f"name: m\ncfe_version: {said}")
    with pytest.raises(UsageError, match=r'unknown release of cFE .*; expected "7.0.0" or "7.0.1" or "dev"') as caught:
        read_mission(folder)
    assert (caught.value.field, caught.value.line) == ("cfe_version", 2)
