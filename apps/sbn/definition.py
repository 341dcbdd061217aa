"""Build SBN's tables from readable terms: the addresses of peers, and the MsgIds that change between them.

Scripts that make table files use it; see apps/sbn/tables.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from cfepy.tbl import TableImage

from . import packets as pk

SPACECRAFT = 0x42
POLL, TASKS = 0, pk.TASK_SEND | pk.TASK_RECV
UDP = {"Name": "UDP", "LibFileName": "/cf/sbn_udp.so", "LibSymbol": "SBN_UDP_Ops", "BaseEID": 0x0100}
REMAP = {"Name": "Remap", "LibFileName": "/cf/sbn_f_remap.so", "LibSymbol": "SBN_F_Remap", "BaseEID": 0x1000}


def peer(
    processor: int,
    address: str,
    spacecraft: int = SPACECRAFT,
    net: int = 0,
    filters: Sequence[str] = ("Remap",),
    tasks: int = POLL,
) -> dict[str, Any]:
    """Return an entry of the configuration table. One of the entries is the processor itself.

    Args:
        processor: its processor id.
        address: "HOST:PORT", the host as a number.
        spacecraft: its spacecraft id.
        net: number of the net, 0 to 15.
        filters: names of filters, in the order in which messages pass them.
        tasks: POLL: messages wait for SBN's next wakeup; TASKS: they do not.
    """
    return {
        "ProcessorID": processor,
        "SpacecraftID": spacecraft,
        "NetNum": net,
        "ProtocolName": UDP["Name"],
        "Filters": list(filters),
        "Address": address,
        "TaskFlags": tasks,
    }


def configuration(peers: Sequence[dict[str, Any]]) -> TableImage:
    """Return the configuration table, with the module UDP and the filter Remap.

    Args:
        peers: at most 16 entries of `peer`.

    Raises:
        UsageError: too many, or a value that does not fit.
    """
    return pk.CONF_TABLE.image(
        {
            "ProtocolModules": [UDP],
            "ProtocolCnt": 1,
            "FilterModules": [REMAP],
            "FilterCnt": 1,
            "Peers": list(peers),
            "PeerCnt": len(peers),
        }
    )


def remapping(
    entries: Iterable[tuple[int, int, int]], spacecraft: int = SPACECRAFT, sends_others: bool = True
) -> TableImage:
    """Return the remapping table.

    Args:
        entries: processor id of a peer, MsgId on this bus, MsgId that the peer gets; 0 for none.
        spacecraft: id of the peers' spacecraft.
        sends_others: whether MsgIds without an entry go to peers unchanged.

    Raises:
        UsageError: more than 256, or a value that does not fit.
    """
    rows = [
        {"ProcessorID": processor, "SpacecraftID": spacecraft, "FromMID": there, "ToMID": here}
        for processor, there, here in entries
    ]
    flag = pk.REMAP_DEFAULT_SEND if sends_others else pk.REMAP_DEFAULT_IGNORE
    return pk.REMAP_TABLE.image({"RemapDefaultFlag": flag, "Entries": rows})
