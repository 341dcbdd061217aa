"""roslib: the start of old ROS programs (`load_manifest`), and lookup of messages, packages and files by name."""

from __future__ import annotations

from roslib import launcher, stacks

__all__ = ["is_interactive", "launcher", "load_manifest", "set_interactive", "stacks"]

_is_interactive = False


def load_manifest(package_name: str, bootstrap_version: str = "0.7") -> None:
    """Make the code of a package and of its dependencies importable; see `roslib.launcher`.

    Args:
        package_name: the package; old programs name their own.
        bootstrap_version: accepted.

    Raises:
        rospkg.ResourceNotFound: there is no such package.
    """
    launcher.load_manifest(package_name, bootstrap_version)


def set_interactive(interactive: bool) -> None:
    """Set whether the program has an interactive user."""
    global _is_interactive
    _is_interactive = interactive


def is_interactive() -> bool:
    """Return the last value given to `set_interactive`."""
    return _is_interactive
