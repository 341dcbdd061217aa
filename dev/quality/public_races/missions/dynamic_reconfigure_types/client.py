"""Changes a parameter as soon as the client exists."""

import dynamic_reconfigure.client
import rospy

rospy.init_node("client")
client = dynamic_reconfigure.client.Client("server", timeout=2)
client.get_parameter_descriptions(timeout=2)
client.update_configuration({"speed_9": 2})
