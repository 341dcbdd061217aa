"""rospy.get_master and rospy.msproxy.MasterProxy."""

from __future__ import annotations

from pathlib import Path

from rospy_shim.types.config import NodeConfig
from tests.rospy_shim.missions import run_nodes


def test_names_resolve_as_in_the_node(tmp_path: Path) -> None:
    script = """
        import rospy, rospy.msproxy
        rospy.init_node("node")
        master = rospy.get_master()
        print(master is rospy.client.get_master(), isinstance(master, rospy.msproxy.MasterProxy))
        master["~own"] = 1
        master["old"] = 2
        print(sorted(master), rospy.get_param("~own"), master["~own"], "~own" in master, "other" in master)
        print(master.getParam("old"), master.get_param_cached("~own"))
        print(master.search_param("own"), master.search_param("nothing"), master.lookupNode("node")[0])
        del master["~own"]
        rospy.sleep(0.1)  # until the master has reported it to the cache
        for use in (lambda: master["~own"], lambda: master.__delitem__("~own"), lambda: master.get_param_cached("no")):
            try:
                use()
            except KeyError as error:
                print("KeyError", error)
        try:
            master.search_param("~own")
        except rospy.ROSException as error:
            print(error)
    """
    nodes = {"NODE": NodeConfig("node", namespace="/ns", remap={"old": "new"})}
    run = run_nodes(tmp_path, {"NODE": script}, seconds=1, nodes=nodes)
    assert run.printed["ns/node"] == [
        "True True",
        "['/ns/new', '/ns/node/own'] 1 1 True False",
        "[1, 'Parameter [/ns/new]', 2] 1",
        "/ns/node/own None 1",
        "KeyError '~own'",
        "KeyError '~own'",
        "KeyError 'no'",
        "cannot search for parameter: Internal failure: invalid key",
    ]
