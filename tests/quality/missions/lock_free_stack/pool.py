"""Three threads take cells from a stack without locks and put them back. Its head may be what it was, its next not."""

import threading

import rospy

CELLS, ROUNDS = 3, 2


class Atomic:
    """A number that is changed in one step."""

    def __init__(self, value: int) -> None:
        self.value = value
        self.lock = threading.Lock()

    def swap_if(self, old: int, new: int) -> bool:
        with self.lock:
            if self.value != old:
                return False
            self.value = new
            return True


class Stack:
    def __init__(self) -> None:
        self.next = [1, 2, -1]
        self.head = Atomic(0)

    def pop(self) -> int:
        while (head := self.head.value) >= 0:
            after = self.next[head]
            if self.head.swap_if(head, after):
                return head
        return -1

    def push(self, cell: int) -> None:
        while True:
            head = self.head.value
            self.next[cell] = head
            if self.head.swap_if(head, cell):
                return


def work(me: int) -> None:
    for _ in range(ROUNDS):
        cell = stack.pop()
        if cell < 0:
            continue
        owners[cell] = me
        rospy.logdebug("cell %d", cell)
        if owners[cell] != me:
            raise ValueError(f"cell {cell} has two owners")
        stack.push(cell)


rospy.init_node("pool")
stack, owners = Stack(), [0] * CELLS
for number in range(3):
    threading.Thread(target=work, args=(number,)).start()
