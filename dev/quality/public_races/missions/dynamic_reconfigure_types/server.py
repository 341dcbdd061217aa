"""A server with one parameter, as dynamic_reconfigure's server sends it."""

import rospy
from dynamic_reconfigure.msg import Config, ConfigDescription, Group, GroupState, IntParameter, ParamDescription
from dynamic_reconfigure.srv import Reconfigure, ReconfigureResponse

rospy.init_node("server")
config = Config(ints=[IntParameter("speed", 1)], groups=[GroupState("Default", True, 0, 0)])
rospy.Service("~set_parameters", Reconfigure, lambda request: ReconfigureResponse(config))
group = Group(name="Default", type="", parameters=[ParamDescription("speed", "int", 0, "", "")])
description = ConfigDescription(
    [group], Config(ints=[IntParameter("speed", 9)]), Config(ints=[IntParameter("speed", 0)]), config
)
rospy.Publisher("~parameter_descriptions", ConfigDescription, queue_size=1, latch=True).publish(description)
rospy.Publisher("~parameter_updates", Config, queue_size=1, latch=True).publish(config)
rospy.spin()
