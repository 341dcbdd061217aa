"""The files that a definition needs."""

from __future__ import annotations

import os
from typing import Any

from .base import InvalidMsgSpec, MsgGenerationException
from .gentools import compute_full_type_name
from .msg_loader import MsgContext, _SearchPath, load_depends, load_msg_from_file, load_srv_from_file

Found = list[tuple[str, str | None]]


def find_msg_dependencies_with_type(pkg_name: str, msg_file: str, search_paths: _SearchPath) -> Found:
    """(type, file) of all that a .msg file needs.

    Raises:
        MsgGenerationException: a definition has a mistake.
    """
    return _needed(pkg_name, msg_file, search_paths, load_msg_from_file, lambda spec: [spec.full_name])


def find_msg_dependencies(pkg_name: str, msg_file: str, search_paths: _SearchPath) -> list[str | None]:
    """Files of all that a .msg file needs."""
    return [file for _, file in find_msg_dependencies_with_type(pkg_name, msg_file, search_paths)]


def find_srv_dependencies_with_type(pkg_name: str, msg_file: str, search_paths: _SearchPath) -> Found:
    """Return (type, file) of all dependencies of a .srv file; see `find_msg_dependencies_with_type`."""

    def parts(spec: Any) -> list[str]:
        return [spec.request.full_name, spec.response.full_name]

    return _needed(pkg_name, msg_file, search_paths, load_srv_from_file, parts)


def find_srv_dependencies(pkg_name: str, msg_file: str, search_paths: _SearchPath) -> list[str | None]:
    """Files of all that a .srv file needs."""
    return [file for _, file in find_srv_dependencies_with_type(pkg_name, msg_file, search_paths)]


def _needed(package: str, file: str, search_paths: _SearchPath, load: Any, parts: Any) -> Found:
    context = MsgContext.create_default()
    full_name = compute_full_type_name(package, os.path.basename(file))
    spec = load(context, file, full_name)
    try:
        load_depends(context, spec, search_paths)
    except InvalidMsgSpec as error:
        raise MsgGenerationException(f"Cannot read .msg for {full_name}: {error}") from None
    names = dict.fromkeys(name for part in parts(spec) for name in context.get_all_depends(part))
    return [(name, context.get_file(name)) for name in names]
