"""Damaged files are detected or harmless. A locked table does not change."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule

from cfepy.msg import Command
from cfepy.ports import ERROR
from cfepy.status import CfeError
from cfepy.tbl import OPT_DBL_BUFFER, TableImage, build, packets, read, with_mark
from tests.tbl.conftest import Bench

SIZE = 8
OLD, NEW = b"old data", b"new data"
GOOD = build(TableImage("APP.T", NEW, "a table"))
HEADERS = len(GOOD) - SIZE


def loaded_bench() -> tuple[Bench, int]:
    bench = Bench()
    handle = bench.tbl.register("T", SIZE)
    bench.tbl.load(handle, OLD)
    return bench, handle


def content(bench: Bench) -> bytes:
    registry = bench.tbl.registry
    active = registry.active(registry.by_name("APP.T"))
    assert active is not None
    return bytes(active.view())


def load_damaged(bench: Bench, handle: int, data: bytes) -> bool:
    """Load a file and check that the table is either unchanged or has the file's content."""
    bench.files["/cf/t.tbl"] = data
    before = content(bench)
    try:
        bench.tbl.load(handle, "/cf/t.tbl")
    except CfeError:
        assert content(bench) == before
        assert not bench.tbl.registry.by_name("APP.T").is_loading
        return False
    return True


def test_every_flipped_bit_of_the_headers_is_found_or_harmless() -> None:
    bench, handle = loaded_bench()
    harmless = set()
    for bit in range(HEADERS * 8):
        damaged = bytearray(GOOD)
        damaged[bit // 8] ^= 1 << bit % 8
        bench.tbl.load(handle, OLD)
        if load_damaged(bench, handle, bytes(damaged)):
            assert content(bench) == NEW
            harmless.add(bit // 8)
    header_length_ids_time_description = set(range(8, 64))
    bytes_after_the_name = set(range(76 + len("APP.T") + 1, 116))
    assert harmless == header_length_ids_time_description | bytes_after_the_name


@pytest.mark.parametrize("by_ground", [False, True], ids=["owner", "ground"])
def test_every_flipped_bit_of_a_marked_file_is_found(by_ground: bool) -> None:
    bench, handle = loaded_bench()
    marked = with_mark(GOOD)
    for bit in range(len(marked) * 8):
        damaged = bytearray(marked)
        damaged[bit // 8] ^= 1 << bit % 8
        bench.take_events()
        if by_ground:
            bench.files["/cf/t.tbl"] = bytes(damaged)
            bench.ground(packets.LOAD, LoadFilename="/cf/t.tbl")
            assert content(bench) == OLD
            assert not bench.tbl.registry.by_name("APP.T").is_loading
        else:
            assert not load_damaged(bench, handle, bytes(damaged)), f"bit {bit}"
        (event,) = bench.take_events()
        assert event[1] == ERROR, f"bit {bit}"
    assert load_damaged(bench, handle, marked)
    assert content(bench) == NEW


@given(st.binary(max_size=160) | st.integers(0, len(GOOD)).map(lambda end: GOOD[:end]))
def test_any_bytes_as_a_file(data: bytes) -> None:
    bench, handle = loaded_bench()
    if load_damaged(bench, handle, data):
        image = read(data)
        assert content(bench)[image.offset : image.offset + len(image.data)] == image.data


@given(
    name=st.from_regex(r"[A-Z_]{1,19}\.[A-Za-z]{1,15}", fullmatch=True),
    data=st.binary(min_size=1, max_size=64),
    description=st.text("abc XYZ", max_size=31),
    offset=st.integers(0, 2**32 - 1),
    time=st.tuples(st.integers(0, 2**32 - 1), st.integers(0, 2**32 - 1)),
)
def test_image_survives_a_round_trip(
    name: str, data: bytes, description: str, offset: int, time: tuple[int, int]
) -> None:
    image = TableImage(name, data, description, offset, time=time)
    assert read(build(image)) == image


class TableLife(RuleBasedStateMachine):
    """Loads by owner and ground, against readers that hold the address."""

    @initialize(double=st.booleans())
    def begin(self, double: bool) -> None:
        self.bench = Bench(tbl_max_simultaneous_loads=2)
        self.double = double
        owner = self.bench.tbl.register("T", SIZE, OPT_DBL_BUFFER if double else 0, lambda image: -(image[0] == 0xFF))
        for _ in range(2):  # a single-buffered table heeds locks from its second load on
            self.bench.tbl.load(owner, OLD)
        self.bench.as_app("OTHER")
        self.handles = {"APP": owner, "OTHER": self.bench.tbl.share("APP.T")}
        self.views: dict[str, tuple[memoryview, bytes]] = {}

    def call(self, app: str, function: str, *args: object) -> Any:
        self.bench.as_app(app)
        try:
            return getattr(self.bench.tbl, function)(self.handles[app], *args)
        except CfeError:
            return None

    @rule(data=st.binary(min_size=SIZE, max_size=SIZE))
    def load(self, data: bytes) -> None:
        before, locked = content(self.bench), bool(self.views)
        status = self.call("APP", "load", data)
        expected = data if status == 0 else before
        assert content(self.bench) == expected
        assert not (data[0] == 0xFF and status == 0)
        assert self.double or not (locked and status == 0)

    @rule(data=st.binary(min_size=SIZE, max_size=SIZE))
    def load_from_ground(self, data: bytes) -> None:
        before = content(self.bench)
        self.bench.put("/cf/t.tbl", "APP.T", data)
        self.bench.ground(packets.LOAD, LoadFilename="/cf/t.tbl")
        assert content(self.bench) == before

    @rule(flag=st.sampled_from([0, 1]))
    def validate(self, flag: int) -> None:
        self.bench.ground(packets.VALIDATE, ActiveTableFlag=flag, TableName="APP.T")

    @rule(wish=st.sampled_from([packets.ACTIVATE, packets.ABORT_LOAD]))
    def command(self, wish: Command) -> None:
        self.bench.named(wish, "APP.T")

    @rule()
    def manage(self) -> None:
        self.call("APP", "manage")

    @rule(flag=st.sampled_from([0, 1]))
    def dump(self, flag: int) -> None:
        self.bench.ground(packets.DUMP, ActiveTableFlag=flag, TableName="APP.T", DumpFilename="/ram/t.tbl")
        self.bench.send_hk()

    @rule(app=st.sampled_from(["APP", "OTHER"]))
    def get_address(self, app: str) -> None:
        view: memoryview = self.call(app, "get_address")[0]
        assert bytes(view) == content(self.bench)
        self.views[app] = (view, bytes(view))

    @precondition(lambda self: self.views)
    @rule(data=st.data())
    def release_address(self, data: st.DataObject) -> None:
        app = data.draw(st.sampled_from(sorted(self.views)))
        del self.views[app]
        self.call(app, "release_address")

    @invariant()
    def locked_views_stay_as_they_are(self) -> None:
        for view, before in getattr(self, "views", {}).values():
            assert bytes(view) == before

    @invariant()
    def no_bad_image_is_active(self) -> None:
        if hasattr(self, "bench"):
            assert content(self.bench)[0] != 0xFF

    @invariant()
    def no_shared_buffer_is_lost(self) -> None:
        if hasattr(self, "bench"):
            registry = self.bench.tbl.registry
            table = registry.by_name("APP.T")
            loading = registry.loading(table)
            used = loading is not None and not registry.is_private(table, loading)
            assert self.bench.send_hk()["NumFreeSharedBufs"] == 2 - used


TestTableLife = TableLife.TestCase
TestTableLife.settings = settings(max_examples=20, stateful_step_count=30, deadline=None)
