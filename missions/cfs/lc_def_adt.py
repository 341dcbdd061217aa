"""LC's actionpoints: the watchpoints that together are a failure, and the sequence of SC that each starts.

After a change, `python lc_def_adt.py` writes lc_def_adt.tbl anew.
"""

from __future__ import annotations

from cfepy.msg import Layout
from cfepy.tbl import TableImage, TableType, write_beside

ACTIONPOINT = Layout(
    "LC_ADTEntry_t",
    [
        ("DefaultState", "u8"),
        ("MaxPassiveEvents", "u8"),
        ("MaxPassFailEvents", "u8"),
        ("MaxFailPassEvents", "u8"),
        ("RTSId", "u16"),
        ("MaxFailsBeforeRTS", "u16"),
        ("RPNEquation", "u16[20]"),
        ("EventType", "u16"),
        ("EventID", "u16"),
        ("EventText", "char[32]"),
    ],
)
ACTIONPOINTS = 176
TABLE = TableType("LC.LC_ADT", ACTIONPOINT, rows=ACTIONPOINTS, description="Actionpoints")
NOT_USED, ACTIVE, END_OF_EQUATION, INFORMATION = 0xFF, 1, 0xFFF5, 2
LOW_CHARGE, SAVE_POWER = 0, 3  # watchpoint, sequence

USED = [
    {
        "DefaultState": ACTIVE,
        "MaxPassiveEvents": 1,
        "MaxPassFailEvents": 1,
        "MaxFailPassEvents": 1,
        "RTSId": SAVE_POWER,
        "MaxFailsBeforeRTS": 3,
        "RPNEquation": [LOW_CHARGE, END_OF_EQUATION],
        "EventType": INFORMATION,
        "EventID": 1000,
        "EventText": "Charge is low",
    }
]


def image() -> TableImage:
    """The table."""
    unused = {"DefaultState": NOT_USED, "RPNEquation": [0, END_OF_EQUATION], "EventType": INFORMATION}
    return TABLE.image([*USED, *[unused] * (ACTIONPOINTS - len(USED))])


if __name__ == "__main__":
    write_beside(__file__, image())
