"""Internals of a node that tools read: topics, connections, services, statistics of subscribers."""

from __future__ import annotations

from pathlib import Path

from tests.rospy_shim.missions import run_nodes


def run(tmp_path: Path, body: str) -> list[str]:
    result = run_nodes(tmp_path, {"PROBE": "import rospy\nfrom std_msgs.msg import String\n" + body})
    return result.printed.get("probe", result.lines)


def test_topics_connections_and_services(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
from rospy.impl.registration import Registration, get_service_manager, get_topic_manager
rospy.init_node("probe", disable_rosout=True)
publisher = rospy.Publisher("chat", String, queue_size=1)
subscriber = rospy.Subscriber("chat", String, print, queue_size=3)
rospy.sleep(0.2)
topics = get_topic_manager()
print(topics.get_publications(), topics.get_subscriptions(), topics.get_topics())
print([row[1:6] for row in topics.get_pub_sub_info()][0])
print(topics.get_impl(Registration.PUB, "/chat") is publisher.impl, publisher.impl.has_connection("/probe"))
print(subscriber.impl.queue_size, subscriber.impl.callbacks == [(print, None)], subscriber.get_num_connections())
print([name for name, uri in get_service_manager().get_services()])
subscriber.unregister()
print(topics.has_subscription("/chat"), publisher.impl.ref_count)
""",
    )
    assert lines == [
        "[['/chat', 'std_msgs/String']] [['/chat', 'std_msgs/String']] {'/chat'}",
        "('/probe', 'o', 'TCPROS', '/chat', True)",
        "True True",
        "3 True 1",
        "['/probe/get_loggers', '/probe/set_logger_level']",
        "False 1",
    ]


def test_statistics_of_a_subscriber(tmp_path: Path) -> None:
    lines = run(
        tmp_path,
        """
from rosgraph_msgs.msg import TopicStatistics
rospy.set_param("/enable_statistics", True)
rospy.set_param("/statistics_window_min_elements", 5)
rospy.init_node("probe")
figures = []
rospy.Subscriber("/statistics", TopicStatistics, figures.append)
publisher = rospy.Publisher("chat", String, queue_size=1)
rospy.Subscriber("chat", String, lambda message: None)
rospy.sleep(0.2)
rate = rospy.Rate(20)
for _ in range(50):
    publisher.publish("ten bytes!")
    rate.sleep()
last = figures[-1]
print(last.topic, last.node_pub, last.node_sub, last.delivered_msgs, last.traffic)
print(round(last.period_mean.to_sec(), 3), last.dropped_msgs)
""",
    )
    assert lines[0].startswith("/chat /probe /probe ")
    assert int(lines[0].split()[-1]) == 14 * int(lines[0].split()[-2])
    assert lines[1] == "0.05 0"
