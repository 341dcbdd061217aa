"""The configuration registry: NASA's keys with NASA's ids, and the platform configuration after them."""

from __future__ import annotations

import pytest

from cfepy.config.config_api import UNKNOWN, ConfigServices
from cfepy.config.platform import PlatformConfig
from cfepy.es.pools import BUCKETS

FIRST = 0x170000


@pytest.fixture
def config() -> ConfigServices:
    return ConfigServices(PlatformConfig(), "demo")


@pytest.mark.parametrize(
    ("index", "name"),
    [
        (0, "MISSION_NAME"),
        (3, "MISSION_SBINTF_DB"),
        (4, "CORE_VERSION_MAJOR"),
        (10, "CORE_VERSION_DESCRIPTION"),
        (13, "CORE_BUILDINFO_HOST"),
        (14, "MOD_SRCVER_CORE_API"),
    ],
)
def test_ids_match_nasas(config: ConfigServices, index: int, name: str) -> None:
    assert config.get_id_by_name(name) == FIRST + index
    assert config.get_name(FIRST + index) == name


def test_each_kind_of_value(config: ConfigServices) -> None:
    def named(name: str) -> int:
        return config.get_id_by_name(name)

    assert config.get_value(named("CORE_VERSION_MAJOR")) == 7
    assert config.get_string(named("MISSION_NAME")) == config.get_obj_pointer(named("MISSION_NAME")) == "demo"
    assert config.get_string(named("MOD_SRCVER_SB")) == "git:v7.0.1"
    description = "cFE v7.0.1+dev0 (Draco) v7.0.1 Official Release, EDS disabled"
    assert config.get_string(named("CORE_VERSION_DESCRIPTION")) == description
    assert config.get_obj_pointer(named("MISSION_EDS_DB")) is None
    assert config.get_array_value(named("PLATFORM_ES_MEM_BLOCK_SIZE")) == BUCKETS[::-1]
    sizes = config.get_array_value(named("PLATFORM_SB_MEM_BLOCK_SIZE"))
    assert (len(sizes), sizes[0], sizes[1], sizes[-1]) == (17, 32896, 32768, 8)
    assert config.get_array_value(named("PLATFORM_TBL_VALID_SCID")) == ()


def test_value_of_another_kind_is_empty(config: ConfigServices) -> None:
    number, text = config.get_id_by_name("CORE_VERSION_MAJOR"), config.get_id_by_name("MISSION_NAME")
    assert config.get_value(text) == 0
    assert config.get_string(number) == UNKNOWN
    assert config.get_array_value(text) == ()
    assert config.get_obj_pointer(number) is None


@pytest.mark.parametrize("bad", [0, FIRST + 0xFFFF, 0x160000])
def test_unknown_ids_have_no_values(config: ConfigServices, bad: int) -> None:
    assert config.get_name(bad) == config.get_string(bad) == UNKNOWN
    assert config.get_value(bad) == 0
    assert config.get_id_by_name("NONE") == 0


def test_keys_are_iterated_in_the_order_of_their_ids(config: ConfigServices) -> None:
    seen: list[tuple[int, str]] = []
    config.iterate_all(lambda config_id, name: seen.append((config_id, name)))
    assert [config_id for config_id, _ in seen] == list(range(FIRST, FIRST + len(seen)))
    assert len({name for _, name in seen}) == len(seen)


def test_platform_configuration_follows_the_board() -> None:
    config = ConfigServices(PlatformConfig().with_limits({"es_max_applications": 8, "os_max_tasks": 20}), "demo")
    assert config.get_value(config.get_id_by_name("PLATFORM_ES_MAX_APPLICATIONS")) == 8
    assert config.get_value(config.get_id_by_name("OS_MAX_TASKS")) == 20


def test_version_string() -> None:
    text = ConfigServices.get_version_string("HK", "v1.0", "Aquila", "v0.9")
    assert text == "HK v1.0 (Aquila) v0.9 Official Release, EDS disabled"
