"""A stack without locks that counts its cells and lets nobody take the last. It takes five switches to break."""

import threading

import rospy

CELLS, ROUNDS = 3, 2


class Atomic:
    """A number that is changed in one step."""

    def __init__(self, value: int) -> None:
        self.value = value
        self.lock = threading.Lock()

    def swap(self, new: int) -> int:
        with self.lock:
            old, self.value = self.value, new
            return old

    def swap_if(self, old: int, new: int) -> bool:
        with self.lock:
            if self.value != old:
                return False
            self.value = new
            return True

    def add(self, amount: int) -> int:
        with self.lock:
            self.value += amount
            return self.value


class SafeStack:
    def __init__(self) -> None:
        self.next = [Atomic(1), Atomic(2), Atomic(-1)]
        self.head, self.count = Atomic(0), Atomic(CELLS)

    def pop(self) -> int:
        while self.count.value > 1:
            head = self.head.value
            after = self.next[head].swap(-1)
            if after >= 0:
                if self.head.swap_if(head, after):
                    self.count.add(-1)
                    return head
                self.next[head].swap(after)
            rospy.sleep(0.001)  # somebody else has the cell
        return -1

    def push(self, cell: int) -> None:
        while True:
            head = self.head.value
            self.next[cell].value = head
            if self.head.swap_if(head, cell):
                break
        self.count.add(1)


def work(me: int) -> None:
    for _ in range(ROUNDS):
        cell = stack.pop()
        if cell < 0:
            continue
        owners[cell] = me
        if owners[cell] != me:
            raise ValueError(f"cell {cell} has two owners")
        stack.push(cell)


rospy.init_node("cells")
stack, owners = SafeStack(), [0] * CELLS
for number in range(3):
    threading.Thread(target=work, args=(number,)).start()
