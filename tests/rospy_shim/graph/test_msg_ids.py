"""MsgIds that do not come from a hash alone: locked ones, and the next free one where ids are spread."""

from __future__ import annotations

from itertools import combinations

import pytest

from cfepy.status import UsageError
from rospy_shim.graph.msg_ids import FIRST_MSG_ID, LAST_MSG_ID, MsgIds, locked, msg_id_of, next_free
from rospy_shim.types.config import RosConfig, TopicConfig

NAMES = [f"/topic{number}" for number in range(100)]
FIRST, SECOND = next(pair for pair in combinations(NAMES, 2) if msg_id_of(pair[0]) == msg_id_of(pair[1]))


def test_colliding_topics_get_the_next_free_id_in_order() -> None:
    ids = MsgIds(RosConfig(spread=True))
    taken = [ids.of_topic(name) for name in (SECOND, FIRST, SECOND)]
    assert taken == [msg_id_of(FIRST), msg_id_of(FIRST) + 1, msg_id_of(FIRST)]


def test_colliding_topic_avoids_ids_of_the_mission_files() -> None:
    after = msg_id_of(FIRST) + 1
    config = RosConfig(topics={"/pin": TopicConfig("/pin", after)}, locked_services={"/srv": after + 1}, spread=True)
    ids = MsgIds(config)
    assert [ids.of_topic(FIRST), ids.of_topic(SECOND)] == [msg_id_of(FIRST), after + 2]
    assert (ids.of_topic("/pin"), ids.of_service("/srv")) == (after, after + 1)


def test_lock_has_a_unique_id_for_each_name() -> None:
    topics, services = locked(RosConfig(), NAMES, ["/reset", FIRST])
    given = [*topics.values(), *services.values()]
    assert len(set(given)) == len(given) == 102
    assert topics[FIRST] == msg_id_of(FIRST)
    assert topics[SECOND] != msg_id_of(SECOND)


def test_lock_does_not_depend_on_the_order_of_registration() -> None:
    assert locked(RosConfig(), NAMES, []) == locked(RosConfig(), reversed(NAMES), [])


def test_locked_ids_are_kept_and_new_names_avoid_them() -> None:
    before, _ = locked(RosConfig(), [SECOND], [])
    config = RosConfig(locked_topics=before, topics={"/pin": TopicConfig("/pin", 0x0901)})
    after, services = locked(config, [FIRST, SECOND, "/pin"], [])
    assert after == {SECOND: msg_id_of(SECOND), FIRST: msg_id_of(SECOND) + 1}
    assert services == {}
    ids = MsgIds(RosConfig(locked_topics=after))
    assert [ids.of_topic(FIRST), ids.of_topic(SECOND)] == [after[FIRST], after[SECOND]]
    assert ids.claimed() == ([], [])


def test_new_topic_on_a_locked_id_is_an_error_that_names_the_command() -> None:
    ids = MsgIds(RosConfig(locked_topics={SECOND: msg_id_of(SECOND)}))
    command = "`cfepy graph --lock MISSION`"
    with pytest.raises(UsageError, match=rf"{SECOND} and {FIRST} have the same MsgId .*{command}"):
        ids.of_topic(FIRST)


def test_too_many_topics_are_an_error() -> None:
    full = dict.fromkeys(range(FIRST_MSG_ID, LAST_MSG_ID + 1), "/x")
    del full[0x0950]
    assert next_free(LAST_MSG_ID, full) == 0x0950
    with pytest.raises(UsageError, match="no MsgId is left"):
        next_free(0x0950, {**full, 0x0950: "/y"})
