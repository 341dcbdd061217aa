"""Listeners that a library adds to a publisher by way of its `impl`, as rosbridge does."""

from __future__ import annotations

from pathlib import Path

from tests.rospy_shim.missions import run_nodes


def test_a_listener_can_be_added_and_removed(tmp_path: Path) -> None:
    talks = """
        import rospy
        from std_msgs.msg import String
        rospy.init_node("talks")
        publisher = rospy.Publisher("words", String, queue_size=1)
        class Listener(rospy.SubscribeListener):
            def peer_subscribe(self, topic, publish, publish_to_new):
                publish_to_new("welcome")
        listener = Listener()
        publisher.impl.add_subscriber_listener(listener)
        rospy.sleep(0.5)
        print(listener in publisher.impl.subscriber_listeners)
        publisher.impl.subscriber_listeners.remove(listener)
        rospy.sleep(1.0)
    """
    hears = """
        import rospy
        from std_msgs.msg import String
        rospy.init_node("hears")
        for _ in range(2):
            rospy.sleep(0.2)
            subscriber = rospy.Subscriber("words", String, lambda message: print(message.data))
            rospy.sleep(0.2)
            subscriber.unregister()
            rospy.sleep(0.4)
        print("end")
    """
    run = run_nodes(tmp_path, {"TALKS": talks, "HEARS": hears}, seconds=2)
    assert run.printed["talks"] == ["True"]
    assert run.printed["hears"] == ["welcome", "end"]
