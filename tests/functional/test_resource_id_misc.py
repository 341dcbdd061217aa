"""Resource ids as such (resource_id_misc_test.c)."""

from __future__ import annotations

from cfepy import ids
from cfepy.app import Cfe
from cfepy.mission import Mission
from cfepy.status import CFE_ES_ERR_RESOURCEID_NOT_VALID
from tests.functional.harness import LIBRARY, status_of


def test_resource_id_to_integer(cfe: Cfe) -> None:
    for number in (1, 999, cfe.es.get_app_id()):
        made = ids.from_integer(number)
        assert ids.to_integer(made) == number
        assert ids.equal(ids.from_integer(ids.to_integer(made)), made)


def test_resource_id_is_defined(cfe: Cfe) -> None:
    for number in (1, 999, cfe.es.get_app_id()):
        assert ids.is_defined(ids.from_integer(number))
    assert not ids.is_defined(ids.UNDEFINED)


def test_resource_id_get_base(cfe: Cfe) -> None:
    es = cfe.es
    made = {
        ids.ES_APPID_BASE: es.get_app_id(),
        ids.ES_LIBID_BASE: es.get_lib_id_by_name(LIBRARY),
        ids.ES_TASKID_BASE: es.get_task_id(),
        ids.ES_COUNTID_BASE: es.register_gen_counter("TEST_COUNTER"),
        ids.ES_POOLID_BASE: es.pool_create(1024),
        ids.ES_CDSBLOCKID_BASE: es.register_cds(10, "TEST_CDS"),
    }
    assert list(made) == [0x11, 0x12, 0x01, 0x13, 0x14, 0x15]
    for base, resource_id in made.items():
        assert ids.get_base(resource_id) == base
        assert ids.get_serial(resource_id) == resource_id - ids.make(base, 0)


def test_resource_id_find_next(cfe: Cfe, mission: Mission) -> None:
    me, most = cfe.es.get_app_id(), mission.config.es_max_applications
    assert ids.find_next(me, most, lambda candidate: False) == me + 1
    assert ids.find_next(me, most, lambda candidate: True) == ids.UNDEFINED
    assert ids.find_next(me, 0, lambda candidate: False) == ids.UNDEFINED


def test_resource_id_to_index(cfe: Cfe, mission: Mission) -> None:
    me, most = cfe.es.get_app_id(), mission.config.es_max_applications
    assert 0 <= ids.to_index(me, ids.ES_APPID_BASE, most) < most
    assert status_of(ids.to_index, me, ids.ES_APPID_BASE, 0) == CFE_ES_ERR_RESOURCEID_NOT_VALID
    assert status_of(ids.to_index, me, ids.ES_LIBID_BASE, most) == CFE_ES_ERR_RESOURCEID_NOT_VALID
