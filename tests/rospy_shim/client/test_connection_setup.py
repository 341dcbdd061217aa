"""Connections that take time: messages published meanwhile, counts of peers, and the order of arrival.

On a real master, a subscriber that started second was connected after 3 to 9 ms, a publisher after 30 to 80 ms. Neither
side counted the other before. Then the publisher counted 1 when `peer_subscribe` was called, and the latched message,
which the listener sends, arrived afterwards.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.rospy_shim.missions import Run, run_nodes

TALKS = """
    import rospy
    from std_msgs.msg import Int32

    class Listener(rospy.SubscribeListener):
        def peer_subscribe(self, topic, publish, publish_to_new):
            print("peer", round(rospy.get_time() % 100, 2), publisher.get_num_connections())
            publish_to_new(Int32(-1))

        def peer_unsubscribe(self, topic, remaining):
            print("left", remaining)

    rospy.init_node("talks")
    latch = rospy.get_param("latch", False)
    publisher = rospy.Publisher("count", Int32, subscriber_listener=Listener(), latch=latch, queue_size=10)
    counts = []
    for number in range(12):
        publisher.publish(number)
        counts.append(publisher.get_num_connections())
        rospy.sleep(0.05)
    print(counts)
    rospy.sleep(0.2)
"""
HEARS = """
    import rospy
    from std_msgs.msg import Int32

    rospy.init_node("hears")
    heard = []
    subscriber = rospy.Subscriber("count", Int32, lambda message: heard.append(message.data))
    print("at first", subscriber.get_num_connections())
    while not (subscriber.get_num_connections() or rospy.is_shutdown()):
        rospy.sleep(0.01)
    print("connected", round(rospy.get_time() % 100, 2))
    rospy.sleep(0.5)
    print(heard)
"""


def fly(folder: Path, delay_ms: int, latch: bool = False, tasks: str = "thread", **scripts: str) -> Run:
    nodes = {"TALKS": TALKS, "HEARS": HEARS} | scripts
    return run_nodes(folder, nodes, params={"latch": latch}, tasks=tasks, connection_delay_ns=delay_ms * 1_000_000)


@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_message_published_before_the_connection_is_lost(tmp_path: Path, tasks: str) -> None:
    run = fly(tmp_path, 220, tasks=tasks)
    assert run.printed["talks"] == ["peer 0.77 1", "[0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1]", "left 0"]
    assert run.printed["hears"] == ["at first 0", "connected 0.77", "[-1, 5, 6, 7, 8, 9, 10, 11]"]
    assert run.finished


def test_subscriber_is_connected_at_once_without_a_delay(tmp_path: Path) -> None:
    run = fly(tmp_path, 0)
    assert run.printed["hears"][:2] == ["at first 1", "connected 0.55"]


def test_latched_message_arrives_with_the_connection(tmp_path: Path) -> None:
    assert fly(tmp_path, 220, latch=True).printed["hears"][-1] == "[-1, -1, 5, 6, 7, 8, 9, 10, 11]"


def test_connection_before_the_first_callback_loses_no_message(tmp_path: Path) -> None:
    assert fly(tmp_path, 20, latch=True).printed["hears"][-1] == "[-1, -1, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10]"


def test_each_publisher_of_a_topic_connects_separately(tmp_path: Path) -> None:
    late = """
        import rospy
        from std_msgs.msg import Int32
        rospy.init_node("late")
        rospy.sleep(0.3)
        publisher = rospy.Publisher("count", Int32, queue_size=10)
        for number in range(100, 106):
            rospy.sleep(0.05)
            publisher.publish(number)
    """
    heard = fly(tmp_path, 120, LATE=late).printed["hears"][-1]
    assert heard == "[-1, 3, 4, 5, 6, 7, 8, 102, 9, 103, 10, 104, 11, 105]"


def test_subscriber_that_leaves_before_the_connection_is_never_counted(tmp_path: Path) -> None:
    leaves = """
        import rospy
        from std_msgs.msg import Int32
        rospy.init_node("hears")
        heard = []
        for pause in (0.1, 0.3):
            subscriber = rospy.Subscriber("count", Int32, lambda message: heard.append(message.data))
            rospy.sleep(pause)
            subscriber.unregister()
        rospy.sleep(0.3)
        print(heard)
    """
    run = fly(tmp_path, 220, HEARS=leaves)
    assert run.printed["hears"] == ["[-1, 7]"]
    assert run.printed["talks"] == ["peer 0.87 1", "left 0", "[0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0]"]


def test_returning_publisher_connects_again(tmp_path: Path) -> None:
    talks = """
        import rospy
        from std_msgs.msg import Int32
        rospy.init_node("talks")
        for start in (0, 100, 200):
            publisher = rospy.Publisher("count", Int32, queue_size=10)
            for number in range(start, start + (2 if start else 6)):
                publisher.publish(number)
                rospy.sleep(0.1)
            publisher.unregister()
    """
    run = fly(tmp_path, 220, TALKS=talks)
    assert run.printed["hears"][-1] == "[3, 4, 5]"


def test_ending_node_does_not_wait_for_its_connections(tmp_path: Path) -> None:
    run = fly(tmp_path, 60_000)
    assert run.printed["talks"] == [str([0] * 12)]
    assert run.finished


def test_services_need_no_topic_connection(tmp_path: Path) -> None:
    serves = """
        import rospy
        from std_srvs.srv import Empty, EmptyResponse
        rospy.init_node("serves")
        rospy.Service("now", Empty, lambda request: EmptyResponse())
        rospy.spin()
    """
    asks = """
        import rospy
        from std_srvs.srv import Empty
        rospy.init_node("asks")
        rospy.wait_for_service("now")
        before = rospy.get_time()
        rospy.ServiceProxy("now", Empty)()
        print(round(rospy.get_time() - before, 2))
    """
    assert fly(tmp_path, 500, SERVES=serves, ASKS=asks).printed["asks"] == ["0.0"]
