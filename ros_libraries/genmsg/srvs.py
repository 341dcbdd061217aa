"""`SrvSpec`: a service definition."""

from __future__ import annotations

from typing import Any

from .msgs import MsgSpec
from .names import package_resource_name


class SrvSpec:
    """A service definition: the specs of request and response, and the text.

    Args:
        request: spec of the request.
        response: spec of the response.
        text: the definition.
        full_name: "package/Name".
        short_name: its bare name; by default from the full name.
        package: package of the service; by default from the full name.
    """

    __hash__ = None  # type: ignore[assignment]

    def __init__(
        self,
        request: MsgSpec,
        response: MsgSpec,
        text: str,
        full_name: str = "",
        short_name: str = "",
        package: str = "",
    ) -> None:
        own_package, own_name = package_resource_name(full_name)
        self.request, self.response, self.text = request, response, text
        self.full_name, self.short_name, self.package = full_name, short_name or own_name, package or own_package

    def _parts(self) -> tuple[Any, ...]:
        return self.request, self.response, self.text, self.full_name, self.short_name, self.package

    def __eq__(self, other: object) -> bool:
        return isinstance(other, SrvSpec) and self._parts() == other._parts()

    def __repr__(self) -> str:
        return f"SrvSpec[{self.request!r}, {self.response!r}]"
