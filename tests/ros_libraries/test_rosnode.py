"""rosnode: dead nodes, machines, connections. test_ros_tools.py has the other tests."""

from __future__ import annotations

from pathlib import Path

from tests.rospy_shim.missions import run_nodes

TALKS = """
    import rospy
    from std_msgs.msg import String
    rospy.init_node("talks")
    publisher = rospy.Publisher("/words", String, queue_size=1)
    rospy.spin()
"""


def said(folder: Path, script: str) -> list[str]:
    """Return a node's output beside a node that publishes."""
    run = run_nodes(folder, {"TALKS": TALKS, "TOOL": script}, seconds=5)
    return run.printed["tool"]


def test_stale_registrations(tmp_path: Path) -> None:
    script = """
        import rospy, rosgraph, rosnode
        rospy.init_node("tool")
        ghost = rosgraph.Master("/ghost")
        ghost.registerPublisher("/words", "std_msgs/String", "http://nowhere:5/")
        ghost.registerSubscriber("/words", "std_msgs/String", "http://nowhere:5/")
        ghost.registerService("/haunt", "rosrpc://nowhere:6", "http://nowhere:5/")
        rospy.sleep(0.5)
        print(sorted(rosnode.get_node_names()))
        print([sorted(names) for names in rosnode.rosnode_ping_all()])
        master = rosgraph.Master("/tool")
        try:
            rosnode.get_node_connection_info_description("http://nowhere:5/", master)
        except rosnode.ROSNodeIOException as error:
            print(error)
        rosnode.cleanup_master_blacklist(master, ["/ghost"])
        print(sorted(rosnode.get_node_names()))
        ghost.registerPublisher("/words", "std_msgs/String", "http://nowhere:5/")
        rosnode.cleanup_master_whitelist(master, ["/tool", "/talks"])
        print(sorted(rosnode.get_node_names()))
    """
    assert said(tmp_path, script) == [
        "['/ghost', '/talks', '/tool']",
        "ERROR: connection refused to [http://nowhere:5/]",
        "[['/talks', '/tool'], ['/ghost']]",
        "Communication with node[http://nowhere:5/] failed!",
        "Unregistering /ghost",
        "['/talks', '/tool']",
        "['/talks', '/tool']",
    ]


def test_machines_connections_and_commands(tmp_path: Path) -> None:
    script = """
        import rospy, rosgraph, rosnode
        from std_msgs.msg import String
        rospy.init_node("tool")
        rospy.Subscriber("/words", String, lambda message: None)
        rospy.sleep(0.5)
        print(rosnode.get_machines_by_nodes(), sorted(rosnode.get_nodes_by_machine("cfepy")))
        master = rosgraph.Master("/tool")
        text = rosnode.get_node_connection_info_description(rospy.get_node_uri(), master)
        print([line for line in text.splitlines() if "words" in line or "talks" in line or "inbound" in line])
        for command in ("ping -c 2 talks", "machine", "info -q talks", "kill nobody", "what", "ping -c 1 nobody"):
            try:
                rosnode.rosnodemain(["rosnode", *command.split()])
            except SystemExit as end:
                print("exit", end.code)
        try:
            rosnode._fullusage()
        except SystemExit as end:
            print("exit", end.code)
    """
    lines = said(tmp_path, script)
    uri = lines[1].partition("(")[2].partition(")")[0]
    assert lines[0] == "['cfepy'] ['/talks', '/tool']"
    assert lines[1] == f"[' * topic: /words', '    * to: /talks ({uri})', '    * direction: inbound']"
    assert lines[2:4] == ["rosnode: node is [/talks]", "pinging /talks with a timeout of 3.0s"]
    assert [line.split("\t")[0] for line in lines[4:6]] == [f"xmlrpc reply from {uri}"] * 2
    assert lines[7:10] == ["exit 0", "cfepy", "exit 0"]
    assert lines[10:13] == ["-" * 80, "Node [/talks]", "Publications: "]
    assert [line for line in lines if "Failed to kill" in line or line == " * /nobody"]
    assert [line for line in lines if line.startswith("exit")] == ["exit 0"] * 3 + [
        *("exit 1", "exit 64", "exit 0", "exit 64")
    ]


def test_md5_of_a_missing_message_is_reported_with_status_0_as_on_ros(tmp_path: Path) -> None:
    script = """
        import sys, rosmsg
        for name in ("nope/Nope", "std_msgs/Nope", "Nope"):
            sys.argv = ["rosmsg", "md5", name]
            try:
                rosmsg.rosmsgmain()
            except SystemExit as end:
                print("exit", end.code)
    """
    lines = run_nodes(tmp_path, {"TOOL": script}).printed["TOOL"]
    assert [line for line in lines if line.startswith("exit")] == ["exit 0"] * 3
