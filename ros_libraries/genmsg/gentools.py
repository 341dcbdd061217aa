"""md5sums and full texts of definitions."""

from __future__ import annotations

import hashlib
from typing import Any

from ._msg_context import MsgContext
from .base import EXT_MSG, EXT_SRV, MsgGenerationException
from .msgs import MsgSpec, bare_msg_type, is_builtin
from .srvs import SrvSpec

_SEPARATOR = "=" * 80 + "\n"


def compute_md5_text(msg_context: MsgContext, spec: MsgSpec) -> str:
    """Return the text that is hashed: constants, then fields, nested messages as their md5sums."""
    lines = [f"{constant.type} {constant.name}={constant.val_text}" for constant in spec.constants]
    for kind, name in spec.fields():
        bare = bare_msg_type(kind)
        hashed = kind if is_builtin(bare) else compute_md5(msg_context, msg_context.get_registered(bare))
        lines.append(f"{hashed} {name}")
    return "\n".join(lines).strip()


def compute_md5(msg_context: MsgContext, spec: Any) -> str:
    """md5sum of a message or service, as 32 hexadecimal digits.

    Raises:
        Exception: `spec` is neither.
        KeyError: a nested message is not known.
    """
    if isinstance(spec, SrvSpec):
        parts = [spec.request, spec.response]
    elif isinstance(spec, MsgSpec):
        parts = [spec]
    else:
        raise Exception(f"[{spec}] is not a message or service")
    text = "".join(compute_md5_text(msg_context, part) for part in parts)
    return hashlib.md5(text.encode(), usedforsecurity=False).hexdigest()


compute_md5_v2 = compute_md5


def compute_full_text(msg_context: MsgContext, spec: Any) -> str:
    """Return the definition, followed by the definitions of all types that it needs, each once.

    Raises:
        KeyError: a needed type was not loaded, see `msg_loader.load_depends`.
    """
    parts = [f"{spec.text}\n"]
    for name in dict.fromkeys(msg_context.get_all_depends(spec.full_name)):
        parts.append(f"{_SEPARATOR}MSG: {name}\n{msg_context.get_registered(name).text}\n")
    return "".join(parts)[:-1]


def compute_full_type_name(package_name: str, file_name: str) -> str:
    """ "package/Name" of a .msg or .srv file in a package.

    Raises:
        MsgGenerationException: the file ends otherwise.
    """
    for ending in (EXT_MSG, EXT_SRV):
        if file_name.endswith(ending):
            return f"{package_name}/{file_name.removesuffix(ending)}"
    raise MsgGenerationException(f"Processing file: '{file_name}' - unknown file extension")
