"""A door whose state is changed in one step, from the one that was read; only closing does not look again."""

import threading

import rospy


class Door:
    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.state = "closed"

    def change(self, before: str, after: str) -> bool:
        with self.lock:
            if self.state != before:
                return False
            self.state = after
            return True

    def pass_through(self) -> None:
        if self.change("closed", "open"):
            rospy.logdebug("somebody passes")
            if not self.change("open", "closed"):
                raise RuntimeError(f"the door is {self.state}, and somebody is in it")

    def bolt(self) -> None:
        if self.state == "closed":
            with self.lock:
                self.state = "bolted"


rospy.init_node("door")
door = Door()
for work in (door.pass_through, door.bolt):
    threading.Thread(target=work).start()
