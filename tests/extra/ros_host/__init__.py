"""ROS on this computer and a paced mission as one graph."""
