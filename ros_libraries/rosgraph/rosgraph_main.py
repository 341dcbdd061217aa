"""rosgraph.rosgraph_main: the command `rosgraph`, which prints the graph each second."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterable

from rosgraph.impl.graph import Graph
from rosgraph.masterapi import Master


def fullusage() -> None:
    """Say how the command is used."""
    print("rosgraph is a command-line tool for debugging the ROS Computation Graph.\n\nUsage:\n\trosgraph\n")


def rosgraph_main() -> None:
    """Run the command."""
    if len(sys.argv) > 1:
        fullusage()
        if sys.argv[1:] not in (["-h"], ["--help"]):
            sys.exit(-1)
        return
    if not Master("rosgraph").is_online():
        print("ERROR: Unable to communicate with master!", file=sys.stderr)
        return
    graph = Graph()
    try:
        while True:
            graph.update()
            print("\n".join(_lines(graph)))
            time.sleep(1.0)
    except KeyboardInterrupt:
        pass


def _lines(graph: Graph) -> Iterable[str]:
    if not graph.nn_nodes and not graph.srvs:
        yield "empty"
        return
    yield "\nNodes:"
    for node in sorted(graph.nn_nodes):
        yield f"  {node} :\n    Inbound:"
        yield from (f"      {edge.start}" for edge in graph.nn_edges if edge.end == node)
        yield "    Outbound:"
        yield from (f"      {edge.end}" for edge in graph.nn_edges if edge.start == node)
    yield "Services:"
    yield from (f"  {service}" for service in sorted(graph.srvs))
