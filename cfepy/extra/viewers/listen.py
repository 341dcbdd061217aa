"""Where a server for viewers listens, and whom it lets in.

Without a host it listens on the loopback interface. There any program of this computer may connect, as with the
mission's other ports, but a page in a browser only if it comes from this computer, too: every page that somebody looks
at can open connections to 127.0.0.1 (RFC 6455, 10.2). A server that other computers reach wants a token of everybody.
"""

from __future__ import annotations

import hmac
import os
import re
import secrets
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

from cfepy.io import is_this_computer
from cfepy.status import UsageError

LOOPBACK = "127.0.0.1"
HIGHEST_PORT = 65_535
TOKEN_VARIABLE = "CFEPY_VIEWER_TOKEN"
SHORTEST_TOKEN = 8  # characters
ANY_ORIGIN = "*"
_TOKEN = re.compile(r"[!-~]+")
_ORIGIN = re.compile(r"([a-z][a-z0-9+.-]*://)([a-z0-9._~-]+|\[[0-9a-f:.]+\])(:[0-9]+)?", re.IGNORECASE)
_ORIGINS_WITHOUT_HOST = ("null", "file://", ANY_ORIGIN)
_USUAL_PORTS = {"http://": ":80", "https://": ":443"}


class ListenPlace(NamedTuple):
    """Where a server listens: host and port; port 0 takes any that is free."""

    host: str
    port: int

    @property
    def is_loopback(self) -> bool:
        """Whether only programs of this computer reach it."""
        return is_this_computer(self.host)

    def __str__(self) -> str:
        return f"[{self.host}]:{self.port}" if ":" in self.host else f"{self.host}:{self.port}"


def listen_place_of(text: str) -> ListenPlace:
    """Where an option says that a server is to listen.

    Args:
        text: [HOST:]PORT; a host with colons of its own stands in brackets. An empty host is all interfaces.

    Raises:
        ValueError: it is none.
    """
    host, mark, port = text.rpartition(":")
    if host.startswith("[") and host.endswith("]"):
        host = host[1:-1]
    elif ":" in host or "/" in host or "@" in host:
        raise ValueError(f"invalid address {text!r}; expected a form such as 9090, 0.0.0.0:9090 or [::1]:9090")
    if not (port.isascii() and port.isdecimal() and int(port) <= HIGHEST_PORT):
        raise ValueError(
            f"invalid address {text!r}; expected a form such as 9090 or 0.0.0.0:9090, with a port up to {HIGHEST_PORT}"
        )
    return ListenPlace(host or ("0.0.0.0" if mark else LOOPBACK), int(port))


def origin_of(text: str) -> str:
    """An origin as browsers say it: in lower case, without a slash at the end and without the usual port.

    Args:
        text: such as https://example.org:8443; "null" or "file://" for pages that are files; "*" for every page.

    Raises:
        ValueError: it is none, so that no page could ever have it.
    """
    plain = text.lower()
    if plain in _ORIGINS_WITHOUT_HOST:
        return plain
    if plain.startswith("file:"):
        raise ValueError(f"invalid origin {text!r}; pages that are files have the origin null or file://")
    parts = _ORIGIN.fullmatch(plain.removesuffix("/"))
    if parts is not None and int((parts[3] or ":0")[1:]) <= HIGHEST_PORT:
        scheme, host, port = parts.groups(default="")
        return scheme + host + ("" if port == _USUAL_PORTS.get(scheme) else port)
    begin = _ORIGIN.match(plain) or _ORIGIN.match(f"https://{plain}")
    hint = f"; did you mean {begin[0]}?" if begin is not None and "." in begin[2] else ""
    raise ValueError(
        f"invalid origin {text!r}; expected an origin such as https://example.org or http://robot:8000{hint}"
    )


class Admission:
    """Whom a server lets in.

    Args:
        token: what everybody has to know; "" when nobody has to.
        origins: of pages in browsers that are welcome besides those of this computer; see `origin_of`.

    Raises:
        ValueError: an origin is none.
    """

    def __init__(self, token: str = "", origins: Sequence[str] = ()) -> None:
        self.token = token
        self._origins = frozenset(map(origin_of, origins))

    def knows(self, token: str) -> bool:
        """Whether somebody's token is the right one; how long the comparison takes says nothing about it."""
        return bool(self.token) and hmac.compare_digest(self.token.encode(), token.encode(errors="replace"))

    def welcomes(self, origin: str | None) -> bool:
        """Whether a page of an origin may connect without showing the token first.

        Args:
            origin: what the browser says (RFC 6454); None of a program that is no browser. "null" is a file, but also
                a frame in anybody's page.
        """
        if origin is None or ANY_ORIGIN in self._origins or origin.lower() in self._origins:
            return True
        parts = _ORIGIN.fullmatch(origin.lower())
        if parts is None or parts[1] not in _USUAL_PORTS or int((parts[3] or ":0")[1:]) > HIGHEST_PORT:
            return False
        return is_this_computer(parts[2].strip("[]"))


def admission_to(
    place: ListenPlace,
    token: str | None,
    origins: Sequence[str] = (),
    environ: Mapping[str, str] = os.environ,
    tell: Callable[[str], object] = lambda line: None,
) -> Admission:
    """Whom a server lets in that listens at a place.

    A server that other computers reach and for which nobody has set a token gets one, which is told.

    Args:
        place: where it listens.
        token: of the command line; without it that of the environment holds.
        origins: see `Admission`.
        environ: of this process.
        tell: gets the line that says the token that was made.

    Raises:
        UsageError: the token is too short, or cannot be written in a URL; an origin is none.
    """
    given = environ.get(TOKEN_VARIABLE, "") if token is None else token
    if given and (len(given) < SHORTEST_TOKEN or not _TOKEN.fullmatch(given)):
        text = f"a token must have at least {SHORTEST_TOKEN} printable ASCII characters without spaces"
        raise UsageError(text, field=TOKEN_VARIABLE if token is None else "--viewer-token")
    if not given and not place.is_loopback:
        given = secrets.token_urlsafe(18)
        tell(f"viewers require the token {given} (--viewer-token or {TOKEN_VARIABLE} sets another)")
    try:
        return Admission(given, origins)
    except ValueError as error:
        raise UsageError(str(error), field="--viewer-origin") from None
