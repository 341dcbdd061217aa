"""Each public name of cFE, OSAL and PSP exists or is explained, and docs/reference/generated/api_map.md lists it."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from cfepy.mission import Mission
from dev.pages import api_map
from dev.pages.api_names import snake
from tests.extra.c.building import needs_compiler

pytestmark = needs_compiler  # the engine has the list of its own functions


@pytest.fixture(scope="module")
def mission() -> Iterator[Mission]:
    """Return a booted mission, on whose handle names are looked up."""
    with api_map.booted() as made:
        assert made.booted is not None
        yield made


@pytest.mark.parametrize("module", api_map.MODULES)
def test_every_name_exists_or_is_explained(mission: Mission, module: str) -> None:
    rows = api_map.entries(module, mission.cfe)
    assert [row.name for row in rows if row.is_missing] == []
    assert [row.name for row in rows if row.c == api_map.MISSING] == []


def test_name_missing_in_c_is_reported() -> None:
    functions = {"CFE_ES_RunLoop"}
    found = [
        api_map._in_c(name, is_inside, functions)
        for name, is_inside in (
            ("CFE_ES_RunLoop", False),
            ("CFE_BIT", True),
            ("CFE_SBR_Init", False),
            ("OS_New", False),
        )
    ]
    assert found == [api_map.CALL, api_map.HEADER, api_map.CORE, api_map.MISSING]


def test_page_is_up_to_date(mission: Mission) -> None:
    assert api_map.PAGE.read_text(encoding="utf-8") == api_map.page(mission.cfe), "run `python -m dev.pages.api_map`"


def test_lists_are_complete() -> None:
    counts = {module: len(list(api_map.listed(module))) for module in api_map.MODULES}
    assert (counts["ES"], counts["SB"], counts["TBL"], counts["psp"]) == (59, 37, 21, 77)
    assert sorted(path.name for path in api_map.LISTS.glob("*.txt")) == sorted(f"api_{name}.txt" for name in counts)


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("GetCDSBlockIDByName", "get_cds_block_id_by_name"),
        ("PoolCreateEx_WithAlignment", "pool_create_ex_with_alignment"),
        ("MET2SCTime", "met2sc_time"),
        ("FS_GetPhysDriveName", "fs_get_phys_drive_name"),
        ("MemRead16", "mem_read16"),
    ],
)
def test_snake_case(name: str, expected: str) -> None:
    assert snake(name) == expected


def test_unexplained_name_is_missing() -> None:
    row = api_map.Difference("OSAL", ("OS_Foo*",), "model")
    assert row.mentions("OS_FooBar")
    assert not row.mentions("OS_Bar")
    missing = api_map.Entry("h", "OS_Bar", "cfe.os.bar", False, None)
    assert missing.is_missing
    assert missing._replace(difference=row._replace(reason=api_map.NO_REASON)).is_missing
    explained = missing._replace(difference=row)
    assert explained.status == "[absent](../differences.md#osal): model"
    assert explained._replace(exists=True).status == "[differs](../differences.md#osal)"
