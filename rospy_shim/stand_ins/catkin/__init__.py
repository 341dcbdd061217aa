"""A stand-in for the Python half of catkin, which original sources of ROS's tools ask where files are installed."""
