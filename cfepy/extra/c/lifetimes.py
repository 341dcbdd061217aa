"""Lifetimes: thread-local variables of tasks and objects, calls at an end, and the time that an object is in memory."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from typing import Any

from cfepy.extra.c.image import Image
from cfepy.extra.c.memory import CMemory
from cfepy.rtos import Kernel, Task

_ERRNO = 0
"""The module that stands for libc: its one variable is errno."""
_LEAST = 16


class ThreadLocals:
    """The thread-local variables of a processor: a block for each task and object, made when first used.

    Args:
        kernel: knows the current task.
        heap: the engine's heap, for the blocks.
        run: calls a function of C.
    """

    def __init__(self, kernel: Kernel, heap: Any, run: Callable[..., int]) -> None:
        self._kernel = kernel
        self._heap = heap
        self._run = run
        self._memory = CMemory()
        self._images: dict[int, Image] = {}
        self._numbers: dict[Image, int] = {}
        self._next = _ERRNO + 1
        self._blocks: dict[Task, dict[int, tuple[int, int]]] = {}  # (block as the heap gave it, its aligned address)
        self._at_end: dict[Task, list[tuple[int, int]]] = {}
        self._running: set[Task] = set()

    def module_of(self, image: Image) -> int:
        """Return the number of an image, which the code passes to `address`."""
        number = self._numbers.get(image)
        if number is None:
            number = self._numbers[image] = self._next
            self._next += 1
            self._images[number] = image
        return number

    def forget(self, image: Image) -> None:
        """Forget an unloaded image."""
        number = self._numbers.pop(image, None)
        if number is not None:
            del self._images[number]

    def address(self, module: int, offset: int) -> int:
        """Return the address of a variable for the current task (__tls_get_addr)."""
        blocks = self._blocks.setdefault(self._kernel.current, {})
        block = blocks.get(module)
        if block is None:
            block = blocks[module] = self._make(module)
        return block[1] + offset

    def errno(self) -> int:
        """Return the address of errno for the current task."""
        return self.address(_ERRNO, 0)

    def _make(self, module: int) -> tuple[int, int]:
        start, size, alignment, first = 0, _LEAST, _LEAST, b""
        if module != _ERRNO:
            image = self._images[module]
            assert image.source.thread_local is not None
            start, in_file, size, alignment = image.source.thread_local
            first = image.source.initial(start, in_file)
        self._heap.owner = 0  # it belongs to its task, not to its first user
        block = int(self._heap.take(size + alignment))
        if not block:
            raise MemoryError(f"not enough memory for {size} more bytes of thread-local variables")
        at = block + (start - block) % max(alignment, 1)
        self._memory.poke(at, first.ljust(size, b"\0"))
        return block, at

    # -- lives of tasks ----------------------------------------------------------------------------------------------

    def begin(self) -> bool:
        """Record that the current task calls C. Returns True if it was not in a C call before."""
        task = self._kernel.current
        if task in self._running:
            return False
        self._running.add(task)
        return True

    def at_end(self, function: int, argument: int) -> None:
        """Call a function when the current task returns from its entry point (__cxa_thread_atexit_impl)."""
        self._at_end.setdefault(self._kernel.current, []).append((function, argument))

    def finish(self) -> None:
        """Destroy the variables of the current task, which has returned from its entry point."""
        waiting = self._at_end.get(self._kernel.current)
        while waiting:
            self._run(*waiting.pop())

    def leave(self, task: Task) -> None:
        """Give back the blocks of a task that no longer calls C."""
        self._running.discard(task)
        self._at_end.pop(task, None)
        for block, _ in self._blocks.pop(task, {}).values():
            self._heap.give(block)


class Ends:
    """The functions to call at the end of their image.

    Args:
        run: calls a function of C.
        image_at: returns the image that contains an address.
    """

    def __init__(self, run: Callable[..., int], image_at: Callable[[int], Image | None]) -> None:
        self._run = run
        self._image_at = image_at
        self._waiting: list[tuple[int, int, Image | None]] = []

    def add(self, function: int, argument: int, handle: int) -> None:
        """Call a function at the end of the image with the address `handle`, or of its own image (__cxa_atexit)."""
        self._waiting.append((function, argument, self._image_at(handle) or self._image_at(function)))

    def finalize(self, handle: int) -> None:
        """Call the functions of the image that has an address, last in, first out (__cxa_finalize)."""
        image = self._image_at(handle)
        for function, argument in self._taken(image):
            self._run(function, argument)

    def finish(self, image: Image) -> None:
        """Call all end functions of an image."""
        for function in image.functions_at_end:
            self._run(function)
        self.finalize(image.base)

    def forget(self, image: Image) -> None:
        """Forget an unloaded image."""
        self._waiting = [each for each in self._waiting if each[2] is not image]

    def _taken(self, image: Image | None) -> Iterator[tuple[int, int]]:
        """Take and yield the functions of an image. A called function may add more."""
        while True:
            mine = [each for each in self._waiting if each[2] is image]
            if not mine:
                return
            self._waiting.remove(mine[-1])
            yield mine[-1][:2]


class Openings:
    """Which loaded objects are open, and which stay in memory for others, as Linux's dlopen and dlclose decide.

    An object that is opened again is the same object, with the same variables. It leaves memory when it is open no more
    and no other object in memory uses a name of it. OSAL looks up global names for the executable, which never ends, so
    glibc keeps an object for good in which OS_SymbolLookup has found a global name.

    Attributes:
        with_global_names: objects whose names all code sees, apart from libraries; in the order of their opening.
    """

    def __init__(self) -> None:
        self.with_global_names: dict[Image, None] = {}
        self._files: dict[Image, str] = {}
        self._count: Counter[Image] = Counter()
        self._used: dict[Image, set[Image]] = {}
        self._kept: set[Image] = set()

    def begin(self, image: Image, file: str, used: Iterable[Image]) -> None:
        """Count the first opening of an object.

        Args:
            image: the object.
            file: its virtual path.
            used: objects whose names it uses.
        """
        self._files[image] = file
        self._used[image] = set(used)
        self.again(image)

    def again(self, image: Image) -> None:
        """Count another opening of an object."""
        self._count[image] += 1

    def of_file(self, file: str, data: bytes) -> Image | None:
        """Return the object of a file that is in memory, or None."""
        return next((each for each, name in self._files.items() if name == file and each.source.data == data), None)

    def look_up(self, name: str) -> int | None:
        """Return the address of a name that all code sees, and keep its object for good; None if none has it."""
        for image in self.with_global_names:
            if name in image.symbols:
                self._kept.add(image)
                return image.symbols[name]
        return None

    def end(self, image: Image) -> list[Image]:
        """Count the end of an opening.

        Args:
            image: the object.

        Returns:
            The objects that leave memory: the object itself, and those that only it has used.
        """
        self._count[image] -= 1
        leaving: list[Image] = []
        while True:
            used = {other for each in self._files for other in self._used[each]}
            idle = [each for each in self._files if self._count[each] <= 0 and each not in used | self._kept]
            if not idle:
                return leaving
            leaving += idle
            for each in idle:
                self._forget(each)

    def _forget(self, image: Image) -> None:
        self.with_global_names.pop(image, None)
        for each in (self._files, self._count, self._used):
            each.pop(image)

    def clear(self) -> None:
        """Forget all, at the end of the processor."""
        for each in list(self._files):
            self._forget(each)
        self._kept.clear()
