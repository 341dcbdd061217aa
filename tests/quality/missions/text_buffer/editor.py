"""Texts that are safe by themselves; one is appended to another while somebody shortens it."""

import threading

import rospy


class Text:
    def __init__(self, characters: str) -> None:
        self.lock = threading.RLock()
        self.characters = list(characters)

    def length(self) -> int:
        with self.lock:
            return len(self.characters)

    def get(self, count: int) -> list[str]:
        with self.lock:
            return [self.characters[number] for number in range(count)]

    def clear(self) -> None:
        with self.lock:
            self.characters.clear()

    def append(self, other: "Text") -> None:
        with self.lock:
            self.characters += other.get(other.length())


rospy.init_node("editor")
page, note = Text("page"), Text("note")
threading.Thread(target=page.append, args=(note,)).start()
threading.Thread(target=note.clear).start()
