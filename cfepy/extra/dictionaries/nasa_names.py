"""Names of packets, in the form of NASA's constants: HS_ENABLE_APP_MON, HS_HK_TLM."""

from __future__ import annotations

import re

_WORDS = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])")


def snake(name: str) -> str:
    """Return a name in capital letters with underscores: "EnableAppMonCmd" is ENABLE_APP_MON_CMD."""
    return re.sub(r"_+", "_", re.sub(r"\W", "_", _WORDS.sub("_", name))).strip("_").upper()


def packet_name(owner: str, name: str) -> str:
    """Return the name of a packet with its owner once: ("HS", "HkTlm") is HS_HK_TLM."""
    short = snake(name)
    return short if short.startswith(f"{owner}_") else f"{owner}_{short}"


def command_name(owner: str, name: str) -> str:
    """Return the name of a command, without its suffix: ("HS", "NoopCmd") is HS_NOOP."""
    return packet_name(owner, snake(name).removesuffix("_CMD") or name)
