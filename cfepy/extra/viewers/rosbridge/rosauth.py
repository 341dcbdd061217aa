"""The op `auth`: a client shows that it knows the token without sending it (wiki.ros.org/rosauth).

It sends a SHA-512 of the token, its own address, the server's address, a random text, the time, a level and the end of
its session. rosauth's `ros_mac_authentication` checks the same data with a secret file. So `authenticate` of roslibjs
works with the token as its secret.
"""

from __future__ import annotations

import hashlib
import hmac
from typing import Any

FIELDS = ("client", "dest", "rand", "t", "level", "end")
PATIENCE_S = 5  # maximum difference between the client's clock and this computer's


class MacCheck:
    """Checks the ops of clients.

    Args:
        token: the token that they must know.
    """

    def __init__(self, token: str) -> None:
        self._token = token
        self._seen: dict[str, float] = {}

    def admits(self, message: dict[str, Any], now_s: float) -> bool:
        """Return True if the sender of an op knows the token; a repeated op is not accepted.

        Args:
            message: the op.
            now_s: wall time in s since 1970.
        """
        mac, t, end = message.get("mac"), message.get("t"), message.get("end")
        if not isinstance(mac, str) or type(t) is not int or type(end) is not int or abs(now_s - t) > PATIENCE_S:
            return False
        self._seen = {each: at_s for each, at_s in self._seen.items() if now_s - at_s <= 2 * PATIENCE_S}
        text = self._token + "".join(str(message.get(each, "")) for each in FIELDS)
        right = hashlib.sha512(text.encode(errors="replace")).hexdigest()
        is_right = hmac.compare_digest(right.encode(), mac.encode(errors="replace"))
        if not is_right or right in self._seen or end <= now_s:
            return False
        self._seen[right] = now_s
        return True
