"""roslib.scriptutil: the bare master, for programs that are not nodes."""

from __future__ import annotations

from typing import Any
from xmlrpc.client import ServerProxy

from rosgraph.names import script_resolve_name
from rosgraph.rosenv import get_master_uri

__all__ = ["get_master", "get_param_server", "script_resolve_name"]


def get_master() -> Any:
    """Return the master, as a ServerProxy."""
    return ServerProxy(get_master_uri())


def get_param_server() -> Any:
    """Return the parameter server, as a ServerProxy."""
    return get_master()
