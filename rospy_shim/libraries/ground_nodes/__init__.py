"""Scripts of nodes that `cfepy topic`, `service` and `run --play` put into a mission, executed in a node's universe."""
