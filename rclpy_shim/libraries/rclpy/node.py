"""`Node`: a node with its publishers, subscriptions, services, clients, timers and parameters (rclpy.node)."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NoReturn

from rclpy import _seam
from rclpy._names import (
    Arguments,
    expand_topic_name,
    full_name_of,
    parse_arguments,
    validate_full_topic_name,
    validate_namespace,
    validate_node_name,
    validate_topic_name,
)
from rclpy._overrides import overrides_of
from rclpy._parameters import SIM_TIME, ParameterStore
from rclpy.callback_groups import CallbackGroup, MutuallyExclusiveCallbackGroup
from rclpy.client import Client
from rclpy.clock import Clock, ROSClock
from rclpy.context import Context, get_default_context
from rclpy.exceptions import NotInitializedException
from rclpy.guard_condition import GuardCondition
from rclpy.logging import RcutilsLogger, get_logger, published
from rclpy.parameter import Parameter
from rclpy.parameter_service import ParameterService
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile, profile_of, qos_profile_parameters, qos_profile_services_default
from rclpy.service import Service
from rclpy.subscription import Subscription
from rclpy.timer import Rate, Timer

HIDDEN_NODE_PREFIX = "_"
_NOT_A_TYPE = (
    "This might be a ROS 1 message type but it should be a ROS 2 message type. Make sure to source your ROS 2 workspace"
    " after your ROS 1 workspace."
)


class Node(ParameterStore):
    """A node.

    Args:
        node_name: its name, unless the command line has another one.
        context: its context; None takes the default one.
        cli_args: arguments for this node alone, before the program's.
        namespace: its namespace; None is the root.
        use_global_arguments: take the program's arguments, too.
        enable_rosout: publish its log on /rosout.
        start_parameter_services: offer the services for its parameters.
        parameter_overrides: values that replace the command line's.
        allow_undeclared_parameters: parameters need not be declared.
        automatically_declare_parameters_from_overrides: declare all parameters that the command line names.
        options: accepted if they are None or False.

    Raises:
        NotInitializedException: the context is not initialized.
        InvalidNodeNameException, InvalidNamespaceException: a name breaks ROS's rules.
        NotImplementedError: an option that cfepy does not have yet.
    """

    def __init__(
        self,
        node_name: str,
        *,
        context: Context | None = None,
        cli_args: list[str] | None = None,
        namespace: str | None = None,
        use_global_arguments: bool = True,
        enable_rosout: bool = True,
        rosout_qos_profile: QoSProfile | int | None = None,
        start_parameter_services: bool = True,
        parameter_overrides: list[Parameter] | None = None,
        allow_undeclared_parameters: bool = False,
        automatically_declare_parameters_from_overrides: bool = False,
        **options: Any,
    ) -> None:
        for name, value in options.items():
            if value:
                raise NotImplementedError(f"cfepy does not have the option {name} for nodes of ROS 2 yet")
        self._context = context or get_default_context()
        if not self._context.ok():
            raise NotInitializedException("cannot create node")
        words = [*(cli_args or ()), *(self._context.arguments if use_global_arguments else ())]
        self._arguments: Arguments = parse_arguments(words)
        self._name_the_node(node_name, namespace or "/")
        overrides = overrides_of(self._arguments, self.get_fully_qualified_name())
        overrides.update({each.name: each.value for each in parameter_overrides or ()})
        super().__init__(overrides, allow_undeclared_parameters)
        self._publishers: list[Publisher] = []
        self._subscriptions: list[Subscription] = []
        self._clients: list[Client] = []
        self._services: list[Service] = []
        self._timers: list[Timer] = []
        self._guards: list[GuardCondition] = []
        self._waitables: list[Any] = []
        self._executor: Any = None
        self._default_callback_group = MutuallyExclusiveCallbackGroup()
        _seam.program.open_node(self.get_fully_qualified_name())
        self._logger = get_logger(self.get_fully_qualified_name().strip("/").replace("/", "."))
        if enable_rosout and not self._arguments.disables_rosout:
            published.add(self._logger.name)
        self._clock = ROSClock()
        self.declare_parameter(SIM_TIME, False)
        if automatically_declare_parameters_from_overrides:
            for name, each in self._parameter_overrides.items():
                if not self.has_parameter(name):
                    self.declare_parameter(name, each.value)
        if start_parameter_services:
            self._parameter_service = ParameterService(self)

    def _name_the_node(self, node_name: str, namespace: str) -> None:
        name, found = node_name, namespace
        for rule in reversed(self._arguments.remaps):
            if rule.node in ("", node_name):
                name = rule.target if rule.source == "__node" else name
                found = rule.target if rule.source == "__ns" else found
        if not found.startswith("/"):
            found = f"/{found}"
        validate_node_name(name)
        validate_namespace(found)
        self._name, self._namespace = name, found

    def _tell(self, new: list[Parameter], changed: list[Parameter], deleted: list[Parameter]) -> None:
        def event() -> Any:
            from rcl_interfaces.msg import ParameterEvent

            return ParameterEvent(
                stamp=self._clock.now().to_msg(),
                node=self.get_fully_qualified_name(),
                new_parameters=[each.to_parameter_msg() for each in new],
                changed_parameters=[each.to_parameter_msg() for each in changed],
                deleted_parameters=[each.to_parameter_msg() for each in deleted],
            )

        _seam.tell_parameters(event)

    # -- names -------------------------------------------------------------------------------------------------------

    def get_name(self) -> str:
        """Return the name."""
        return self._name

    def get_namespace(self) -> str:
        """Return the namespace."""
        return self._namespace

    def get_fully_qualified_name(self) -> str:
        """Return the name with the namespace."""
        return full_name_of(self._name, self._namespace)

    def get_logger(self) -> RcutilsLogger:
        """Return the logger."""
        return self._logger

    def get_clock(self) -> Clock:
        """Return the clock, which shows ROS's time."""
        return self._clock

    def resolve_topic_name(self, topic: str, *, only_expand: bool = False) -> str:
        """Return the full name of a topic.

        Args:
            topic: its name.
            only_expand: do not apply the remappings.

        Raises:
            InvalidTopicNameException: it breaks ROS's rules.
        """
        return self._resolve(topic, "topic", only_expand)

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        """Return the full name of a service; see `resolve_topic_name`.

        Raises:
            InvalidServiceNameException: it breaks ROS's rules.
        """
        return self._resolve(service, "service", only_expand)

    def _resolve(self, name: str, kind: str, only_expand: bool) -> str:
        is_service = kind == "service"
        validate_topic_name(name, is_service=is_service)
        full = self._expanded(name)
        validate_full_topic_name(full, is_service=is_service)
        for rule in () if only_expand else self._arguments.remaps:
            if rule.source.startswith("__") or rule.kind not in ("", kind) or rule.node not in ("", self._name):
                continue
            if self._expanded(rule.source) == full:
                return self._expanded(rule.target)
        return full

    def _expanded(self, name: str) -> str:
        return expand_topic_name(name, self._name, self._namespace)

    # -- entities ----------------------------------------------------------------------------------------------------

    @property
    def context(self) -> Context:
        """The context."""
        return self._context

    @property
    def executor(self) -> Any:
        """The executor that runs its callbacks, or None."""
        return self._executor

    @executor.setter
    def executor(self, new_executor: Any) -> None:
        if self._executor is new_executor:
            return
        if self._executor is not None:
            self._executor.remove_node(self)
        self._executor = new_executor
        if new_executor is not None:
            new_executor.add_node(self)

    def _wake(self) -> None:
        _seam.program.waiting.note_change()
        if self._executor is not None:
            self._executor.wake()

    @property
    def default_callback_group(self) -> CallbackGroup:
        """The group of entities without another one."""
        return self._default_callback_group

    @property
    def publishers(self) -> Iterator[Publisher]:
        """The publishers."""
        yield from self._publishers

    @property
    def subscriptions(self) -> Iterator[Subscription]:
        """The subscriptions."""
        yield from self._subscriptions

    @property
    def clients(self) -> Iterator[Client]:
        """The clients."""
        yield from self._clients

    @property
    def services(self) -> Iterator[Service]:
        """The services."""
        yield from self._services

    @property
    def timers(self) -> Iterator[Timer]:
        """The timers."""
        yield from self._timers

    @property
    def guards(self) -> Iterator[GuardCondition]:
        """The guard conditions."""
        yield from self._guards

    def _group(self, given: CallbackGroup | None) -> CallbackGroup:
        return self._default_callback_group if given is None else given

    def _added(self, entities: list[Any], entity: Any) -> Any:
        group = getattr(entity, "callback_group", None)
        if group is not None:
            group.add_entity(entity)
        entity._of_node = self
        entities.append(entity)
        self._wake()
        return entity

    def create_publisher(
        self,
        msg_type: Any,
        topic: str,
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: Any = None,
        qos_overriding_options: Any = None,
        publisher_class: type[Publisher] = Publisher,
    ) -> Publisher:
        """Make a publisher.

        Args:
            msg_type: message class.
            topic: name of the topic.
            qos_profile: its quality of service, or its depth.
            callback_group: group of the callbacks for its events; None is the node's default one.
            event_callbacks: `PublisherEventCallbacks`; None for the usual ones.
            qos_overriding_options: must be None.
            publisher_class: class of the publisher.

        Raises:
            InvalidTopicNameException: the name breaks ROS's rules.
            AttributeError, TypeError: a wrong type.
            NotImplementedError: an option that cfepy does not have yet.
        """
        _refuse(qos_overriding_options=qos_overriding_options)
        _check_message_type(msg_type)
        full = self.resolve_topic_name(topic)
        made = publisher_class(
            self,
            msg_type,
            full,
            profile_of(qos_profile),
            event_callbacks=event_callbacks,
            callback_group=callback_group,
            given_name=topic,
        )
        return self._with_events(self._publishers, made)  # type: ignore[no-any-return]

    def _with_events(self, entities: list[Any], entity: Any) -> Any:
        for handler in entity.event_handlers:
            self.add_waitable(handler)
        return self._added(entities, entity)

    def create_subscription(
        self,
        msg_type: Any,
        topic: str,
        callback: Callable[..., Any],
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: Any = None,
        qos_overriding_options: Any = None,
        raw: bool = False,
        content_filter_options: Any = None,
    ) -> Subscription:
        """Make a subscription.

        Args:
            msg_type: message class.
            topic: name of the topic.
            callback: called with each message, and with a dictionary about it if it takes two arguments.
            qos_profile: its quality of service, or its depth.
            callback_group: its group; None is the node's default one.
            event_callbacks: `SubscriptionEventCallbacks`; None for the usual ones.
            qos_overriding_options: must be None.
            raw: must be False.
            content_filter_options: must be None.

        Raises:
            InvalidTopicNameException: the name breaks ROS's rules.
            AttributeError, TypeError: a wrong type.
            NotImplementedError: an option that cfepy does not have yet.
        """
        _refuse(
            qos_overriding_options=qos_overriding_options,
            raw=raw,
            content_filter_options=content_filter_options,
        )
        _check_message_type(msg_type)
        full = self.resolve_topic_name(topic)
        made = Subscription(
            self,
            msg_type,
            full,
            callback,
            self._group(callback_group),
            profile_of(qos_profile),
            event_callbacks=event_callbacks,
            given_name=topic,
        )
        return self._with_events(self._subscriptions, made)  # type: ignore[no-any-return]

    def create_client(
        self,
        srv_type: Any,
        srv_name: str,
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Client:
        """Make a client of a service.

        Raises:
            InvalidServiceNameException: the name breaks ROS's rules.
            RuntimeError: it is not a service class.
        """
        _check_service_type(srv_type)
        full = self.resolve_service_name(srv_name)
        return self._added(  # type: ignore[no-any-return]
            self._clients, Client(self._context, srv_type, full, qos_profile, self._group(callback_group))
        )

    def create_service(
        self,
        srv_type: Any,
        srv_name: str,
        callback: Callable[[Any, Any], Any],
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Service:
        """Offer a service.

        Args:
            srv_type: service class.
            srv_name: its name.
            callback: called with a request and a response to fill; returns the response.
            qos_profile: its quality of service.
            callback_group: its group; None is the node's default one.

        Raises:
            InvalidServiceNameException: the name breaks ROS's rules.
            RuntimeError: it is not a service class.
        """
        _check_service_type(srv_type)
        full = self.resolve_service_name(srv_name)
        made = Service(srv_type, full, callback, self._group(callback_group), qos_profile)
        return self._added(self._services, made)  # type: ignore[no-any-return]

    def _create_quiet_service(self, srv_type: Any, srv_name: str, callback: Callable[[Any, Any], Any]) -> None:
        full = self.resolve_service_name(srv_name)
        group = self._default_callback_group
        self._added(self._services, Service(srv_type, full, callback, group, qos_profile_parameters, is_quiet=True))

    def create_timer(
        self,
        timer_period_sec: float,
        callback: Callable[..., Any] | None,
        callback_group: CallbackGroup | None = None,
        clock: Clock | None = None,
        autostart: bool = True,
    ) -> Timer:
        """Make a timer.

        Args:
            timer_period_sec: period in s.
            callback: the function that is called.
            callback_group: its group; None is the node's default one.
            clock: its clock; None is the node's.
            autostart: False waits for `Timer.reset`.
        """
        period = int(float(timer_period_sec) * 1_000_000_000)
        group = self._group(callback_group)
        made = Timer(callback, group, period, clock or self._clock, context=self._context, autostart=autostart)
        return self._added(self._timers, made)  # type: ignore[no-any-return]

    def create_guard_condition(
        self, callback: Callable[[], Any], callback_group: CallbackGroup | None = None
    ) -> GuardCondition:
        """Make a guard condition."""
        made = GuardCondition(callback, self._group(callback_group), self._context)
        return self._added(self._guards, made)  # type: ignore[no-any-return]

    def create_rate(self, frequency: float, clock: Clock | None = None) -> Rate:
        """Make a rate.

        Args:
            frequency: Hz.
            clock: its clock; None is the node's.

        Raises:
            ValueError: the frequency is not positive.
        """
        if frequency <= 0:
            raise ValueError("frequency must be > 0")
        timer = self.create_timer(1.0 / frequency, None, MutuallyExclusiveCallbackGroup(), clock)
        return Rate(timer, context=self._context)

    # -- ends --------------------------------------------------------------------------------------------------------

    def _destroy(self, entities: list[Any], entity: Any) -> bool:
        if entity not in entities:
            return False
        entities.remove(entity)
        for handler in getattr(entity, "event_handlers", ()):
            if handler in self._waitables:
                self._waitables.remove(handler)
        entity.destroy()
        self._wake()
        return True

    def destroy_publisher(self, publisher: Publisher) -> bool:
        """End a publisher. Returns False if it is not the node's."""
        return self._destroy(self._publishers, publisher)

    def destroy_subscription(self, subscription: Subscription) -> bool:
        """End a subscription. Returns False if it is not the node's."""
        return self._destroy(self._subscriptions, subscription)

    def destroy_client(self, client: Client) -> bool:
        """End a client. Returns False if it is not the node's."""
        return self._destroy(self._clients, client)

    def destroy_service(self, service: Service) -> bool:
        """End a service. Returns False if it is not the node's."""
        return self._destroy(self._services, service)

    def destroy_timer(self, timer: Timer) -> bool:
        """End a timer. Returns False if it is not the node's."""
        return self._destroy(self._timers, timer)

    def destroy_guard_condition(self, guard: GuardCondition) -> bool:
        """End a guard condition. Returns False if it is not the node's."""
        return self._destroy(self._guards, guard)

    def destroy_rate(self, rate: Rate) -> bool:
        """End a rate. Returns False if its timer is not the node's."""
        is_own = self.destroy_timer(rate._timer)
        rate.destroy()
        return is_own

    def destroy_node(self) -> None:
        """End the node with all of its entities."""
        if self._executor is not None:
            self._executor.remove_node(self)
        for entities in (
            *(self._publishers, self._subscriptions, self._clients, self._services, self._timers, self._guards),
        ):
            for each in entities[:]:
                self._destroy(entities, each)
        for waitable in self._waitables[:]:
            waitable.destroy()
        self._waitables.clear()

    def __enter__(self) -> Node:
        return self

    def __exit__(self, *error: object) -> None:
        self.destroy_node()

    # -- the graph ---------------------------------------------------------------------------------------------------

    def count_publishers(self, topic_name: str) -> int:
        """Return the number of publishers of a topic."""
        topic = _seam.program.graph.topics.get(self.resolve_topic_name(topic_name, only_expand=True))
        return 0 if topic is None else len(topic.links) + len(topic.compiled_publishers)

    def count_subscribers(self, topic_name: str) -> int:
        """Return the number of subscriptions of a topic."""
        topic = _seam.program.graph.topics.get(self.resolve_topic_name(topic_name, only_expand=True))
        return 0 if topic is None else len(topic.subscriptions) + len(topic.compiled_subscribers)

    def get_topic_names_and_types(self, no_demangle: bool = False) -> list[tuple[str, list[str]]]:
        """Return the topics with a publisher or a subscription, and their types such as "std_msgs/msg/String"."""
        topics = _seam.program.graph.topics.items()
        found = {
            name: [each.type.replace("/", "/msg/")]
            for name, each in topics
            if each.links or each.subscriptions or each.compiled_publishers or each.compiled_subscribers
        }
        found.setdefault("/parameter_events", ["rcl_interfaces/msg/ParameterEvent"])
        found.setdefault("/rosout", ["rcl_interfaces/msg/Log"])
        return sorted(found.items())

    def get_service_names_and_types(self) -> list[tuple[str, list[str]]]:
        """Return the services, and their types such as "std_srvs/srv/SetBool"."""
        services = sorted(_seam.program.graph.services.items())
        return [(name, [each.service.service_class._type.replace("/", "/srv/")]) for name, each in services]

    def get_node_names_and_namespaces(self) -> list[tuple[str, str]]:
        """Return the names and namespaces of the nodes; a program with several nodes counts as its first one."""
        found = [name.rpartition("/") for name in sorted(_seam.program.graph.nodes)]
        return [(name, namespace or "/") for namespace, _, name in found]

    def get_node_names(self) -> list[str]:
        """Return the names of the nodes without their namespaces."""
        return [name for name, _ in self.get_node_names_and_namespaces()]

    def get_fully_qualified_node_names(self) -> list[str]:
        """Return the full names of the nodes."""
        return [full_name_of(name, namespace) for name, namespace in self.get_node_names_and_namespaces()]

    def get_publishers_info_by_topic(self, topic_name: str, no_mangle: bool = False) -> NoReturn:
        """Refuse: there is no information about end points yet."""
        raise NotImplementedError("cfepy does not have information about publishers for nodes of ROS 2 yet")

    def get_subscriptions_info_by_topic(self, topic_name: str, no_mangle: bool = False) -> NoReturn:
        """Refuse: there is no information about end points yet."""
        raise NotImplementedError("cfepy does not have information about subscriptions for nodes of ROS 2 yet")

    @property
    def waitables(self) -> Iterator[Any]:
        """The waitables: servers and clients of actions, and others."""
        yield from self._waitables

    def add_waitable(self, waitable: Any) -> None:
        """Let the executor of the node run a waitable.

        Raises:
            NotImplementedError: it uses a wait set of rcl.
        """
        if hasattr(waitable, "add_to_wait_set"):
            raise NotImplementedError("cfepy does not have wait sets of rcl for nodes of ROS 2 yet")
        self._added(self._waitables, waitable)

    def remove_waitable(self, waitable: Any) -> None:
        """Run a waitable no more."""
        self._waitables.remove(waitable)
        self._wake()


def _refuse(**options: Any) -> None:
    for name, value in options.items():
        if value:
            raise NotImplementedError(f"cfepy does not have the option {name} for nodes of ROS 2 yet")


def _check_message_type(msg_type: Any) -> None:
    if not hasattr(msg_type, "get_fields_and_field_types"):
        name = getattr(msg_type, "__name__", msg_type)
        raise AttributeError(f"type object '{name}' has no attribute '_TYPE_SUPPORT' {_NOT_A_TYPE}")


def _check_service_type(srv_type: Any) -> None:
    if not hasattr(srv_type, "Request") or not hasattr(srv_type, "Response"):
        raise RuntimeError(f"The service type provided is not valid ({srv_type}), this might be a message or action")
