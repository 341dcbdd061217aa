"""Public missions and applications: the list, the results, the page, and the build and flight of one."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from dev.c.public_apps.missions import PublicMission, PublicMissions, Repository, read_missions
from dev.c.public_apps.results import (
    ANSWERS,
    AT_ONCE,
    LIBRARY,
    NOT_BUILT,
    NOT_FLOWN,
    PAGE,
    RUNS,
    WITH_OPTION,
    Result,
    page,
    read_beside,
    read_results,
    write_results,
)
from dev.c.public_apps.trial import in_definitions, try_mission
from dev.corpus.sources import Sources
from tests.extra.c.building import needs_compiler

APP = """
    #include "cfe.h"
    void PROBE_AppMain(void)
    {
        CFE_SB_PipeId_t Pipe;
        CFE_SB_Buffer_t *Buffer;
        CFE_MSG_FcnCode_t Code;

        CFE_EVS_Register(NULL, 0, CFE_EVS_EventFilter_BINARY);
        CFE_SB_CreatePipe(&Pipe, 5, "PROBE");
        CFE_SB_Subscribe(CFE_SB_ValueToMsgId(MID), Pipe);
        while (CFE_ES_RunLoop(NULL)) {
            CFE_SB_ReceiveBuffer(&Buffer, Pipe, CFE_SB_PEND_FOREVER);
            CFE_MSG_GetFcnCode(&Buffer->Msg, &Code);
            CFE_EVS_SendEvent(3, CFE_EVS_EventType_INFORMATION, "NOOP %d", (int)Code);
        }
    }
"""


def test_each_repository_has_a_commit_and_a_licence_that_is_not_gpl() -> None:
    found = read_missions()
    for each in found.repositories.values():
        assert re.fullmatch(r"[0-9a-f]{40}", each.commit)
        assert each.licence
        assert "GPL" not in each.licence


def test_each_mission_has_results_and_its_repositories_are_listed() -> None:
    found = read_missions()
    used = {repo for each in found.missions.values() for repo in (each.repo, *each.parts.values())}
    assert used == set(found.repositories)
    assert {each.mission for each in read_results()} == set(found.missions)


def test_results_have_known_words_and_reasons() -> None:
    for each in read_results():
        assert each.built in (AT_ONCE, WITH_OPTION, NOT_BUILT)
        assert each.flown in (ANSWERS, RUNS, LIBRARY, NOT_FLOWN)
        assert each.built != NOT_BUILT or each.flown == NOT_FLOWN
        assert each.text or each.flown in (RUNS, LIBRARY)


def test_page_has_the_results() -> None:
    text = page(read_missions(), read_results(), read_beside())
    assert PAGE.read_text(encoding="utf-8") == text, "run python -m dev.c.public_apps report"


def test_results_are_read_as_they_were_written(tmp_path: Path) -> None:
    results = [Result("one", "app", AT_ONCE, ANSWERS, "event 1: a, b"), Result("two", "lib", WITH_OPTION, LIBRARY, "")]
    write_results(results, tmp_path / "results.tsv")
    assert read_results(tmp_path / "results.tsv") == results


def test_nasas_applications_do_not_count() -> None:
    mission = PublicMission("one", "a/b")
    assert [each for each in ("cf", "HK", "sample_lib", "probe") if mission.counts(each)] == ["probe"]
    assert PublicMission("one", "a/b", apps=("hk",)).counts("hk")


def test_entry_of_an_application_comes_from_the_definitions(tmp_path: Path) -> None:
    script = tmp_path / "defs/cpu1_cfe_es_startup.scr"
    script.parent.mkdir()
    script.write_text(
        "CFE_APP, radio, R_Main, RADIO, 67, 32768, 0x0, 0;\n! end\n! more\nCFE_APP, cam, C_Main, CAM, 5, 99, 0, 0;\n!\n"
    )
    [entry] = in_definitions(tmp_path, "radio")
    assert (entry.symbol, entry.name, entry.priority) == ("R_Main", "RADIO", 67)
    assert [each.name for each in in_definitions(tmp_path, "cam")] == ["CAM"]
    assert in_definitions(tmp_path, "other") == []


def test_unknown_mission_is_reported() -> None:
    missions = PublicMissions({}, {"a/b": Repository("0" * 40, "MIT")})
    with pytest.raises(Exception, match="unknown mission x"):
        missions.chosen(["x"])


@needs_compiler
@pytest.mark.slow  # 6 s: two builds, and a flight in a process of its own
@pytest.mark.parametrize("options", [(), ("--flag=-DMID=0x1890",)])
def test_application_is_built_and_answers(options: tuple[str, ...], tmp_path: Path) -> None:
    source = tmp_path / "sources/owner+probe/fsw/src/probe.c"
    source.parent.mkdir(parents=True)
    source.write_text(("" if options else "#define MID 0x1890\n") + APP, encoding="utf-8")
    mission = PublicMission("probe", "owner/probe", options=options)
    [result] = try_mission(mission, Sources(tmp_path / "sources"))
    assert result == Result("probe", "probe", WITH_OPTION if options else AT_ONCE, ANSWERS, "event 3: NOOP 0")


@needs_compiler
@pytest.mark.slow  # 3 s: two builds
def test_application_that_does_not_compile_has_the_reason(tmp_path: Path) -> None:
    source = tmp_path / "sources/owner+probe/fsw/src/probe.c"
    source.parent.mkdir(parents=True)
    source.write_text("#include <gone.h>\n", encoding="utf-8")
    [result] = try_mission(PublicMission("probe", "owner/probe"), Sources(tmp_path / "sources"))
    assert (result.built, result.flown) == (NOT_BUILT, NOT_FLOWN)
    assert result.text == "probe/fsw/src/probe.c:1:10: fatal error: gone.h: No such file or directory"
