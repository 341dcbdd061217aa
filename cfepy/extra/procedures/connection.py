"""The second door: NASA's neutral class `CfsTest_Connection`, with cfepy as one of its connections.

The tests of an application are then a class whose object gets a connection, and know neither COSMOS nor cfepy:

    class ci_lab_test_methods:
        DEFAULT_APP_NAME = "CI_LAB"

        def __init__(self, connection):
            self.connection = connection
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from cfepy.extra.procedures.packet_items import squeezed

if TYPE_CHECKING:
    from cfepy.extra.procedures.script_api import ScriptApi

_METHODS = ("test_", "script_")


class CfsTest_Connection(ABC):
    """The interface of a connection.

    Args:
        method_type: the class of the tests, which gets this connection; None for a connection to another application.
        options: `app_name`, `instance_name` and `remote_addr`.
    """

    def __init__(self, method_type: Callable[[CfsTest_Connection], Any] | None, **options: Any) -> None:
        self.app_name = options.get("app_name", getattr(method_type, "DEFAULT_APP_NAME", None))
        self.instance_name = options.get("instance_name")
        self.remote_addr = options.get("remote_addr", ("127.0.0.1", 1234))
        self.method_obj = None if method_type is None else method_type(self)

    def get_app_name(self) -> str | None:
        """Return the name of the application under test."""
        return self.app_name

    def get_instance_name(self) -> str | None:
        """Return the name of the flight computer."""
        return self.instance_name

    def print(self, message: str) -> None:
        """Print a line."""
        print(message)

    @abstractmethod
    def cmd(self, cmd_id: str, **values: Any) -> Any:
        """Send a command of the application."""

    @abstractmethod
    def tlm(self, tlm_id: str, param_id: str) -> Any:
        """Return the newest value of an item."""

    @abstractmethod
    def wait_check_packet(self, tlm_id: str, num_pkt: int, timeout: float) -> Any:
        """Wait for packets."""

    @abstractmethod
    def wait_check(self, tlm_id: str, param_id: str, value: Any, timeout: float) -> Any:
        """Wait until an item has a value."""

    @abstractmethod
    def spawn_child(self, app_name: str) -> CfsTest_Connection:
        """Return a connection to another application."""

    @abstractmethod
    def wait(self, timeout: float) -> Any:
        """Wait some seconds."""


class CfepyConnection(CfsTest_Connection):
    """A connection through the functions of procedures.

    Args:
        api: the functions.
        target: the name of the target.
        method_type: see `CfsTest_Connection`.
        app_name: the application, instead of the class's DEFAULT_APP_NAME.
    """

    def __init__(self, api: ScriptApi, target: str, method_type: Any, app_name: str | None = None) -> None:
        self._api = api
        named = {} if app_name is None else {"app_name": app_name}
        super().__init__(method_type, instance_name=target, **named)

    def print(self, message: str) -> None:
        self._api.puts(message)

    def cmd(self, cmd_id: str, **values: Any) -> Any:
        given = {_words(name): value for name, value in values.items()}
        return self._api.cmd(self.instance_name, f"{self.app_name}_CMD_{_words(cmd_id)}", given)

    def tlm(self, tlm_id: str, param_id: str) -> Any:
        return self._api.tlm(self.instance_name, f"{self.app_name}_{tlm_id}", _words(param_id))

    def wait_check_packet(self, tlm_id: str, num_pkt: int, timeout: float) -> Any:
        return self._api.wait_check_packet(str(self.instance_name), f"{self.app_name}_{tlm_id}", num_pkt, timeout)

    def wait_check(self, tlm_id: str, param_id: str, value: Any, timeout: float) -> Any:
        item = f"{self.instance_name} {self.app_name}_{tlm_id} {_words(param_id)}"
        return self._api.wait_check(f"{item} == {value!r}", timeout)

    def spawn_child(self, app_name: str) -> CfepyConnection:
        return CfepyConnection(self._api, str(self.instance_name), None, app_name)

    def wait(self, timeout: float) -> Any:
        return self._api.wait(timeout)


def test_classes(names: dict[str, Any]) -> list[type]:
    """Return the classes of tests for a connection that a file defines: with DEFAULT_APP_NAME and methods `test_`."""
    return [
        each
        for each in names.values()
        if isinstance(each, type) and hasattr(each, "DEFAULT_APP_NAME") and methods_of(each)
    ]


def methods_of(kind: type) -> list[str]:
    """Return the names of the tests of such a class, in alphabetical order."""
    return sorted(each for each in dir(kind) if each.startswith(_METHODS))


def _words(name: str) -> str:
    """Return "CommandCounter" as COMMAND_COUNTER; packets are found without underscores, too."""
    parts: list[str] = []
    for at, each in enumerate(name):
        starts = each.isupper() and at and (name[at - 1].islower() or name[at + 1 : at + 2].islower())
        parts.append(f"_{each}" if starts and name[at - 1] != "_" else each)
    text = "".join(parts).upper()
    return text if squeezed(text) == squeezed(name) else name.upper()
