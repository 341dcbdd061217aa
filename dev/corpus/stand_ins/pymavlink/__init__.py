"""A stand-in for MAVLink's Python package, for nodes that import it for the names of its constants."""
