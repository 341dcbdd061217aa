"""What goes to the ground: telemetry of both processors.

After a change: `python missions/pair/to_lab_sub.py` writes to_lab_sub.tbl anew.
"""

from cfepy.apps.to_lab.packets import SUBSCRIPTIONS
from cfepy.tbl import write_beside

EVENTS = 0x0808
ROWS = (0x0800, 0x0801, 0x0803, 0x0804, 0x0805, EVENTS, 0x0825, 0x0883, 0x08FC)

if __name__ == "__main__":
    limits = {msg_id: 32 if msg_id == EVENTS else 8 for msg_id in ROWS}
    write_beside(__file__, SUBSCRIPTIONS.image([{"Stream": mid, "BufLimit": limit} for mid, limit in limits.items()]))
