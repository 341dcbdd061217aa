"""The real world at the edge of a paced run: real sockets on the loopback interface. May import everything but the CLI.

Nothing in the simulation knows of this package; whoever runs a mission puts it beside the pacer.
"""
