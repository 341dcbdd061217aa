"""A node's answers at its URI."""

from __future__ import annotations

from pathlib import Path

from tests.rospy_shim.missions import run_nodes

ASKED = """
    import rospy
    from std_msgs.msg import Int32, String
    from std_srvs.srv import Empty
    rospy.init_node("asked")
    rospy.on_shutdown(lambda: print("hook"))
    publisher = rospy.Publisher("words", String, queue_size=1)
    subscriber = rospy.Subscriber("numbers", Int32, lambda message: None)
    service = rospy.Service("~reset", Empty, lambda request: [])
    rospy.sleep(0.3)
    publisher.publish("x")
    rospy.spin()
    print("end")
"""
HEAD = """
    import rospy, rosgraph
    from std_msgs.msg import Int32, String
    from xmlrpc.client import ServerProxy
    rospy.init_node("asks")
    rospy.Subscriber("words", String, lambda message: None)
    publisher = rospy.Publisher("numbers", Int32, queue_size=1)
    rospy.sleep(0.5)
    node = ServerProxy(rosgraph.Master("/asks").lookupNode("/asked"))
"""


def ask(folder: Path, questions: str) -> list[str]:
    """Return the output of a node that queries another one."""
    return run_nodes(folder, {"ASKED": ASKED, "ASKS": HEAD + questions}, seconds=2).printed["asks"]


def test_connections(tmp_path: Path) -> None:
    questions = """
    print(node.getSubscriptions("/x"), sorted(node.getPublications("/x")[2]))
    for _, other, way, transport, topic, connected, text in node.getBusInfo("/x")[2]:
        print(other == rospy.get_node_uri() or other, way, transport, topic, connected, text.split(" [")[0])
    sent, received, services = node.getBusStats("/x")[2]
    print([each for each in sent if each[0] == "/words"], received, services)
    """
    printed = ask(tmp_path, questions)
    assert printed[0] == "[1, 'subscriptions', [['/numbers', 'std_msgs/Int32']]] [" + ", ".join(
        ["['/rosout', 'rosgraph_msgs/Log']", "['/words', 'std_msgs/String']]"]
    )
    assert printed[1].startswith("/asks o cFE SB /words True cFE SB connection on MsgId 0x0")
    assert printed[2].startswith("True i cFE SB /numbers True cFE SB connection on MsgId 0x0")
    assert printed[3] == "[['/words', 5, [[1, 5, 1, True]]]] [['/numbers', [[2, 0, 0, -1, True]]]] []"


def test_updates_of_publishers_and_cached_parameters_are_accepted(tmp_path: Path) -> None:
    questions = """
    uri = rosgraph.Master("/x").lookupNode("/asked")
    print(node.paramUpdate("/x", "/p", 1))
    rosgraph.Master("/asked").subscribeParam(uri, "/p")  # the node itself has not cached it
    print(node.paramUpdate("/x", "/p", 1), node.paramUpdate("/x", "p", 1)[:2], node.paramUpdate("/x", "", 1)[:2])
    print(node.publisherUpdate("/x", "/words", [uri]), node.publisherUpdate("/x", "/words", "no list")[:2])
    print(node.publisherUpdate("/x", "/words", ["no uri"])[1], node.publisherUpdate("/x", "/words", [1])[1])
    """
    assert ask(tmp_path, questions) == [
        "[-1, 'not subscribed', 0]",
        "[-1, 'not subscribed', 0] [-1, 'ERROR: parameter [parameter_key] must be a globally referenced name']"
        " [-1, 'ERROR: parameter [parameter_key] must be a non-empty string']",
        "[1, '', 0] [-1, 'ERROR: param [publishers] must be a list']",
        "ERROR: param [publishers] does not contain valid URLs [no uri]"
        " ERROR: param [publishers] must be a list of strings",
    ]


def test_services_and_names(tmp_path: Path) -> None:
    questions = """
    print(node.getName("/x"), node.getUri("/x")[2] == rosgraph.Master("/x").lookupNode("/asked"))
    print(node.getMasterUri("/x"), node.getServiceHeader("/x", "/nothing"))
    print(sorted(node.getServiceHeader("/x", "/asked/reset")[2].items()))
    print(node.requestTopic("/x", "/words", [["TCPROS"]]), node.requestTopic("/x", "/numbers", [["TCPROS"]]))
    """
    assert ask(tmp_path, questions) == [
        "[1, '', '/asked'] True",
        "[1, 'http://cfepy:11311', 'http://cfepy:11311'] [-1, 'Not a provider of [/nothing]', {}]",
        "[('callerid', '/asked'), ('md5sum', 'd41d8cd98f00b204e9800998ecf8427e'), ('service', '/asked/reset'),"
        " ('type', 'std_srvs/Empty')]",
        "[0, 'no supported protocol implementations', []] [-1, 'Not a publisher of [/numbers]', []]",
    ]


def test_shutdown(tmp_path: Path) -> None:
    questions = """
    print(node.shutdown("/x", "enough"))
    rospy.sleep(0.6)
    print([name for name, _ in rosgraph.Master("/x").getSystemState()[2] if "asked" in name])
    """
    run = run_nodes(tmp_path, {"ASKED": ASKED, "ASKS": HEAD + questions}, seconds=2)
    assert run.printed["asks"] == ["[1, 'shutdown', 0]", "[]"]
    assert run.printed["asked"] == ["shutdown request: enough", "hook", "end"]
