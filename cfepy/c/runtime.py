"""`CRuntime`: all C code of one processor: its images, its memory, the functions that it calls, and how it is run."""

from __future__ import annotations

from collections.abc import Callable
from typing import NoReturn

from cfepy.app import Cfe
from cfepy.c.arena import Arena
from cfepy.c.calls import CallTable, Declarations
from cfepy.c.elf import SharedObject
from cfepy.c.engine import engine
from cfepy.c.faults import CFault, explained
from cfepy.c.image import Image
from cfepy.c.memory import CMemory, Constants
from cfepy.c.packets import PacketImages
from cfepy.c.places import CallFrames, CodePlace, PreemptedFrames, raise_at
from cfepy.c.stacks import LEAST, Stacks
from cfepy.console import Console
from cfepy.rtos import Kernel, Task
from cfepy.status import CfeError

POISON = b"\xa5"
"""What is in memory that was never written, where that is to be found out."""
HEAP = 1 << 30
"""Bytes of address space for malloc, and as many for messages."""
CALLBACK_STACK = 65536
SLACK = 64
"""Bytes behind a message buffer that may be written by mistake: NASA's pool has blocks of a few sizes."""


class CRuntime:
    """The C side of a processor.

    Args:
        cfe: the services.
        handle: the services as applications reach them, with their scheduling points.
        kernel: the processor.
        polling_ns: what a call costs with which code may wait by asking again and again.
        console: for printf.
        stall_s: after how many seconds without progress the stall watch ends a run; 0 for never.
        omit_deprecated: whether the code was built with OMIT_DEPRECATED, which makes handles of tables ids.
        guard: blocks of memory end where nobody may write, freed ones are gone, and fresh ones and stacks are not zero.

    Attributes:
        arena, memory, constants, packets: the parts of the memory.
        applications, libraries: what is loaded, by the name of the application or the path of the library.
        modules: what OS_ModuleLoad loaded, and whether code that is loaded later sees its symbols.
        at_close: called at the end of the processor, while its memory is still there.
    """

    def __init__(
        self,
        cfe: Cfe,
        handle: Cfe,
        kernel: Kernel,
        polling_ns: int,
        console: Console,
        stall_s: Callable[[], float],
        omit_deprecated: bool = False,
        guard: bool = False,
    ) -> None:
        from cfepy.c.api import declare

        made = engine()
        made.begin(CfeError, CFault)
        self.cfe = cfe
        self.handle = handle
        self.kernel = kernel
        self.console = console
        self.omit_deprecated = omit_deprecated
        self._limit_s = stall_s
        self.arena = Arena()
        self.memory = CMemory()
        self.constants = Constants(self.arena)
        self._in_code: set[Task] = set()
        self.at_close: list[Callable[[], object]] = []
        self._stacks = Stacks(self.arena, POISON if guard else b"")
        self._heap = made.Heap(self.arena.map(HEAP), HEAP, guarded=guard)
        messages = made.Heap(self.arena.map(HEAP), HEAP, slack=SLACK, guarded=guard, grain=4)
        self.packets = PacketImages(messages, handle.sb, cfe.sb, guard)
        config = cfe.es.config
        self.table = made.Table(
            heap=self._heap,
            images=self.packets.images,
            charge=kernel.charge if polling_ns else None,
            cost=polling_ns,
            preempted=PreemptedFrames(self._place, self._watch),
            highest_msg_id=config.sb_highest_valid_msg_id,
            largest_message=config.sb_max_msg_size,
            ctype=self._ctype_tables(),
        )
        self.declared = Declarations()
        declare(self.declared, self)
        self._calls = CallTable(self.arena, self.table, self.declared)
        self._owners: set[int] = set()
        self.libraries: dict[str, Image] = {}
        self.modules: dict[Image, bool] = {}
        self.applications: dict[str, Image] = {}

    def _ctype_tables(self) -> tuple[int, ...]:
        """Copies of the tables of <ctype.h>: cells that point to their element 0."""
        cells = []
        for raw, width in zip(engine().ctype(), (2, 4, 4), strict=True):
            at = self.arena.map(len(raw) + 8)
            self.memory.poke(at + 8, raw)
            self.memory.put_u64(at, at + 8 + 128 * width)
            cells.append(at)
        return tuple(cells)

    # -- code --------------------------------------------------------------------------------------------------------

    def load(self, source: SharedObject) -> Image:
        """Load a shared object anew and call what it wants to be called at load."""
        image = Image(source, self.arena, self._resolve)
        for function in image.functions_at_load:
            self.run(function)
        return image

    def unload(self, app_name: str) -> None:
        """An application has ended: take its code out of memory, and what it had of malloc and of messages."""
        image = self.applications.pop(app_name, None)
        if image is not None:
            self.cfe.tbl.leave_memory(lambda data: self.memory.address_of(data) in image)
            image.unload()
        apps = self.cfe.es.apps
        for owner in [each for each in self._owners if apps.find(each) is None]:
            self._heap.give_all(owner)
            self._owners.discard(owner)
        self.packets.clean_up()

    def core_memory(self, size: int) -> memoryview:
        """Memory for a pool of the core's, such as that of tables, to whose bytes applications get addresses."""
        memory: memoryview = self.memory.view(self.arena.map(size, shares=True), size)
        return memory

    def _resolve(self, name: str) -> int:
        found = next((image.symbols[name] for image in self._shared() if name in image.symbols), None)
        return self._calls.address(name) if found is None else found

    def _shared(self) -> list[Image]:
        """The images whose symbols all code sees."""
        return [*self.libraries.values(), *(image for image, is_global in self.modules.items() if is_global)]

    def unload_module(self, image: Image) -> None:
        """Take what OS_ModuleLoad loaded out of memory."""
        self.modules.pop(image, None)
        image.unload()

    def symbol(self, name: str) -> int | None:
        """Where a function or variable is: of the API, a library, a module or an application, in this order."""
        if name in self.declared:
            return self._calls.address(name)
        images = (*self._shared(), *self.modules, *self.applications.values())
        return next((image.symbols[name] for image in images if name in image.symbols), None)

    def missing(self, source: SharedObject) -> list[str]:
        """Names that an object needs and nobody has."""
        shared = self._shared()
        return [
            name
            for name in source.wanted()
            if name not in self.declared and not any(name in image.symbols for image in shared)
        ]

    # -- running -----------------------------------------------------------------------------------------------------

    def run(self, function: int, *args: int, stack: int = 0, size: int = CALLBACK_STACK) -> int:
        """Call a C function in the current task, on a stack of its own; what it returns, as a uint64.

        Args:
            function: its address.
            args: at most six numbers or pointers.
            stack: the lowest address of a stack that the application brings; 0 for one of the arena.
            size: its bytes.

        Raises:
            CFault: the code failed.
        """
        task = self.kernel.current
        owner = getattr(task.owner, "app_id", 0)
        if owner:
            self._owners.add(owner)
        if self.kernel.frames_wanted and self.table.frames is None:
            self.table.frames = CallFrames(self._place)
        given, room = (stack, size) if stack else self._stacks.take(size)
        is_callback = task in self._in_code
        self._in_code.add(task)
        try:
            return int(engine().run(self.table, function, args, given, room, owner))
        except CFault as fault:
            made = explained(fault, self.place_of)
            raise_at(self._place(made.at), made)
        except _Passing as passing:
            if is_callback:
                raise
            raise passing.error from None
        finally:
            if not is_callback:
                self._in_code.discard(task)
            if not stack:
                self._stacks.give(given, room)

    def raise_through(self, error: CfeError) -> NoReturn:
        """Raise an error in a function of the API that ends the C code, and is no status for it."""
        raise _Passing(error)

    def run_main(self, function: int) -> None:
        """Run the main function of an application, on a stack of the size that its startup line says."""
        params = getattr(self.kernel.current.owner, "params", None)
        self.run(function, size=getattr(params, "stack_size", LEAST))

    def status(self, function: int, *args: int) -> int:
        """As `run`, for a function that returns an int32."""
        result = self.run(function, *args) & 0xFFFFFFFF
        return result - (result >> 31 << 32)

    def _watch(self, computed_s: float, called_from: int) -> None:
        """Code has computed for a while without a call: Python does here what waits, such as Ctrl-C, or other threads.

        Args:
            computed_s: for how long.
            called_from: where the last call returned to, which is the same in each run; where the code is now is not.

        Raises:
            CFault: it has computed for too long; the virtual clock stands still, so it would never end.
        """
        limit = self._limit_s() / 2  # before the stall watch ends the run
        if limit and computed_s >= limit:
            raise CFault(f"runaway loop: no call for {limit:g} s")

    def _place(self, address: int) -> CodePlace | None:
        for image in (*self.applications.values(), *self.libraries.values(), *self.modules):
            if address in image:
                return image.place_at(address)
        return None

    def place_of(self, address: int) -> str:
        """Where an address of code is, in words."""
        place = self._place(address)
        if place is not None:
            return str(place)
        return self._calls.name_at(address) or f"0x{address:x}"

    def close(self) -> None:
        """The processor is at its end: give all memory back."""
        for function in self.at_close:
            function()
        self.cfe.tbl.leave_memory(lambda data: True)  # what tells of the run may look at tables later
        self.applications.clear()
        self.libraries.clear()
        self.modules.clear()
        self.arena.close()


class _Passing(Exception):
    """Carries an error through C code, which would get it as a status otherwise."""

    def __init__(self, error: CfeError) -> None:
        super().__init__(error)
        self.error = error
