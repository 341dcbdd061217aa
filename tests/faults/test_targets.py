"""The candidates of random faults: read once, and again after the mission's files have changed."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.faults import plan_of, targets
from cfepy.mission import MissionSpec, read_mission


def test_candidates_are_collected_again_when_files_change(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "startup.scr").write_text("!\n", encoding="utf-8")
    looked: list[MissionSpec] = []
    look_at = targets.look_at

    def counted(spec: MissionSpec) -> targets.Found:
        looked.append(spec)
        return look_at(spec)

    monkeypatch.setattr(targets, "look_at", counted)
    first = plan_of("seed:7", read_mission(str(tmp_path)))
    assert plan_of("seed:7", read_mission(str(tmp_path))) == first
    assert len(looked) == 1
    (tmp_path / "startup.scr").write_text("! changed\n", encoding="utf-8")
    plan_of("seed:7", read_mission(str(tmp_path)))
    assert len(looked) == 2
