"""Readers count themselves and lock writers out; they count without a lock."""

import threading

import rospy


class Book:
    def __init__(self) -> None:
        self.lock, self.pen = threading.Lock(), threading.Lock()
        self.readers = 0
        self.pages = ["old", "old"]

    def read(self) -> None:
        self.readers += 1
        if self.readers == 1:
            self.pen.acquire()
        first = self.pages[0]
        rospy.logdebug("read %s", first)
        if self.pages[1] != first:
            raise ValueError("read while somebody writes")
        self.readers -= 1
        if self.readers == 0:
            self.pen.release()

    def write(self) -> None:
        with self.pen:
            for page in range(2):
                self.pages[page] = "new"
                rospy.logdebug("wrote page %d", page)


rospy.init_node("book")
book = Book()
for work in (book.read, book.read, book.write):
    threading.Thread(target=work).start()
