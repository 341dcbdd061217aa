"""The folders of packages' files. Nothing is built or installed here, so a package's own folder has them all."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import Any

import rospkg


def find_in_workspaces(
    search_dirs: Sequence[str] | None = None,
    project: str | None = None,
    path: str | None = None,
    _workspaces: Sequence[str] = (),
    considered_paths: list[str] | None = None,
    first_matching_workspace_only: bool = False,
    first_match_only: bool = False,
    workspace_to_source_spaces: Any = None,
    source_path_to_packages: Callable[..., Any] | None = None,
) -> list[str]:
    """Return the existing places of a package's files.

    Args:
        search_dirs: kinds of folders, such as "share" and "libexec"; a package's own folder stands for each.
        project: the package; None finds nothing.
        path: path below the package's folder.
        considered_paths: receives every place that was searched.
        first_match_only: return one place at most.
    """
    if project is None:
        return []
    try:
        folder = rospkg.RosPack().get_path(project)
    except rospkg.ResourceNotFound:
        return []
    place = os.path.join(folder, path) if path else folder
    if considered_paths is not None:
        considered_paths.append(place)
    return [place] if os.path.exists(place) else []
