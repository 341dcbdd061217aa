"""bondpy for nodes: two nodes that detect each other's end (ROS's bondpy 1.8; the code is cfepy's own)."""
