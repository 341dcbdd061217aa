"""roslib: what old ROS programs begin with (`load_manifest`), and looking up messages, packages and files by name."""

from __future__ import annotations

from roslib import launcher, stacks

__all__ = ["is_interactive", "launcher", "load_manifest", "set_interactive", "stacks"]

_is_interactive = False


def load_manifest(package_name: str, bootstrap_version: str = "0.7") -> None:
    """Make the code of a package, and of those that it depends on, importable; see `roslib.launcher`.

    Programs begin with it and name their own package. One that has no manifest near it is no error: what lies beside a
    program can be imported anyhow.

    Args:
        package_name: the package.
        bootstrap_version: accepted.
    """
    import rospkg

    try:
        launcher.load_manifest(package_name, bootstrap_version)
    except rospkg.ResourceNotFound:
        pass


def set_interactive(interactive: bool) -> None:
    """Say whether a person sits before the program."""
    global _is_interactive
    _is_interactive = interactive


def is_interactive() -> bool:
    """What `set_interactive` has said last."""
    return _is_interactive
