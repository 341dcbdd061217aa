"""rosservice: calling by name. test_ros_tools.py tests its information on services."""

from __future__ import annotations

from pathlib import Path

from tests.rospy_shim.missions import run_nodes

OFFERS = """
    import rospy
    from std_srvs.srv import SetBool, SetBoolResponse, Trigger
    rospy.init_node("offers")
    set_bool = rospy.Service("/set", SetBool, lambda request: SetBoolResponse(True, "got %s" % request.data))
    trigger = rospy.Service("/fail", Trigger, lambda request: None)
    rospy.spin()
"""


def said(folder: Path, script: str) -> list[str]:
    """Return a node's output beside a node that offers services."""
    run = run_nodes(folder, {"OFFERS": OFFERS, "TOOL": script}, seconds=3)
    return next(lines for name, lines in run.printed.items() if name != "offers")


def test_calls(tmp_path: Path) -> None:
    script = """
        import rosservice, rospy
        rospy.init_node("tool")
        rospy.sleep(0.3)
        for values in ([True], [{"data": False}]):
            request, response = rosservice.call_service("/set", values)
            print(request.data, response.message)
        for name, values in (("/set", [1, 2]), ("/set", ["x"]), ("/fail", []), ("/none", [])):
            try:
                rosservice.call_service(name, values)
            except rosservice.ROSServiceException as error:
                print(str(error).splitlines()[0])
        print(rosservice.has_service_args("/set"), rosservice.has_service_args("/fail"))
        try:
            rosservice.get_service_headers("/set", "nonsense")
        except rosservice.ROSServiceException as error:
            print(error)
        try:
            rosservice.get_service_headers("/set", "rosrpc://nowhere:5")
        except rosservice.ROSServiceIOException as error:
            print(error)
    """
    lines = said(tmp_path, script)
    assert lines[:3] == ["True got True", "False got False", "Incompatible arguments to call service:"]
    assert lines[3] == "Unable to send request. One of the fields has an incorrect type:"
    assert lines[4].startswith("service [/fail] responded with an error")
    assert lines[5:] == [
        "Service [/none] is not available.",
        "True False",
        "service [/set] has an invalid RPC URI [nonsense]",
        "Unable to communicate with service [/set], address [rosrpc://nowhere:5]",
    ]


def test_commands(tmp_path: Path) -> None:
    script = """
        import rosservice, time
        time.sleep(0.3)
        for command in (
            "call /set true", "call -v --wait set false", "list -n /set", "args /set",
            "node /set", "find std_srvs/Trigger", "info /set", "uri /none", "what",
        ):
            try:
                rosservice.rosservicemain(["rosservice", *command.split()])
            except SystemExit as end:
                print("exit", end.code)
    """
    lines = said(tmp_path, script)
    assert lines[:2] == ["success: True", 'message: "got True"']
    assert lines[2:6] == ["data: False", "---", "success: True", 'message: "got False"']
    assert lines[6:11] == ["/set /offers", "data", "/offers", "/fail", "Node: /offers"]
    assert lines[12:16] == ["Type: std_srvs/SetBool", "Args: data", "Unknown service [/none]", "exit 1"]
    assert lines[-1] == "exit 64"
