"""Who the two processors are: UDP ports of one computer, with tasks, so that nothing waits for SBN's next wakeup.

After a change: `python missions/pair/sbn_conf_tbl.py` writes sbn_conf_tbl.tbl anew.
"""

from cfepy.apps.sbn.definition import TASKS, configuration, peer
from cfepy.tbl import write_beside

if __name__ == "__main__":
    write_beside(
        __file__, configuration([peer(1, "127.0.0.1:2234", tasks=TASKS), peer(2, "127.0.0.1:2235", tasks=TASKS)])
    )
