"""CFDP on the ground: two entities exchange PDUs, and lost PDUs are sent again."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.ground.cfdp import CF_OUT_MID, CLASS_1, CLASS_2, GroundEntity, Transfer, pdu_in, uplinked
from cfepy.msg import telemetry

pytest.importorskip("cfdppy", reason="cfdp-py is not installed")

DATA = bytes(range(256)) * 20
STEP_S, LIMIT_S = 0.5, 200.0


class Sky:
    """Two entities, a clock, and a link between them that may lose PDUs."""

    def __init__(self, folder: Path, lost: tuple[int, ...] = ()) -> None:
        self.now = 0.0
        self._lost, self._count = lost, 0
        for name in ("ground", "craft"):
            (folder / name).mkdir()
        self.ground = GroundEntity(folder / "ground", lambda: self.now)
        self.craft = GroundEntity(folder / "craft", lambda: self.now, entity=25, spacecraft=23)

    def fly(self) -> None:
        """Run until both have ended, or the time is over. With class 1, the sender ends at once."""
        while self.now < LIMIT_S and not (self.ground.transfers and self.craft.transfers):
            self._hand_over(self.ground.turn(), self.craft, self.ground)
            self._hand_over(self.craft.turn(), self.ground, self.craft)
            self.now += STEP_S

    def _hand_over(self, pdus: list[bytes], target: GroundEntity, source: GroundEntity) -> None:
        for pdu in pdus:
            self._count += 1
            if self._count not in self._lost:
                self._hand_over(target.take(pdu), source, target)


@pytest.mark.parametrize("cfdp_class", [CLASS_1, CLASS_2])
def test_file_arrives(tmp_path: Path, cfdp_class: int) -> None:
    sky = Sky(tmp_path)
    (tmp_path / "ground" / "a.dat").write_bytes(DATA)
    sky.ground.put("a.dat", "b.dat", cfdp_class)
    sky.fly()
    assert (tmp_path / "craft" / "b.dat").read_bytes() == DATA
    assert sky.craft.transfers == [Transfer("down", "b.dat", 0, True)]


def test_lost_pdus_are_sent_again_in_class_2(tmp_path: Path) -> None:
    sky = Sky(tmp_path, lost=(3, 5))
    (tmp_path / "ground" / "a.dat").write_bytes(DATA)
    sky.ground.put("a.dat", "b.dat", CLASS_2)
    sky.fly()
    assert (tmp_path / "craft" / "b.dat").read_bytes() == DATA
    assert sky.now < LIMIT_S


def test_pdu_is_sent_in_a_packet() -> None:
    assert pdu_in(bytes(telemetry(CF_OUT_MID, b"pdu"))) == b"pdu"
    assert pdu_in(bytes(telemetry(0x800, b"pdu"))) is None
    assert uplinked(b"pdu")[8:] == b"pdu"
