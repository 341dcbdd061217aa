"""Asks for transforms. Each request must have an answer."""

import buffer_client
import rospy

rospy.init_node("client")
client = buffer_client.BufferClient("tf2_buffer_server")
client.wait_for_server(rospy.Duration(1))
for _ in range(3):
    client.lookup_transform("base", "arm", rospy.Time(0), rospy.Duration(0.1))
