"""Scripts of nodes that `cfepy rostopic`, `service`, `rosnode`, `run --play` and similar commands put into a mission.

They are executed in a node's universe.
"""
