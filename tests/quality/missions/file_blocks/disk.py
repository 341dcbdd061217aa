"""Each file has a lock, and so has each block; whether a block is free is looked at without its lock."""

import threading

import rospy

FILES, BLOCKS = 3, 4


class Disk:
    def __init__(self) -> None:
        self.file_locks = [threading.Lock() for _ in range(FILES)]
        self.block_locks = [threading.Lock() for _ in range(BLOCKS)]
        self.owners = [None] * BLOCKS

    def create(self, file: int) -> None:
        with self.file_locks[file]:
            for block in range(BLOCKS):
                if self.owners[block] is None:
                    with self.block_locks[block]:
                        self.take(block, file)
                    return

    def take(self, block: int, file: int) -> None:
        if self.owners[block] is not None:
            raise RuntimeError(f"block {block} belongs to file {self.owners[block]}, and to {file}")
        self.owners[block] = file


rospy.init_node("disk")
disk = Disk()
for number in range(FILES):
    threading.Thread(target=disk.create, args=(number,)).start()
