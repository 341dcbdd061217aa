"""Names and types of actions on the graph (rclpy.action.graph)."""

from __future__ import annotations

from typing import Any

from rclpy import _seam

_STATUS = "/_action/status"
_GOAL = "/_action/send_goal"


def get_action_names_and_types(node: Any) -> list[tuple[str, list[str]]]:
    """Return the actions that have a server or a client, and their types such as "example_interfaces/action/Fibonacci".

    Args:
        node: any node.
    """
    types = _types()
    topics = _seam.program.graph.topics.items()
    found = [
        name.removesuffix(_STATUS)
        for name, topic in topics
        if name.endswith(_STATUS) and (topic.links or topic.subscriptions)
    ]
    return [(name, [types[name]]) for name in sorted(found) if name in types]


def get_action_server_names_and_types_by_node(
    node: Any, remote_node_name: str, remote_node_namespace: str
) -> list[tuple[str, list[str]]]:
    """Return the actions that the program of a node serves."""
    return _by_node(remote_node_name, remote_node_namespace, "links")


def get_action_client_names_and_types_by_node(
    node: Any, remote_node_name: str, remote_node_namespace: str
) -> list[tuple[str, list[str]]]:
    """Return the actions of which the program of a node is a client."""
    return _by_node(remote_node_name, remote_node_namespace, "subscriptions")


def _by_node(name: str, namespace: str, side: str) -> list[tuple[str, list[str]]]:
    types = _types()
    program = _seam.program.graph.nodes.get(f"{namespace.rstrip('/')}/{name}")
    found = []
    for topic_name, topic in sorted(_seam.program.graph.topics.items()):
        action = topic_name.removesuffix(_STATUS)
        if action != topic_name and action in types and any(each.node is program for each in getattr(topic, side)):
            found.append((action, [types[action]]))
    return found


def _types() -> dict[str, str]:
    """Return the types of actions by name, as far as they have a server or were called."""
    services = _seam.program.graph.services.items()
    return {
        name.removesuffix(_GOAL): each.service.service_class._type.removesuffix("_SendGoal").replace("/", "/action/")
        for name, each in services
        if name.endswith(_GOAL)
    }
