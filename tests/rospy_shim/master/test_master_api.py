"""The master answers as rosmaster does: a node repeats every recorded request through xmlrpc.client."""

from __future__ import annotations

import json
import zlib
from pathlib import Path

from tests.rospy_shim.missions import run_nodes

ANSWERS = Path(__file__).parents[2] / "data" / "ros_master_answers.json"  # of rosmaster 1.15.15
ASKS = """
    import json, sys
    from xmlrpc.client import Fault, ServerProxy

    master = ServerProxy("http://localhost:11311")
    for method, arguments, _ in json.load(open({file!r})):
        try:
            answer = getattr(master, method)(*arguments)
        except Fault as fault:
            answer = [fault.faultCode, fault.faultString]
        print(json.dumps(answer))
"""


def test_shutdown_of_the_master_is_refused(tmp_path: Path) -> None:
    script = """
        import rospy
        rospy.init_node("n")
        print(rospy.get_master().shutdown("enough"), rospy.get_master().getPid()[0])
    """
    answers = run_nodes(tmp_path, {"N": script}).printed["n"]
    assert answers == ["[0, 'the master ends with the mission', 0] 1"]


def test_the_master_answers_as_rosmaster(tmp_path: Path) -> None:
    run = run_nodes(tmp_path, {"ASKS": ASKS.format(file=str(ANSWERS))}, seconds=1)
    recorded = json.loads(ANSWERS.read_text(encoding="utf-8"))
    got = [json.loads(line) for line in run.printed["ASKS"]]
    assert len(got) == len(recorded) > 70
    for (method, arguments, answer), mine in zip(recorded, got, strict=True):
        if (method, arguments) == ("getUri", ["/t"]):
            answer = [1, "", "http://cfepy:11311/"]
        assert mine == answer, f"{method}{arguments}"


def test_nodes_are_registered_and_can_be_unregistered(tmp_path: Path) -> None:
    talks = """
        import rospy
        from std_msgs.msg import String
        rospy.init_node("talks")
        publisher = rospy.Publisher("words", String, queue_size=1)
        while not rospy.is_shutdown():
            publisher.publish("x")
            rospy.sleep(0.1)
    """
    hears = """
        import rospy, rosgraph
        from std_msgs.msg import String
        rospy.init_node("hears")
        heard = []
        rospy.Subscriber("words", String, heard.append)
        rospy.sleep(0.5)
        master = rosgraph.Master("/talks")
        print(master.unregisterPublisher("/words", "http://other:1/"), len(heard) > 2)
        print(master.unregisterPublisher("/words", master.lookupNode("/talks")))
        before = len(heard)
        rospy.sleep(0.5)
        print(len(heard) - before, [name for name, _ in master.getSystemState()[0]])
        print(rosgraph.Master("/hears").unregisterSubscriber("/words", rospy.get_node_uri()))
        print(master.getSystemState()[1])
    """
    run = run_nodes(tmp_path, {"TALKS": talks, "HEARS": hears}, seconds=2)
    assert run.printed["hears"] == ["0 True", "1", "0 ['/rosout']", "1", "[]"]


def test_node_of_another_address_takes_over_a_name(tmp_path: Path) -> None:
    old = """
        import rospy
        rospy.init_node("same")
        rospy.spin()
    """
    other = """
        import rospy, rosgraph
        rospy.sleep(0.5)
        master = rosgraph.Master("/same")
        master.registerPublisher("/words", "std_msgs/String", "http://elsewhere:5/")
        rospy.sleep(0.5)
        print(master.lookupNode("/same"), master.getPublishedTopics("/"))
    """
    run = run_nodes(tmp_path, {"OLD": old, "OTHER": other}, seconds=2)
    assert run.printed["same"] == ["shutdown request: [/same] Reason: new node registered with same name"]
    assert run.printed["OTHER"] == ["http://elsewhere:5/ [['/words', 'std_msgs/String']]"]


def test_nodes_have_different_addresses(tmp_path: Path) -> None:
    script = """
        import rospy, rosgraph
        rospy.init_node("{name}")
        rospy.sleep(0.2)
        print(rosgraph.Master("/x").lookupNode(rospy.get_name()) == rospy.get_node_uri())
        rospy.sleep(0.5)
    """
    names = ["N114", "N227"]
    wanted = {zlib.crc32(name.encode()) % 30000 for name in names}
    assert len(wanted) == 1, "the names are to lead to one process number"
    run = run_nodes(tmp_path, {name: script.format(name=name.lower()) for name in names}, seconds=1)
    assert [run.printed[name.lower()] for name in names] == [["True"], ["True"]]
