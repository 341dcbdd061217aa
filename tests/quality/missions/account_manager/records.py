"""Makes an account, if there is none of that name yet. The database answers one question at a time."""

import sys
import threading

import rospy


class Database:
    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.rows = {}

    def has(self, name: str) -> bool:
        with self.lock:
            return name in self.rows

    def write(self, name: str, owner: str) -> None:
        with self.lock:
            self.rows[name] = owner

    def add(self, name: str, owner: str) -> bool:
        with self.lock:
            return self.rows.setdefault(name, owner) is owner


def create(owner: str) -> None:
    if not database.has("shared"):
        database.write("shared", owner)
        created.append(owner)


rospy.init_node("records")
database, created = Database(), []
threads = [threading.Thread(target=create, args=(owner,)) for owner in ("alice", "bob")]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
if len(created) != 1:
    sys.exit(f"the account was made by {created}")
