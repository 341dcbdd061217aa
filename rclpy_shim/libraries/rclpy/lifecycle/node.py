"""`LifecycleNode`: a node whose state others control (rclpy.lifecycle.node)."""

from __future__ import annotations

from typing import Any, NamedTuple

from rclpy import _seam
from rclpy._rclpy_pybind11 import RCLError
from rclpy.lifecycle._state_machine import (
    STATES,
    TRANSITIONS,
    StateMachine,
    StateTransition,
    TransitionCallbackReturn,
)
from rclpy.lifecycle.managed_entity import ManagedEntity
from rclpy.lifecycle.publisher import LifecyclePublisher
from rclpy.node import Node
from rclpy.qos import QoSProfile

_CALLBACKS = {10: "configure", 11: "cleanup", 12: "shutdown", 13: "activate", 14: "deactivate", 15: "error"}
_SHUTDOWNS = {"unconfigured": 5, "inactive": 6, "active": 7}
_EVENTS = QoSProfile(depth=10)


class LifecycleState(NamedTuple):
    """A state."""

    label: str
    state_id: int


class LifecycleNodeMixin(ManagedEntity):
    """The part of a lifecycle node beside `Node`.

    Args:
        enable_communication_interface: offer the services, and publish transitions.
        callback_group: group of the services; None is the node's default one.

    Raises:
        RuntimeError: the class has no `Node` among its bases.
    """

    def __init__(self, *, enable_communication_interface: bool = True, callback_group: Any = None) -> None:
        if not isinstance(self, Node):
            raise RuntimeError("LifecycleNodeMixin uses Node fields so Node needs to bein the inheritance tree.")
        self._managed_entities: list[Any] = []  # not a set, as in rclpy: its order must be the same in each run
        self._events: Any = None
        self._state_machine = StateMachine(self._tell_transition)
        if not enable_communication_interface:
            return
        from lifecycle_msgs.msg import TransitionEvent
        from lifecycle_msgs.srv import ChangeState, GetAvailableStates, GetAvailableTransitions, GetState

        name = self.resolve_topic_name("~/transition_event")
        self._events = _seam.program.add_publisher(name, TransitionEvent, _EVENTS.quality(), self._logger.warning)
        for kind, service, answer in (
            (ChangeState, "change_state", self._on_change_state),
            (GetState, "get_state", self._on_get_state),
            (GetAvailableStates, "get_available_states", self._on_get_available_states),
            (GetAvailableTransitions, "get_available_transitions", self._on_get_available_transitions),
            (GetAvailableTransitions, "get_transition_graph", self._on_get_transition_graph),
        ):
            self.create_service(kind, f"~/{service}", answer, callback_group=callback_group)

    # -- transitions -------------------------------------------------------------------------------------------------

    def trigger_configure(self) -> TransitionCallbackReturn:
        """Configure the node. Returns the callback's result, or ERROR if the state does not allow it."""
        return self._change_state(1)

    def trigger_cleanup(self) -> TransitionCallbackReturn:
        """Clean the node up; see `trigger_configure`."""
        return self._change_state(2)

    def trigger_activate(self) -> TransitionCallbackReturn:
        """Activate the node; see `trigger_configure`."""
        return self._change_state(3)

    def trigger_deactivate(self) -> TransitionCallbackReturn:
        """Deactivate the node; see `trigger_configure`."""
        return self._change_state(4)

    def trigger_shutdown(self) -> TransitionCallbackReturn:
        """Finalize the node; see `trigger_configure`.

        Raises:
            RCLError: the state does not allow it.
        """
        number = _SHUTDOWNS.get(self._state_machine.current_state[1])
        if number is None:
            raise RCLError("Shutdown transtion not possible")
        return self._change_state(number)

    def _change_state(self, number: int) -> TransitionCallbackReturn:
        machine, logger = self._state_machine, self._logger  # type: ignore[attr-defined]
        before = LifecycleState(machine.current_state[1], machine.current_state[0])
        try:
            machine.trigger(number)
        except RCLError:
            logger.error(f"Unable to start transition {number} from current state {machine.current_state}")
            return TransitionCallbackReturn.ERROR
        result = self._call(before)
        machine.trigger(result.to_label())
        if result is TransitionCallbackReturn.ERROR:
            machine.trigger(self._call(before).to_label())
        return result

    def _call(self, before: LifecycleState) -> TransitionCallbackReturn:
        try:
            result = getattr(self, f"on_{_CALLBACKS[self._state_machine.state]}")(before)
        except Exception:  # as in rclpy, without a word
            return TransitionCallbackReturn.ERROR
        if not isinstance(result, TransitionCallbackReturn):
            raise AttributeError(f"'{type(result).__name__}' object has no attribute 'to_label'")
        return result

    def _tell_transition(self, start: int, goal: int) -> None:
        """Publish a transition; its number, label and time are empty, as in rcl."""
        if self._events is None:
            return
        from lifecycle_msgs.msg import State, TransitionEvent

        event = TransitionEvent(start_state=State(id=start, label=STATES[start]))
        event.goal_state = State(id=goal, label=STATES[goal])
        self._events.send(event)

    # -- managed entities --------------------------------------------------------------------------------------------

    def add_managed_entity(self, entity: ManagedEntity) -> None:
        """Let an entity follow the state.

        Raises:
            TypeError: it is not a `ManagedEntity`.
        """
        if not isinstance(entity, ManagedEntity):
            raise TypeError("Expected a rclpy.lifecycle.ManagedEntity instance.")
        if entity not in self._managed_entities:
            self._managed_entities.append(entity)

    def create_lifecycle_publisher(
        self, msg_type: Any, topic: str, qos_profile: Any, *, publisher_class: None = None, **kwargs: Any
    ) -> LifecyclePublisher:
        """Make a publisher that publishes only while the node is active; see `Node.create_publisher`.

        Raises:
            TypeError: `publisher_class` is given.
        """
        if publisher_class:
            raise TypeError("create_publisher() got an unexpected keyword argument 'publisher_class'")
        made = Node.create_publisher(
            self,  # type: ignore[arg-type]
            msg_type,
            topic,
            qos_profile,
            publisher_class=LifecyclePublisher,
            **kwargs,
        )
        self._managed_entities.append(made)
        return made  # type: ignore[return-value]

    def destroy_lifecycle_publisher(self, publisher: LifecyclePublisher) -> bool:
        """End such a publisher. Returns False if it is not the node's."""
        if publisher in self._managed_entities:
            self._managed_entities.remove(publisher)
        return self.destroy_publisher(publisher)  # type: ignore[attr-defined, no-any-return]

    def _managed(self, name: str, state: LifecycleState) -> TransitionCallbackReturn:
        for entity in self._managed_entities:
            result = getattr(entity, name)(state)
            if not isinstance(result, TransitionCallbackReturn):
                raise TypeError(
                    f"{name}() return value of class {type(entity)} should be `TransitionCallbackReturn`.\n"
                    f"Instance of the class that caused the failure: {entity}"
                )
            if result is not TransitionCallbackReturn.SUCCESS:
                return result
        return TransitionCallbackReturn.SUCCESS

    def on_configure(self, state: Any) -> TransitionCallbackReturn:
        """Configure the managed entities; the first one that does not succeed ends it."""
        return self._managed("on_configure", state)

    def on_cleanup(self, state: Any) -> TransitionCallbackReturn:
        """Clean the managed entities up; see `on_configure`."""
        return self._managed("on_cleanup", state)

    def on_shutdown(self, state: Any) -> TransitionCallbackReturn:
        """Finalize the managed entities; see `on_configure`."""
        return self._managed("on_shutdown", state)

    def on_activate(self, state: Any) -> TransitionCallbackReturn:
        """Activate the managed entities; see `on_configure`."""
        return self._managed("on_activate", state)

    def on_deactivate(self, state: Any) -> TransitionCallbackReturn:
        """Deactivate the managed entities; see `on_configure`."""
        return self._managed("on_deactivate", state)

    def on_error(self, state: Any) -> TransitionCallbackReturn:
        """Let the managed entities process an error; see `on_configure`."""
        return self._managed("on_error", state)

    # -- services ----------------------------------------------------------------------------------------------------

    def _on_change_state(self, request: Any, response: Any) -> Any:
        number = request.transition.id
        if request.transition.label:
            try:
                number = self._state_machine.number_of(request.transition.label)
            except RCLError:
                response.success = False
                return response
        response.success = self._change_state(number) is TransitionCallbackReturn.SUCCESS
        return response

    def _on_get_state(self, request: Any, response: Any) -> Any:
        response.current_state.id, response.current_state.label = self._state_machine.current_state
        return response

    def _on_get_available_states(self, request: Any, response: Any) -> Any:
        from lifecycle_msgs.msg import State

        response.available_states = [State(id=number, label=label) for number, label in STATES.items()]
        return response

    def _on_get_available_transitions(self, request: Any, response: Any) -> Any:
        response.available_transitions = _described(self._state_machine.available())
        return response

    def _on_get_transition_graph(self, request: Any, response: Any) -> Any:
        response.available_transitions = _described(TRANSITIONS)
        return response


def _described(transitions: list[StateTransition]) -> list[Any]:
    """Return transitions as lifecycle_msgs/TransitionDescription."""
    from lifecycle_msgs.msg import State, Transition, TransitionDescription

    return [
        TransitionDescription(
            transition=Transition(id=each.number, label=each.label),
            start_state=State(id=each.start, label=STATES[each.start]),
            goal_state=State(id=each.goal, label=STATES[each.goal]),
        )
        for each in transitions
    ]


class LifecycleNode(LifecycleNodeMixin, Node):
    """A lifecycle node.

    Args:
        node_name: its name.
        enable_communication_interface: offer the services, and publish transitions.
        kwargs: options of `Node`.
    """

    def __init__(self, node_name: str, *, enable_communication_interface: bool = True, **kwargs: Any) -> None:
        Node.__init__(self, node_name, **kwargs)
        LifecycleNodeMixin.__init__(self, enable_communication_interface=enable_communication_interface)

    def destroy_node(self) -> None:
        """End the node with all of its entities."""
        if self._events is not None:
            _seam.program.close(self._events)
        super().destroy_node()
