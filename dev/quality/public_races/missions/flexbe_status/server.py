"""FlexBE's action server. It must know the engine's status after the engine has published it."""

import sys

import rospy
from flexbe_widget.behavior_action_server import BehaviorActionServer

rospy.init_node("server")
server = BehaviorActionServer()
rospy.sleep(0.5)
if server._engine_status is None:
    sys.exit("the engine has published its status, and the server does not know it")
