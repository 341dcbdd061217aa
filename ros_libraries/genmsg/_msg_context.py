"""`MsgContext`: the known definitions, their files, and their dependencies; part of msg_loader."""

from __future__ import annotations

from typing import Any

from .msgs import DURATION, DURATION_MSG, TIME, TIME_MSG, MsgSpec, bare_msg_type
from .names import package_resource_name


class MsgContext:
    """Definitions by full name. A service has two, its request and its response."""

    def __init__(self) -> None:
        self._specs: dict[tuple[str, str], Any] = {}
        self._files: dict[str, str] = {}
        self._dependencies: dict[str, list[str]] = {}

    @staticmethod
    def create_default() -> MsgContext:
        """One that knows `time` and `duration`."""
        from .msg_loader import load_msg_from_string

        context = MsgContext()
        load_msg_from_string(context, TIME_MSG, TIME)
        load_msg_from_string(context, DURATION_MSG, DURATION)
        return context

    def set_file(self, full_msg_type: str, file_path: str) -> None:
        """Say which file a type came from."""
        self._files[full_msg_type] = file_path

    def get_file(self, full_msg_type: str) -> str | None:
        """Return the file that a type came from."""
        return self._files.get(full_msg_type)

    def set_depends(self, full_msg_type: str, dependencies: list[str]) -> None:
        """Say which types the fields of a type are."""
        self._dependencies[full_msg_type] = dependencies

    def get_depends(self, full_msg_type: str) -> list[str] | None:
        """Return the types of the fields of a type, or None if that was not said."""
        return self._dependencies.get(full_msg_type)

    def get_all_depends(self, full_msg_type: str) -> list[str]:
        """Return the types that a type needs, each followed by its own dependencies.

        Raises:
            KeyError: its dependencies are unknown.
        """
        needed = self._dependencies[full_msg_type]
        return [name for each in needed for name in (each, *self.get_all_depends(each))]

    def register(self, full_msg_type: str, msgspec: MsgSpec) -> None:
        """Make a definition known."""
        self._specs[_key(full_msg_type)] = msgspec

    def is_registered(self, full_msg_type: str) -> bool:
        """Return whether the definition of a type, or of an array's items, is known."""
        return _key(full_msg_type) in self._specs

    def get_registered(self, full_msg_type: str) -> Any:
        """Return the definition of a type, or of an array's items.

        Raises:
            KeyError: it is not known.
        """
        if not self.is_registered(full_msg_type):
            raise KeyError(bare_msg_type(full_msg_type))
        return self._specs[_key(full_msg_type)]

    def __str__(self) -> str:
        by_package: dict[str, dict[str, Any]] = {}
        for (package, name), spec in self._specs.items():
            by_package.setdefault(package, {})[name] = spec
        return str(by_package)


def _key(full_msg_type: str) -> tuple[str, str]:
    return package_resource_name(bare_msg_type(full_msg_type))
