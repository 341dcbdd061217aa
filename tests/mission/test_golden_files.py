"""The files that the real cFE wrote on command, written again by the same session: same size, same header."""

from __future__ import annotations

from dataclasses import replace

import pytest

from cfepy.fs import read_header
from tests.mission.golden_session import DATA, Session, fly

FILES = (
    "cfe_cds_reg.log",
    "cfe_erlog.log",
    "cfe_es_app_info.log",
    "cfe_es_syslog.log",
    "cfe_es_taskinfo.log",
    "cfe_evs.log",
    "cfe_evs_app.dat",
    "cfe_sb_msgmap.dat",
    "cfe_sb_pipe.dat",
    "cfe_sb_route.dat",
    "cfe_tbl_reg.log",
)


@pytest.fixture(scope="module")
def session(tmp_path_factory: pytest.TempPathFactory) -> Session:
    return fly(tmp_path_factory.mktemp("session"))


def test_all_files_are_written(session: Session) -> None:
    assert set(FILES) <= set(session.files)


@pytest.mark.parametrize("name", FILES)
def test_size_and_header(session: Session, name: str) -> None:
    recorded, ours = (DATA / name).read_bytes(), session.files[name]
    assert len(ours) == len(recorded)
    was, now = read_header(recorded), read_header(ours)
    assert now == replace(was, time_seconds=now.time_seconds, time_subseconds=now.time_subseconds)
