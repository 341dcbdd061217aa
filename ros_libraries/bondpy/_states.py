"""The states of one end of a bond, as a table of transitions."""

from __future__ import annotations

WAITING, ALIVE, DYING, DEAD = "SM.WaitingForSister", "SM.Alive", "SM.AwaitSisterDeath", "SM.Dead"

# (state, event): (actions, names of functions of the owner; next state). Other events change nothing.
TRANSITIONS: dict[tuple[str, str], tuple[tuple[str, ...], str]] = {
    (WAITING, "ConnectTimeout"): (("Death",), DEAD),
    (WAITING, "Die"): (("Death",), DEAD),
    (WAITING, "SisterAlive"): (("Connected",), ALIVE),
    (WAITING, "SisterDead"): (("Connected", "SisterDied", "Death"), DEAD),
    (ALIVE, "Die"): (("StartDying",), DYING),
    (ALIVE, "HeartbeatTimeout"): (("Death",), DEAD),
    (ALIVE, "SisterAlive"): (("Heartbeat",), ALIVE),
    (ALIVE, "SisterDead"): (("SisterDied", "Death"), DEAD),
    (DYING, "DisconnectTimeout"): (("Death",), DEAD),
    (DYING, "SisterDead"): (("Death",), DEAD),
}
