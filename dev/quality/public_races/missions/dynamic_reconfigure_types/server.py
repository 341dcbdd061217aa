"""A server with many parameters, as dynamic_reconfigure's server sends them."""

import rospy
from dynamic_reconfigure.msg import Config, ConfigDescription, Group, GroupState, IntParameter, ParamDescription
from dynamic_reconfigure.srv import Reconfigure, ReconfigureResponse

NAMES = [f"speed_{number}" for number in range(10)]


def config_of(value):
    return Config(ints=[IntParameter(name, value) for name in NAMES], groups=[GroupState("Default", True, 0, 0)])


rospy.init_node("server")
config = config_of(1)
rospy.Service("~set_parameters", Reconfigure, lambda request: ReconfigureResponse(config))
group = Group(name="Default", type="", parameters=[ParamDescription(name, "int", 0, "", "") for name in NAMES])
description = ConfigDescription([group], config_of(9), config_of(0), config)
rospy.Publisher("~parameter_descriptions", ConfigDescription, queue_size=1, latch=True).publish(description)
rospy.Publisher("~parameter_updates", Config, queue_size=1, latch=True).publish(config)
rospy.spin()
