"""Programs that put on record what real ROS does."""
