"""A stand-in for the Python half of catkin; original sources of ROS's tools use it to find installed files."""
