"""bondpy for nodes: two nodes that notice when the other one ends (ROS's bondpy 1.8; the code is cfepy's own)."""
