"""`CRuntime`: all C code of one processor: its images, its memory, the functions that it calls, and its execution."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, NoReturn

from cfepy.app import Cfe
from cfepy.extra.c.arena import PAGE, Arena
from cfepy.extra.c.calls import CallTable, Declarations
from cfepy.extra.c.crashes import CFault, CJump, explained
from cfepy.extra.c.devices import DevicePorts
from cfepy.extra.c.elf import SharedObject
from cfepy.extra.c.engine import engine
from cfepy.extra.c.guard import POISON, Guard, GuardedTables
from cfepy.extra.c.image import Image
from cfepy.extra.c.lifetimes import Ends, Openings, ThreadLocals
from cfepy.extra.c.linking import LIBRARIES, Exports, LinkedWith, host_library, refused_names, wanted_names
from cfepy.extra.c.memory import CMemory, Constants
from cfepy.extra.c.packets import PacketImages
from cfepy.extra.c.posix.file_tree import PosixFiles
from cfepy.extra.c.posix.mapped_memory import MappedMemory
from cfepy.extra.c.posix.open_descriptors import Descriptor, DescriptorTable
from cfepy.extra.c.posix.signal_actions import SignalActions
from cfepy.extra.c.races import CompiledRaceWatch
from cfepy.extra.c.source_places import CallFrames, CodePlace, PreemptedFrames, raise_at
from cfepy.extra.c.stacks import LEAST, Stacks
from cfepy.extra.c.unwinding import Unwinder
from cfepy.osal import Network
from cfepy.rtos import Kernel
from cfepy.schedules import ExploringKernel, Race
from cfepy.status import CfeError, OsalError
from cfepy.writing.console import Console

if TYPE_CHECKING:
    from cfepy.extra.c.api.unsent import PublicationWatch

HEAP = 1 << 30
"""Bytes of address space for malloc, and as many for messages."""
CALLBACK_STACK = 65536
SLACK = 64
"""Bytes behind a message buffer that code may write by mistake, because NASA's pool has few block sizes."""
_LIBC_STATE = 1024
"""Offset of libc's state (`LibcState` of engine/natives.h) in the page of the first table of <ctype.h>."""
_STRTOK = 0
"""Offset of the place of strtok() in it."""


class CRuntime:
    """The C side of a processor.

    Args:
        cfe: the services.
        handle: the services as applications reach them, with their scheduling points.
        kernel: the processor.
        polling_ns: virtual time of a call with which code may poll.
        console: for printf.
        stall_s: returns the seconds without progress after which the stall watch ends a run; 0 for never.
        omit_deprecated: whether the code was built with OMIT_DEPRECATED, which makes handles of tables ids.
        guard: blocks of memory end at inaccessible memory, freed blocks are inaccessible, and new blocks and stacks are
            not zero.
        on_race: gets the data races that are found while schedules are explored.
        on_overwrite: gets the application and a text for a write past a block, if no call is at fault.
        on_stack: gets application and task, the bytes of its stack that the task has used, and the stack's size.
        nodes: names of ROS nodes by the names of their applications: their printed lines begin with these names.
        publication_watch: takes the messages of ROS nodes that reach no subscriber; None if there are no such nodes.
        devices: the devices at its ports and buses; None if there are none.

    Attributes:
        arena, memory, constants, packets: the parts of the memory.
        guard, tables: check blocks and images of tables; None without the guard.
        tells_code: whether the operating system gives addresses of code; NASA's Linux does not.
        applications, libraries: loaded images, by the name of the application or the path of the library.
        modules: images that OS_ModuleLoad loaded, by the module's id.
        openings: which images are open, and which stay.
        at_app_end: called when an application has ended.
        at_close: called at the end of the processor, while its memory still exists.
        descriptors, posix_files, file_streams: the descriptors, files and FILEs of POSIX.
        signals, mapped_memory: the action of SIGPIPE, and the memory of mmap.
        openers: called with path, flags and permissions before a file is opened; they return a device or None.
        on_unload: functions that get each image before it is unloaded.
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
        on_race: Callable[[Race], object] = lambda race: None,
        on_overwrite: Callable[[str, str], object] = lambda app, text: None,
        on_stack: Callable[[str, str, int, int], object] = lambda app, task, used, size: None,
        nodes: Mapping[str, str] | None = None,
        publication_watch: PublicationWatch | None = None,
        devices: DevicePorts | None = None,
    ) -> None:
        from cfepy.extra.c.api import declare
        from cfepy.extra.c.api.stdio import FileStreams
        from cfepy.extra.c.api.streams import Streams

        made = engine()
        made.begin(CfeError, CFault, CJump)
        self.cfe = cfe
        self.handle = handle
        self.kernel = kernel
        self.polling_ns = polling_ns
        self.console = console
        self.omit_deprecated = omit_deprecated
        self.publication_watch = publication_watch
        self.devices = DevicePorts({}, Network(), lambda: 0) if devices is None else devices
        self._limit_s = stall_s
        self.arena = Arena()
        self.memory = CMemory()
        self.constants = Constants(self.arena)
        self.at_app_end: list[Callable[[], object]] = []
        self.at_close: list[Callable[[], object]] = [self.devices.close]
        self._unwinder = Unwinder(self.image_at, self.memory)
        self._on_stack = on_stack
        self._stacks = Stacks(self.arena, POISON if guard else b"")
        self._heap = made.Heap(self.arena.map(HEAP), HEAP, guarded=guard, page=PAGE)
        messages = made.Heap(self.arena.map(HEAP), HEAP, slack=SLACK, guarded=guard, grain=4, page=PAGE)
        self.packets = PacketImages(messages, handle.sb, cfe.sb, guard)
        self._owners: dict[int, str] = {}
        self.guard = Guard(self.arena, self._heap, messages, self._name_of, on_overwrite) if guard else None
        self.tables = GuardedTables(self.guard) if self.guard is not None else None
        config = cfe.es.config
        self.thread_locals = ThreadLocals(kernel, self._heap, self.run)
        ctype = self._ctype_tables()
        self._libc = ctype[0] + _LIBC_STATE
        self.table = made.Table(
            heap=self._heap,
            images=self.packets.images,
            charge=kernel.charge if polling_ns else None,
            cost=polling_ns,
            preempted=PreemptedFrames(self._place, self._watch),
            highest_msg_id=config.sb_highest_valid_msg_id,
            largest_message=config.sb_max_msg_size,
            ctype=ctype,
            state=self._libc,
            errno_at=self.thread_locals.errno,
        )
        self.tells_code = cfe.psp.all_memory is None
        self.declared = Declarations(self._libc)
        self.streams = Streams(console.write, lambda: getattr(kernel.current.owner, "name", ""), nodes)
        self.signals = SignalActions()
        self.descriptors = DescriptorTable()
        self.mapped_memory = MappedMemory(self.arena, self.memory)
        self.openers: list[Callable[[str, int, int], Descriptor | None]] = []
        self.posix_files = PosixFiles(cfe.os.files, lambda: kernel.now, self._tell_outside)
        self.file_streams = FileStreams(self)
        self._outside: set[str] = set()
        self.ends = Ends(self.run, self.image_at)
        self.libraries: dict[str, Image] = {}
        self.modules: dict[int, Image] = {}
        self.openings = Openings()
        self.applications: dict[str, Image] = {}
        self.on_unload: list[Callable[[Image], None]] = [self.ends.forget, self.thread_locals.forget]
        self._images: list[Image] = []
        self._own: dict[Image, tuple[Image, ...]] = {}
        declare(self.declared, self)
        self._calls = CallTable(self.arena, self.table, self.declared)
        self._races = (
            CompiledRaceWatch(
                kernel,
                self.table,
                self.declared,
                self.memory,
                self.place_of,
                lambda address: str(self._place(address) or ""),
                self._describe,
                on_race,
            )
            if isinstance(kernel, ExploringKernel)
            else None
        )
        self._exports = Exports(self.shared, self._calls, self.declared, self.arena.map)

    def _ctype_tables(self) -> tuple[int, ...]:
        """Copy the tables of <ctype.h>. Returns cells that point to their element 0.

        Behind the first table is libc's own state.
        """
        cells = []
        for raw, width in zip(engine().ctype(), (2, 4, 4), strict=True):
            at = self.arena.map(len(raw) + 8)
            self.memory.poke(at + 8, raw)
            self.memory.put_u64(at, at + 8 + 128 * width)
            cells.append(at)
        return tuple(cells)

    # -- code --------------------------------------------------------------------------------------------------------

    def load(self, file: str, source: SharedObject) -> Image:
        """Load a new copy of a shared object, call its load functions, and open it.

        Args:
            file: its virtual path.
            source: the object.

        Raises:
            CFault: a load function failed; the object is unloaded again.
        """
        own: tuple[Image, ...] = ()
        used: set[Image] = set()
        try:
            for name in LIBRARIES:
                if name in source.needed:
                    own += (self._loaded(host_library(name), own, used),)
            image = self._loaded(source, own, used)
        except BaseException:
            self._drop(*own[::-1])
            raise
        self._own[image] = own
        self.openings.begin(image, file, used - {image, *own})
        return image

    def _loaded(self, source: SharedObject, own: tuple[Image, ...], used: set[Image]) -> Image:
        image = Image(source, self.arena, LinkedWith(self._exports, self.thread_locals, own, self.run, used))
        self._images.append(image)
        try:
            for function in image.functions_at_load:
                self.run(function)
        except BaseException:
            self._drop(image)
            raise
        if self._races is not None:
            self._races.has_prepared()
        return image

    def unload(self, app_name: str) -> None:
        """Unload the code of an ended application, and free its blocks of malloc and of messages."""
        image = self.applications.pop(app_name, None)
        if image is not None:
            with self.streams.ending(app_name):
                self.close_image(image)
        for module_id in list(self.modules):
            if not self._is_known(module_id):  # it was freed with the other objects of the application
                self.close_image(self.modules.pop(module_id))
        apps = self.cfe.es.apps
        for owner in [each for each in self._owners if apps.find(each) is None]:
            self._heap.give_all(owner)
        self.packets.clean_up()
        for function in self.at_app_end:
            function()
        if self.guard is not None:
            self.guard.tell()
        self._owners = {owner: name for owner, name in self._owners.items() if apps.find(owner) is not None}

    def _name_of(self, owner: int) -> str:
        """Return the name of the application with an AppId that has called C code."""
        return self._owners.get(owner, "")

    @property
    def allocations(self) -> int:
        """Blocks that all code has taken from malloc so far, including operator new and libstdc++."""
        takes: int = self._heap.takes
        return takes

    def reallocate(self, address: int, size: int) -> int:
        """Return a block of malloc of the current application, in place of another one, whose bytes are not kept.

        Args:
            address: the other block; 0 for none.
            size: bytes.
        """
        self._heap.owner = getattr(self.kernel.current.owner, "app_id", 0)
        if address:
            self._heap.give(address)
        return int(self._heap.take(size))

    def close_image(self, image: Image) -> None:
        """Close an image. The images that leave memory with it are unloaded after a call of their end functions."""
        for leaving in self.openings.end(image):
            self._leave_tables(leaving)
            for each in (leaving, *self._own.pop(leaving, ())[::-1]):
                self._finish(each)
                self._drop(each)

    def _leave_tables(self, image: Image) -> None:
        self.cfe.tbl.leave_memory(lambda data: self.memory.address_of(data) in image)

    def _drop(self, *images: Image) -> None:
        for each in images:
            for forget in self.on_unload:
                forget(each)
            self._images.remove(each)
            each.unload()

    def core_memory(self, size: int) -> memoryview:
        """Return memory for a pool of the core, such as the pool of tables, whose addresses applications get."""
        memory: memoryview = self.memory.view(self.arena.map(size, shares=True), size)
        return memory

    def _finish(self, image: Image) -> None:
        """Call the end functions of an image. A fault there ends only these calls."""
        try:
            self.ends.finish(image)
        except CFault as fault:
            self.console.write(f"OS_ModuleUnload: {image.source.name}: {fault}")

    def images(self) -> list[Image]:
        """Return the loaded images, in the order of loading."""
        return list(self._images)

    def image_at(self, address: int) -> Image | None:
        """Return the image that contains an address."""
        return next((image for image in self._images if address in image), None)

    def shared(self) -> list[Image]:
        """Return the images whose symbols all code sees."""
        return list(dict.fromkeys((*self.libraries.values(), *self.openings.with_global_names)))

    def _is_known(self, module_id: int) -> bool:
        try:
            self.cfe.os.module_code(module_id)
        except OsalError:
            return False
        return True

    def symbol(self, name: str) -> int | None:
        """Return the address of a function or variable, for OS_SymbolLookup.

        It is searched in the API, libraries, modules and applications, in this order.
        """
        found = self._exports.declared_symbol(name)
        if found is not None:
            return found
        at = next((image.symbols[name] for image in self.libraries.values() if name in image.symbols), None)
        if at is None:
            at = self.openings.look_up(name)
        others = (*self.modules.values(), *self.applications.values()) if at is None else ()
        return next((image.symbols[name] for image in others if name in image.symbols), at)

    def missing(self, source: SharedObject) -> list[str]:
        """Return the undefined names that an object needs.

        Raises:
            ElfError: a library of the host does not exist.
        """
        libraries = {name for image in self.shared() for name in (*image.thread_locals, *image.symbols)}
        refused = refused_names(source)
        return [
            name
            for name in wanted_names(source)
            if name not in libraries and (name in refused or self._exports.symbol(name) is None)
        ]

    # -- running -----------------------------------------------------------------------------------------------------

    def run(self, function: int, *args: int, stack: int = 0, size: int = 0) -> int:
        """Call a C function in the current task, on its own stack.

        Args:
            function: its address.
            args: at most six numbers or pointers.
            stack: the lowest address of a stack that the application provides; 0 for one of the arena.
            size: its bytes; 0 for a callback, whose stack belongs to no task.

        Returns:
            Its return value, as a uint64.

        Raises:
            CFault: the code failed.
        """
        task = self.kernel.current
        owner = getattr(task.owner, "app_id", 0)
        if owner:
            self._owners[owner] = task.owner.name
        if self.kernel.frames_wanted and self.table.frames is None:
            self.table.frames = CallFrames(self._place, self.kernel.call_heard)
        given, room = (stack, size) if stack else self._stacks.take(size or CALLBACK_STACK)
        is_outermost = self.thread_locals.begin()
        number = self._races.begin(self.image_at(function)) if self._races is not None else 0
        try:
            result = int(
                engine().run(self.table, function, args, given, room, owner, number, id(task), not is_outermost)
            )
            if is_outermost:
                self.thread_locals.finish()
            return result
        except CFault as fault:
            if isinstance(fault, CJump) and not is_outermost:
                raise
            calls = self._unwinder.calls(*fault.registers)
            made = explained(fault, self.place_of, self._about)
            if fault.is_anywhere:
                self.console.show(f"stopped in {' > '.join(self.place_of(each) for each in calls)}")
                calls = []
            raise_at([place for each in calls or [made.at] if (place := self._place(each)) is not None], made)
        except _Passing as passing:
            if not is_outermost:
                raise
            raise passing.error from None
        finally:
            if is_outermost:
                self.thread_locals.leave(task)
                if self._races is not None:
                    self._races.leave(task)
            if not stack:
                if size:
                    app = getattr(task.owner, "name", "")
                    self._on_stack(app, task.name, self._stacks.used(given, room), size)
                self._stacks.give(given, room)

    def raise_through(self, error: CfeError) -> NoReturn:
        """Raise an error from a function of the API that ends the C code and does not become a status."""
        raise _Passing(error)

    def run_main(self, function: int) -> None:
        """Run the main function of an application, on a stack of the size in its startup line."""
        owner = self.kernel.current.owner
        params = getattr(owner, "params", None)
        try:
            self.run(function, size=getattr(params, "stack_size", LEAST))
        finally:
            self.streams.finish(getattr(owner, "name", ""))

    def status(self, function: int, *args: int) -> int:
        """Call a function that returns an int32, as `run` does."""
        result = self.run(function, *args) & 0xFFFFFFFF
        return result - (result >> 31 << 32)

    def _watch(self, computed_s: float, called_from: int) -> None:
        """Let Python handle waiting work, such as Ctrl-C or other threads, while code computes without a call.

        Args:
            computed_s: time of this computation.
            called_from: return address of the last call, which is the same in each run; the current address of the code
                is not.

        Raises:
            CFault: it has computed for too long; the virtual clock stands still, so it would never end.
        """
        limit = self._limit_s() / 2  # before the stall watch ends the run
        if limit and computed_s >= limit:
            fault = CFault(f"runaway loop: no call for {limit:g} s")
            fault.is_anywhere = True
            raise fault

    def _place(self, address: int) -> CodePlace | None:
        image = self.image_at(address)
        return None if image is None else image.place_at(address)

    def _about(self, address: int) -> str:
        """Return the block that contains an address, or is next to it, in words; empty without the guard."""
        return "" if self.guard is None else self.guard.about(address)

    def _describe(self, address: int) -> str:
        """Return the name of a variable, or just the address."""
        if address == self._libc + _STRTOK:
            return "the place of strtok()"
        image = self.image_at(address)
        return (image.variable_at(address) if image is not None else "") or f"memory at 0x{address:x}"

    def _tell_outside(self, function: str, path: str) -> None:
        """Report a path that leads out of the mission's files, once."""
        if path in self._outside:
            return
        self._outside.add(path)
        where = f"in the file systems of the mission ({', '.join(self.cfe.os.files.mount_points())})"
        if path.startswith("/dev/"):
            where = "a device of the mission (`devices:` in the mission file)"
        app = getattr(self.kernel.current.owner, "name", "")
        self.console.write(f"{app}: {function}() of {path}: it is not {where}; errno is ENOENT")

    def place_of(self, address: int) -> str:
        """Return the place of an address of code, in words."""
        place = self._place(address)
        if place is not None:
            return str(place)
        return self._calls.name_at(address) or f"0x{address:x}"

    def close(self) -> None:
        """Free all memory at the end of the processor."""
        if self._races is not None:
            self._races.close()
        for function in self.at_close:
            function()
        for image in self._images[::-1]:
            if image.source.has_coverage:
                self._finish(image)
        if self.kernel.abortion is None:  # exit() of NASA's process writes the buffers, abort() does not
            self.file_streams.flush_all()
        self.mapped_memory.close()
        self.descriptors.close_all()
        if self.guard is not None:
            self.guard.check_all()
        self.cfe.tbl.leave_memory(lambda data: True)  # reports may read tables later
        self.applications.clear()
        self.libraries.clear()
        self.modules.clear()
        self.openings.clear()
        self.arena.close()


class _Passing(Exception):
    """Carries an error through C code, which would otherwise get it as a status."""

    def __init__(self, error: CfeError) -> None:
        super().__init__(error)
        self.error = error
