"""Pipes of the Software Bus: create, delete and name them, and their options (cfe_sb_api.c, first half)."""

from __future__ import annotations

from cfepy.ids import SB_PIPEID_BASE, name_size, to_index
from cfepy.interpreter.compiled import mypyc_attr
from cfepy.osal import OS_MAX_API_NAME
from cfepy.sb import events as ev
from cfepy.sb.buffers import BufferServices
from cfepy.sb.pipe import NOBODY_HEARD, Pipe
from cfepy.status import (
    CFE_SB_BAD_ARGUMENT,
    CFE_SB_MAX_PIPES_MET,
    CFE_SB_PIPE_CR_ERR,
    OS_ERR_NAME_TAKEN,
    OS_ERR_NAME_TOO_LONG,
    OS_ERR_NO_FREE_IDS,
    OS_INVALID_POINTER,
    CfeError,
    OsalError,
)

PIPEOPTS_IGNOREMINE = 1
POINTER_BYTES = 4  # a queue holds addresses of buffers; boards with limited RAM have 32 bits


@mypyc_attr(allow_interpreted_subclasses=True)
class PipeServices(BufferServices):
    """The CFE_SB_*Pipe* functions."""

    def create_pipe(self, depth: int, name: str | None, pointer: int | None = None) -> int:
        """Create a pipe of the calling application (CFE_SB_CreatePipe).

        The id is reserved before the name is checked, so a refused name uses up an id.

        Args:
            depth: maximum number of messages, 1 to OS_QUEUE_MAX_DEPTH.
            name: unique, at most 19 characters; None is C's NULL.
            pointer: address of C's output variable, for the error text; None outside of C.

        Returns:
            The pipe id.

        Raises:
            CfeError: CFE_SB_BAD_ARGUMENT (depth, name), CFE_SB_MAX_PIPES_MET, CFE_SB_PIPE_CR_ERR (name
                taken by a pipe or a queue, or no queue left).
        """
        app = self.caller_name()
        limit = self.config.os_queue_max_depth
        if not 0 < depth <= limit or name == "" or pointer == 0:
            text = f"CreatePipeErr:Bad Input Arg:app={app},ptr=0x{pointer or 0:x},depth={depth},maxdepth={limit}"
            raise self._create_error(ev.CR_PIPE_BAD_ARG_EID, CFE_SB_BAD_ARGUMENT, text)
        if len(self.pipes) >= self.config.sb_max_pipes:
            text = f"CreatePipeErr:Max Pipes({self.config.sb_max_pipes})In Use.app {app}"
            raise self._create_error(ev.MAX_PIPES_MET_EID, CFE_SB_MAX_PIPES_MET, text)
        if name is None or name_size(name) >= OS_MAX_API_NAME:
            self.pipes.skip()
            status = OS_INVALID_POINTER if name is None else OS_ERR_NAME_TOO_LONG
            text = f"CreatePipeErr:OS_QueueCreate returned {status},app {app}"
            raise self._create_error(ev.CR_PIPE_ERR_EID, CFE_SB_PIPE_CR_ERR, text)
        try:
            queue_id = self.ports.queues.pipe_queue_create(name, depth)
        except OsalError as error:
            self.pipes.skip()
            raise self._queue_error(error, name, app) from error
        try:
            return self._add_pipe(depth, name, app, queue_id)
        except CfeError:
            self.ports.queues.pipe_queue_delete(queue_id)
            raise

    def _queue_error(self, error: OsalError, name: str, app: str) -> CfeError:
        failed, event_id = "CreatePipeErr:OS_QueueCreate", ev.CR_PIPE_ERR_EID
        text = f"{failed} returned {error.status},app {app}"
        if error.status == OS_ERR_NAME_TAKEN:
            event_id, text = ev.CR_PIPE_NAME_TAKEN_EID, f"{failed} failed, name taken (app={app}, name={name})"
        elif error.status == OS_ERR_NO_FREE_IDS:
            event_id, text = ev.CR_PIPE_NO_FREE_EID, f"{failed} failed, no free id's (app={app})"
        return self._create_error(event_id, CFE_SB_PIPE_CR_ERR, text)

    def _add_pipe(self, depth: int, name: str, app: str, queue_id: int) -> int:
        owner = self.kernel.current.owner
        size = self.sizes.queue + depth * (self.sizes.queue_slot + POINTER_BYTES)
        claim = self.ports.memory.claim(getattr(owner, "name", "host"), f"pipe {name}", size)
        pipe = Pipe(self.kernel, depth, name, owner)
        pipe.claim, pipe.queue_id = claim, queue_id
        pipe_id = self.pipes.create(pipe)
        pipe.identify(pipe_id)
        self.peaks.pipes = max(self.peaks.pipes, len(self.pipes))
        self.report(ev.PIPE_ADDED_EID, ev.DEBUG, f"Pipe Created:name {name},id {pipe_id},app {app}")
        return pipe_id

    def _create_error(self, event_id: int, status: int, text: str) -> CfeError:
        self.counters.create_pipe_error += 1
        self.report(event_id, ev.ERROR, text)
        return CfeError(status, text)

    def delete_pipe(self, pipe_id: int) -> None:
        """Delete a pipe of the calling application, its subscriptions and its messages (CFE_SB_DeletePipe).

        Raises:
            CfeError: CFE_SB_BAD_ARGUMENT if the pipe does not exist or belongs to another application.
        """
        pipe = self.find_pipe(pipe_id)
        if pipe is None:
            text = f"Pipe Delete Error:Bad Argument,PipedId {pipe_id},Requestor {self.caller_name()}"
            raise self._create_error(ev.DEL_PIPE_ERR1_EID, CFE_SB_BAD_ARGUMENT, text)
        if self.is_foreign(pipe):
            text = f"Pipe Delete Error:Caller({self.caller_name()}) is not the owner of pipe {pipe_id}"
            raise self._create_error(ev.DEL_PIPE_ERR2_EID, CFE_SB_BAD_ARGUMENT, text)
        self.remove_pipe(pipe)
        self._report_deleted(pipe, pipe.app_name)

    def remove_pipe(self, pipe: Pipe) -> None:
        """Delete a pipe without checking its owner, also for the cleanup of an application."""
        for route in self.routes.values():
            destination = route.find(pipe)
            if destination is not None:
                self.remove_destination(route, destination)
        self.pipes.delete(pipe.pipe_id)
        self.ports.memory.release(pipe.claim)
        self.ports.queues.pipe_queue_delete(pipe.queue_id)
        pipe.heed(NOBODY_HEARD)
        pipe.depth = 0  # a transmission in progress then finds it full, and deleted
        if self.config.safe:
            pipe.close(None)
        else:
            pipe.abandon()

    def _report_deleted(self, pipe: Pipe, owner: str) -> None:
        self.report(ev.PIPE_DELETED_EID, ev.DEBUG, f"Pipe Deleted:id {pipe.pipe_id},owner {owner}")

    def set_pipe_opts(self, pipe_id: int, opts: int) -> None:
        """Set the options of a pipe of the calling application (CFE_SB_SetPipeOpts).

        Args:
            pipe_id: the pipe.
            opts: 0 or PIPEOPTS_IGNOREMINE: messages of the owning application are refused.
        """
        pipe = self.find_pipe(pipe_id)
        if pipe is None:
            text = f"Pipe Opts Error:Bad Argument,PipedId {pipe_id},Requestor {self.caller_name()}"
            raise self._opts_error(ev.SETPIPEOPTS_ID_ERR_EID, text)
        if self.is_foreign(pipe):
            text = f"Pipe Opts Set Error: Caller({self.caller_name()}) is not the owner of pipe {pipe_id}"
            raise self._opts_error(ev.SETPIPEOPTS_OWNER_ERR_EID, text)
        pipe.opts = opts & 0xFF  # C has 8 bits
        if pipe.opts & PIPEOPTS_IGNOREMINE:
            pipe.ignore(pipe.owner)
        else:
            pipe.heed(pipe.owner)
        text = f"Pipe opts set:id {pipe_id},owner {pipe.app_name}, opts=0x{pipe.opts:02x}"
        self.report(ev.SETPIPEOPTS_EID, ev.DEBUG, text)

    def get_pipe_opts(self, pipe_id: int) -> int:
        """Return the options of a pipe (CFE_SB_GetPipeOpts)."""
        pipe = self.find_pipe(pipe_id)
        if pipe is None:
            text = f"Pipe Opts Error:Bad Argument,PipeId {pipe_id},Requestor {self.caller_name()}"
            raise self._opts_error(ev.GETPIPEOPTS_ID_ERR_EID, text)
        self.report(ev.GETPIPEOPTS_EID, ev.DEBUG, f"Pipe opts get:id {pipe_id}, opts=0x{pipe.opts:02x}")
        return pipe.opts

    def get_pipe_name(self, pipe_id: int) -> str:
        """Return the name of a pipe (CFE_SB_GetPipeName)."""
        pipe = self.find_pipe(pipe_id)
        if pipe is None:
            raise CfeError(CFE_SB_BAD_ARGUMENT, self.report_nameless(pipe_id))
        return pipe.name

    def get_pipe_id_by_name(self, name: str) -> int:
        """Return the id of a named pipe (CFE_SB_GetPipeIdByName)."""
        for pipe in self.pipes:
            if pipe.name == name:
                self.report(ev.GETPIPEIDBYNAME_EID, ev.DEBUG, f"PipeIdByName name={name} id={pipe.pipe_id}")
                return pipe.pipe_id
        self.counters.get_pipe_id_by_name_error += 1
        text = f"Pipe ID By Name Error:Bad Argument,Requestor {self.caller_name()}"
        self.report(ev.GETPIPEIDBYNAME_NAME_ERR_EID, ev.ERROR, text)
        raise CfeError(CFE_SB_BAD_ARGUMENT, text)

    def pipe_id_to_index(self, pipe_id: int) -> int:
        """Return the slot number of a pipe, from 0 (CFE_SB_PipeId_ToIndex).

        Raises:
            CfeError: CFE_ES_ERR_RESOURCEID_NOT_VALID if it is not a pipe id; the pipe need not exist.
        """
        return to_index(pipe_id, SB_PIPEID_BASE, self.config.sb_max_pipes)

    def cleanup_app(self, app_id: int) -> None:
        """Delete every pipe of an application that ends, and release its buffers (CFE_SB_CleanUpApp)."""
        for pipe in list(self.pipes):
            if pipe.app_id == app_id:
                self.remove_pipe(pipe)
                self._report_deleted(pipe, "")  # its record is reserved by now, so NASA's code finds no name
        self.release_buffers_of(app_id)

    def _opts_error(self, event_id: int, text: str) -> CfeError:
        self.counters.pipe_opts_error += 1
        self.report(event_id, ev.ERROR, text)
        return CfeError(CFE_SB_BAD_ARGUMENT, text)
