"""sensor_msgs for nodes: the code beside the messages, which is `sensor_msgs.point_cloud2`."""
