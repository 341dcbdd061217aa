"""`rospy.impl.masterslave.ROSHandler`: programs find its only object through `gc`, and get changes of parameters.

Duckietown's nodes look for it there. The expected calls are the calls of rospy 1.15 and rosmaster 1.15.
"""

from __future__ import annotations

from pathlib import Path

from tests.rospy_shim.missions import run_nodes

LISTENS = """
    import gc
    import rospy

    def handlers():
        return [each for each in gc.get_objects() if isinstance(each, rospy.impl.masterslave.ROSHandler)]

    rospy.init_node("listens")
    [handler] = handlers()
    print(handler.getName("/x"), handler.uri == rospy.get_node_uri(), handler.getPublications("/x")[2][0][0])
    usual = handler.paramUpdate

    def update(*arguments):
        print(arguments, usual(*arguments))

    handler.paramUpdate = update
    for key in ("/listens/rate", "/arm"):
        rospy.get_master().target.subscribeParam(rospy.get_caller_id(), handler.uri, key)
    rospy.set_param("~rate", 5)  # a node gets no call for its own changes
    rospy.sleep(2)
    rospy.get_master().target.unsubscribeParam(rospy.get_caller_id(), handler.uri, "/listens/rate")
    rospy.sleep(1)
"""
CHANGES = """
    import rospy

    rospy.init_node("changes")
    rospy.sleep(0.5)
    rospy.set_param("/listens/rate", 7)
    rospy.sleep(0.1)
    rospy.set_param("/listens", {"rate": 8, "other": 1})
    rospy.sleep(0.1)
    rospy.set_param("/unheard", 1)
    rospy.set_param("/arm/speed", 3)
    rospy.sleep(0.1)
    rospy.delete_param("/listens/rate")
    rospy.sleep(1.7)
    rospy.set_param("/listens/rate", 9)
"""


def test_program_finds_the_handler_and_gets_changes_of_parameters(tmp_path: Path) -> None:
    result = run_nodes(tmp_path, {"LISTENS": LISTENS, "CHANGES": CHANGES}, seconds=5)
    assert result.printed["listens"] == [
        "(1, '', '/listens') True /rosout",
        "('/master', '/listens/rate/', 7) (-1, 'not subscribed', 0)",
        "('/master', '/listens/rate/', 8) (-1, 'not subscribed', 0)",
        "('/master', '/arm/speed/', 3) (-1, 'not subscribed', 0)",
        "('/master', '/listens/rate/', {}) (-1, 'not subscribed', 0)",
    ]
