"""Address and admission of a server for viewers.

Without a host it listens on the loopback interface. There any program of this computer may connect, as with the
mission's other ports. A page in a browser may connect only if it comes from this computer, too, because any page can
open connections to 127.0.0.1 (RFC 6455, 10.2). A server that other computers can reach requires a token from every
client.
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
    """The address of a server: host and port; port 0 takes any free one."""

    host: str
    port: int

    @property
    def is_loopback(self) -> bool:
        """True if only programs of this computer can reach it."""
        return is_this_computer(self.host)

    def __str__(self) -> str:
        return f"[{self.host}]:{self.port}" if ":" in self.host else f"{self.host}:{self.port}"


def listen_place_of(text: str) -> ListenPlace:
    """Parse the address of an option.

    Args:
        text: [HOST:]PORT; a host that contains colons stands in brackets. An empty host means all interfaces.

    Returns:
        The address.

    Raises:
        ValueError: it is invalid.
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
    """Normalize an origin as browsers do: in lower case, without a slash at the end and without the default port.

    Args:
        text: such as https://example.org:8443; "null" or "file://" for pages that are files; "*" for every page.

    Returns:
        The origin.

    Raises:
        ValueError: it is invalid, so that no page could ever have it.
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
    """Decides which clients a server admits.

    Args:
        token: the token that every client must show; "" for none.
        origins: origins of pages in browsers that may connect in addition to those of this computer; see `origin_of`.

    Raises:
        ValueError: an origin is invalid.
    """

    def __init__(self, token: str = "", origins: Sequence[str] = ()) -> None:
        self.token = token
        self._origins = frozenset(map(origin_of, origins))

    def knows(self, token: str) -> bool:
        """Return True if a token is correct; the duration of the comparison reveals nothing about it."""
        return bool(self.token) and hmac.compare_digest(self.token.encode(), token.encode(errors="replace"))

    def welcomes(self, origin: str | None) -> bool:
        """Return True if a page of an origin may connect without showing the token first.

        Args:
            origin: the origin that the browser sends (RFC 6454); None for a program that is not a browser. "null" is a
                file, but also a frame in any page.
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
    """Make the admission to a server.

    A server that other computers can reach gets a random token if none is set; `tell` receives it.

    Args:
        place: the address that it listens at.
        token: the token on the command line; None takes it from the environment.
        origins: see `Admission`.
        environ: environment of this process.
        tell: receives a message with the random token.

    Returns:
        The admission.

    Raises:
        UsageError: the token is too short, or cannot be written in a URL, or an origin is invalid.
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
