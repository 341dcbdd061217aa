"""sensor_msgs for nodes: the package's code besides the messages, which is `sensor_msgs.point_cloud2`."""
