"""A node that asks ROS's graph libraries about itself and a talker, and prints the answers.

It runs on ROS as well; `ros_tools_answers.txt` is what it printed there (ROS Noetic, rosmaster 1.15.15).
"""

from xmlrpc.client import MultiCall, ServerProxy

import rosgraph
import rosgraph.impl.graph
import rosgraph.masterapi
import rosgraph.names
import rosgraph.network
import roslib.message
import rosmsg
import rosnode
import rosparam
import rospy
import rosservice
import rostopic
from std_msgs.msg import String


def ask(label, question):
    try:
        print(label, "->", question())
    except SystemExit as end:
        print(label, "exit", end.code)
    except Exception as error:
        print(label, "raised", type(error).__name__, error)


def in_order(state):
    return [sorted([name, sorted(nodes)] for name, nodes in part) for part in state]


def without_uris(text):
    return "\n".join(line.split("(")[0] for line in text.split("\n"))


rospy.init_node("asker")
subscriber = rospy.Subscriber("chatter", String, lambda message: None)
rospy.sleep(1.0)
master = rosgraph.Master("/asker")

ask("state", lambda: in_order(master.getSystemState()))
ask("types", lambda: sorted(master.getTopicTypes()))
ask("published", lambda: sorted(master.getPublishedTopics("/")))
ask("published below", lambda: master.getPublishedTopics("/ns"))
ask("node", lambda: master.lookupNode("/talker").startswith("http://"))
ask("no node", lambda: master.lookupNode("/nobody"))
ask("online", lambda: (rosgraph.is_master_online(), rosgraph.masterapi.is_online("http://localhost:1")))
ask("bad uri", lambda: rosgraph.Master("/x", "foo"))

ask("nodes", lambda: sorted(rosnode.get_node_names()))
ask("nodes below", lambda: rosnode.get_node_names("/talker"))
ask("ping", lambda: rosnode.rosnode_ping("/talker", max_count=1))
ask("ping nobody", lambda: rosnode.rosnode_ping("/nobody", max_count=1))
ask("ping all", lambda: [sorted(names) for names in rosnode.rosnode_ping_all()])
ask("node info", lambda: rosnode.get_node_info_description("/talker"))
ask("node list", lambda: rosnode.rosnodemain(["rosnode", "list"]))
ask("command", lambda: rosnode._rosnode_cmd_list(["rosnode", "list", "/talker"]))

ask("type", lambda: rostopic.get_topic_type("/chatter")[:2])
ask("type of field", lambda: rostopic.get_topic_type("/ns/numbers/layout/data_offset")[:2])
ask("no type", lambda: rostopic.get_topic_type("/nothing"))
ask("no field", lambda: rostopic.get_topic_type("/chatter/nothing"))
ask("class", lambda: rostopic.get_topic_class("/chatter")[0]._type)
ask("of a type", lambda: rostopic.find_by_type("std_msgs/String"))
ask("topic info", lambda: without_uris(rostopic.get_info_text("/chatter")))
ask("no topic info", lambda: rostopic.get_info_text("/nothing"))
ask(
    "topics",
    lambda: [sorted((name, kind, sorted(who)) for name, kind, who in side) for side in rostopic.get_topic_list()],
)
ask("field", lambda: (rostopic.msgevalgen("/data")(String("x")), rostopic.msgevalgen(""), rostopic.msgevalgen("/a[")))
ask("topic list", lambda: rostopic.rostopicmain(["rostopic", "list"]))
ask("publishers", lambda: rostopic.rostopicmain(["rostopic", "list", "-p"]))
ask("type command", lambda: rostopic.rostopicmain(["rostopic", "type", "/ns/numbers/layout"]))
ask("find command", lambda: rostopic.rostopicmain(["rostopic", "find", "std_msgs/String"]))
ask("info command", lambda: rostopic.rostopicmain(["rostopic", "info", "/nothing"]))

ask("services", lambda: rosservice.get_service_list(namespace="/flip"))
ask("service node", lambda: rosservice.get_service_node("/flip"))
ask("service type", lambda: rosservice.get_service_type("/flip"))
ask("no service type", lambda: rosservice.get_service_type("/nothing"))
ask("service uri", lambda: rosservice.get_service_uri("/flip").startswith("rosrpc://"))
ask("no service uri", lambda: rosservice.get_service_uri("/nothing"))
ask("service class", lambda: rosservice.get_service_class_by_name("/flip")._type)
ask("no service class", lambda: rosservice.get_service_class_by_name("/nothing"))
ask("services of a type", lambda: sorted(rosservice.rosservice_find("roscpp/SetLoggerLevel")))
ask("service args", lambda: rosservice.get_service_args("/flip"))
ask(
    "service header",
    lambda: sorted(rosservice.get_service_headers("/flip", rosservice.get_service_uri("/flip")).items()),
)
ask("service command", lambda: rosservice.rosservicemain(["rosservice", "type", "/flip"]))
ask("no service command", lambda: rosservice.rosservicemain(["rosservice", "info", "/nothing"]))

ask("param", lambda: rosparam.get_param("/talker/rate"))
ask("no param", lambda: rosparam.get_param("/nothing"))
ask("set", lambda: rosparam.set_param("/a/b", "{c: 1, d: [1, 2.5, x], e: deg(180), f: rad(pi/2)}"))
ask("get", lambda: rosparam.get_param("/a"))
ask("update", lambda: (rosparam.set_param_raw("/a/b", {"z": True}), rosparam.get_param("/a/b")))
ask("params", lambda: rosparam.list_params("/a"))
ask("dump", lambda: rosparam.dump_params(None, "/a"))
ask("get command", lambda: rosparam.yamlmain(["rosparam", "get", "/a"]))
ask("pretty", lambda: rosparam.yamlmain(["rosparam", "get", "-p", "/a"]))
ask("get nothing", lambda: rosparam.yamlmain(["rosparam", "get", "/nothing"]))
ask("set negative", lambda: rosparam.yamlmain(["rosparam", "set", "/below", "-5"]))
ask("negative", lambda: rosparam.get_param("/below"))
ask("set text", lambda: rosparam.yamlmain(["rosparam", "set", "/text", "hello world"]))
ask("get text", lambda: rosparam.yamlmain(["rosparam", "get", "/text"]))
ask("load", lambda: rosparam.load_str("_ns: foo\nx: 1\n---\ny: 2", "file", "/base"))
ask("binary", lambda: rosparam.load_str("x: !!binary aGVsbG8=\n", "file")[0][0]["x"].data)
ask("no file", lambda: rosparam.load_file("/no/such/file.yaml"))
ask("too big", lambda: rosparam.set_param_raw("/big", 2**40))
ask("delete", lambda: (rosparam.delete_param("/a"), rosparam.list_params("/a")))
ask("delete nothing", lambda: rosparam.delete_param("/a"))

ask("md5", lambda: rosmsg.rosmsg_md5(rosmsg.MODE_MSG, "std_msgs/String"))
ask("message", lambda: roslib.message.get_message_class("std_msgs/String")._type)
ask("no message", lambda: roslib.message.get_message_class("std_msgs/Nothing"))
ask("bad message", lambda: roslib.message.get_message_class("Nothing"))
ask("service", lambda: roslib.message.get_service_class("roscpp/SetLoggerLevel")._type)

proxy = rospy.get_master()
ask("proxy", lambda: ("/talker/rate" in proxy, proxy["/talker/rate"], proxy.getPid()[0]))
ask("proxy nothing", lambda: proxy["nothing"])
proxy["/given"] = 5
ask(
    "proxy given",
    lambda: (proxy["/given"], proxy.getParam("/given"), proxy.search_param("given"), "/given" in list(proxy)),
)
del proxy["/given"]
ask("proxy deleted", lambda: "/given" in proxy)

node = ServerProxy(master.lookupNode("/talker"))
ask("name", lambda: node.getName("/x"))
ask("publications", lambda: sorted(node.getPublications("/x")[2]))
ask("subscriptions", lambda: node.getSubscriptions("/x"))
ask("pid", lambda: node.getPid("/x")[:2])
ask("bus", lambda: [each[1:3] + each[4:6] for each in node.getBusInfo("/x")[2] if each[4] == "/chatter"])
ask("stats", lambda: [len(part) for part in node.getBusStats("/x")[2]][1:])
ask("request of another's", lambda: node.requestTopic("/x", "/nothing", [["TCPROS"]]))
ask("request of no protocol", lambda: node.requestTopic("/x", "/chatter", [["NONE"]]))
ask("update of param", lambda: node.paramUpdate("/x", "/q", 1))
ask("unknown method", lambda: node.foo("/x"))
ask("no caller", lambda: node.getPid())
calls = MultiCall(node)
calls.getName("/x")
calls.getPid()
ask("multicall", lambda: list(calls()))

picture = rosgraph.impl.graph.Graph()
ask(
    "picture",
    lambda: (
        picture.update(),
        sorted(picture.nn_nodes),
        sorted(picture.nt_nodes),
        sorted(map(str, picture.nt_all_edges)),
    ),
)
ask(
    "header",
    lambda: rosgraph.network.decode_ros_handshake_header(
        rosgraph.network.encode_ros_handshake_header({"a": "b", "c": "d=e"})
    ),
)
ask("resolve", lambda: [rosgraph.names.resolve_name(name, "/n/x") for name in ("", "a", "/b", "~c", "d//e/")])
ask("namespace", lambda: [rosgraph.names.namespace(name) for name in ("", "a", "/b", "/b/c/", "/")])
ask(
    "join",
    lambda: [rosgraph.names.ns_join(*pair) for pair in (("", "a"), ("/", "b"), ("~", "c"), ("x", "y"), ("x/", "~z"))],
)
ask("mappings", lambda: rosgraph.names.load_mappings(["a:=b", "_p:=1", "__name:=z", "/x/y:=q", "_:=3"]))
ask("script", lambda: [rosgraph.names.script_resolve_name("s", name) for name in ("", "a", "/b", "~c")])
ask("legal", lambda: [rosgraph.names.is_legal_name(name) for name in ("", "a", "/b", "~c", "a//b", "1", None)])
ask("own arguments", lambda: rosgraph.myargv(["a", "b:=c", "_d:=e", "-f"]))
ask("url", lambda: rosgraph.network.parse_http_host_and_port("http://host:3/"))

rates = rostopic.ROSTopicHz(-1)
listener = rospy.Subscriber("/chatter", String, rates.callback_hz)
rospy.sleep(2.5)
ask("rate", lambda: round(rates.get_hz()[0]))
ask("kill", lambda: rosnode.kill_nodes(["/talker", "/nobody"]))
rospy.sleep(1.0)
ask("left", lambda: rosnode.get_node_names())
