"""ROS: the cFE application that keeps the parameters of all nodes in its tables, as roscore does in its memory.

It starts before the first node. A node that sets a parameter changes the tree and wakes this application. The
application has a higher priority and writes the changed rows into its tables in cFE's Table Services. The ground reads
the tables, and loads others.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from cfepy.es import APP_ERROR, StartParams
from cfepy.msg import BAD_CODE, BAD_LENGTH, CommandTable, get_msg_id
from cfepy.psp import RST_TYPE_PROCESSOR
from cfepy.status import CFE_TBL_INFO_RECOVERED_TBL, CFE_TBL_INFO_UPDATED, CFE_TBL_WARN_NOT_CRITICAL, CfeError
from cfepy.tbl import OPT_CRITICAL, OPT_DBL_BUFFER
from cfepy.tbl.packets import ABORT_LOAD
from rospy_shim.parameters import table
from rospy_shim.parameters.rows import ParameterRows, ParametersFull
from rospy_shim.parameters.tree import ParameterTree

if TYPE_CHECKING:
    from cfepy.app import Cfe
    from cfepy.tbl import TableHandle
    from cfepy.tbl.registry import Validator
    from rospy_shim.graph.compiled import CompiledNodes

FILE = "/cf/roscore.so"
SYMBOL = "ROS_AppMain"
PRIORITY = 50  # higher than nodes': a parameter is in the tables when the node's call returns
STACK_BYTES = 4096
PIPE_DEPTH = 16
WAKEUP_MS = 1000
START_POLL_MS = 10
INIT_INF_EID = 1
NOOP_INF_EID = 2
RESET_INF_EID = 3
COMMAND_ERR_EID = 4
TABLE_ERR_EID = 5
LOADED_INF_EID = 6
START_ERR_EID = 7


class ParameterImages:
    """All parameter tables of one application.

    Args:
        cfe: the handle of cFE's services.

    Attributes:
        survived: True if they existed before the processor was reset.
    """

    def __init__(self, cfe: Cfe) -> None:
        self._cfe = cfe
        self._handles: list[TableHandle] = []
        self._begun: list[str] = []  # tables whose load began to restore the contents after a reset, and is still open
        self._rows = 0
        self.survived = False

    def __len__(self) -> int:
        """Return the number of tables."""
        return len(self._handles)

    def register(self, notify_msg_id: int) -> None:
        """Register as many tables as the platform permits, and find their contents after a reset.

        Args:
            notify_msg_id: MsgId of the command that notifies of the ground's requests.

        Raises:
            CfeError: not even one table could be registered.
        """
        count, self._rows = table.extent(self._cfe.sb.config)
        for number in range(max(1, count)):
            handle = self._register(number)
            if handle is None:
                break
            self._handles.append(handle)
            self.survived = self.survived or handle.status == CFE_TBL_INFO_RECOVERED_TBL
            self._cfe.tbl.notify_by_message(handle, notify_msg_id, 0, number)
        for name in self._begun:
            self._cfe.sb.transmit_msg(ABORT_LOAD.packet(TableName=name))
            self._cfe.os.task_delay(START_POLL_MS)  # Table Services have a lower priority
        for handle in self._handles:
            if handle.status != CFE_TBL_INFO_RECOVERED_TBL:
                self._cfe.tbl.load(handle, bytes(self._rows * table.ROW_BYTES))

    def _register(self, number: int) -> TableHandle | None:
        """Register one more table. Returns None if there is no room; the first may be one that does not survive a
        reset.
        """
        tbl, name = self._cfe.tbl, table.table_name(number)
        was_kept = self._is_kept(f"{table.APP_NAME}.{name}")
        try:
            options = (
                OPT_CRITICAL | OPT_DBL_BUFFER
            )  # a single-buffered table could not be dumped before its second load
            handle = tbl.register(name, self._rows * table.ROW_BYTES, options, self._validator(name))
        except CfeError:
            if number:
                return None
            raise
        if handle.status == CFE_TBL_WARN_NOT_CRITICAL and number:
            tbl.unregister(handle)
            return None
        if was_kept and handle.status != CFE_TBL_INFO_RECOVERED_TBL:
            self._begun.append(f"{table.APP_NAME}.{name}")
        return handle

    def _is_kept(self, name: str) -> bool:
        """Return True if a table of this full name survived a reset in the CDS, loaded or not."""
        if self._cfe.es.reset.variables.reset_type != RST_TYPE_PROCESSOR:
            return False
        try:
            self._cfe.es.get_cds_block_id_by_name(name)
        except CfeError:
            return False
        return True

    def read(self) -> list[table.Row]:
        """Return the rows of all tables."""
        rows: list[table.Row] = []
        for handle in self._handles:
            image, _ = self._cfe.tbl.get_address(handle)
            rows += table.unpack(image)
            self._cfe.tbl.release_address(handle)
        return rows

    def write(self, changed: dict[int, None], rows: list[table.Row]) -> None:
        """Write changed rows into their tables, and clear `changed`."""
        by_table: dict[int, list[int]] = {}
        for index in changed:
            by_table.setdefault(index // self._rows, []).append(index)
        changed.clear()
        for number, indexes in by_table.items():
            handle = self._handles[number]
            image, _ = self._cfe.tbl.get_address(handle)
            for index in indexes:
                at = index % self._rows * table.ROW_BYTES
                image[at : at + table.ROW_BYTES] = table.pack(rows[index])
            self._cfe.tbl.release_address(handle)
            self._cfe.tbl.modified(handle)

    def manage(self) -> bool:
        """Handle the ground's requests. Returns True if the parameters have changed."""
        answers = [self._cfe.tbl.manage(handle) for handle in self._handles]
        return CFE_TBL_INFO_UPDATED in answers

    def _validator(self, name: str) -> Validator:
        def validate(image: memoryview) -> int:
            fault = table.fault(table.unpack(image))
            if fault is None:
                return 0
            self._cfe.evs.send_err(TABLE_ERR_EID, f"ROS: {name}, {fault}")
            return -1

        return validate


class ParameterApp:
    """The application ROS of one mission.

    Args:
        cfe: the handle of cFE's services.
        tree: the parameters.
        master: answers compiled nodes.
    """

    def __init__(self, cfe: Cfe, tree: ParameterTree, master: CompiledNodes | None = None) -> None:
        self._cfe = cfe
        self._tree = tree
        self._master = master
        self._is_starting = False
        self._has_run = False
        self._reset()

    def _reset(self) -> None:
        """Set the initial state of a start of the application."""
        self._images = ParameterImages(self._cfe)
        self._rows = ParameterRows([], {})
        self._is_awake = False
        self._accepted = self._rejected = 0
        self._commands = CommandTable((table.NOOP, self._noop), (table.RESET_COUNTERS, self._reset_counters))
        self._commands.handle(table.SEND_HK, self._send_hk)
        self._commands.handle(table.WAKEUP, lambda packet: None, any_length=True)

    # -- for the runtime ---------------------------------------------------------------------------------------------

    def ensure(self) -> None:
        """Start the application unless it runs. If it cannot start, a reset loses the parameters."""
        es = self._cfe.es
        if es.app_named(table.APP_NAME) is not None:
            return
        self._is_starting = True
        try:
            es.create_app(table.APP_NAME, StartParams(FILE, SYMBOL, STACK_BYTES, PRIORITY))
        except CfeError as error:
            self._is_starting = False
            es.write_to_sys_log(f"ROS: parameters do not outlive a reset, {table.APP_NAME} cannot start: {error.hex}")

    def wait(self) -> None:
        """Let the calling task wait until the parameters are ready."""
        while self._is_starting:
            self._cfe.os.task_delay(START_POLL_MS)

    # -- the application ---------------------------------------------------------------------------------------------

    def main(self) -> None:
        """Run the main function (ROS_AppMain)."""
        self._reset()
        try:
            self._start()
        except (CfeError, ParametersFull) as error:
            self._cfe.evs.send_err(START_ERR_EID, f"ROS: parameters do not outlive a reset: {_first_line(error)}")
            self._is_starting = False
            self._cfe.es.exit_app(APP_ERROR)  # does not return
        self._is_starting = False
        try:
            while self._cfe.es.run_loop():
                self._do(self._cfe.sb.receive_buffer(self._pipe, WAKEUP_MS))
        finally:
            self._tree.let_go()
        self._cfe.es.exit_app()

    def _start(self) -> None:
        cfe = self._cfe
        cfe.evs.register()
        self._pipe = cfe.sb.create_pipe(PIPE_DEPTH, "ROS_CMD_PIPE")
        for msg_id in (table.CMD_MID, table.SEND_HK_MID, table.WAKEUP_MID, table.MASTER_MID):
            cfe.sb.subscribe(msg_id, self._pipe)
        self._images.register(table.WAKEUP_MID)
        self._read(is_start=self._has_run or not self._images.survived)
        self._has_run = True
        self._write()
        kept = "found in the CDS" if self._images.survived else "new"
        text = f"ROS Initialized. {len(self._images)} tables ({kept}), {self._rows.parameters} parameters"
        cfe.evs.send_info(INIT_INF_EID, text)

    def _do(self, packet: bytes | None) -> None:
        """Handle a message, if there is one, and then the tables."""
        self._is_awake = False
        if packet is not None:
            self._handle(packet)
        self._write()
        if self._images.manage():
            self._read(is_start=False)
            self._write()
            text = f"ROS: parameters loaded, there are {self._rows.parameters}"
            self._cfe.evs.send_info(LOADED_INF_EID, text)

    def _read(self, is_start: bool) -> None:
        """Read the tables. At a start without a preceding reset the tree's parameters take precedence, otherwise the
        tables'.
        """
        problems: list[str] = []
        content = self._images.read()
        root, good = table.tree_of(content, problems)
        self._rows = rows = ParameterRows(content, good)
        if is_start:
            self._tree.keep_in(rows, self._wake, root)
        else:
            self._tree.restore(root, rows, self._wake)
        for problem in problems:
            self._cfe.evs.send_err(TABLE_ERR_EID, f"ROS: left out, {problem}")

    def _write(self) -> None:
        if self._rows.changed:
            self._images.write(self._rows.changed, self._rows.rows)

    def _wake(self) -> None:
        """Wake the application to write changed parameters."""
        if self._is_awake or not self._rows.changed:
            return
        self._is_awake = True
        try:
            self._cfe.sb.transmit_msg(table.WAKEUP.packet())
        except CfeError:
            self._is_awake = False  # it is written within a second

    # -- commands ----------------------------------------------------------------------------------------------------

    def _handle(self, packet: bytes) -> None:
        if self._master is not None and get_msg_id(packet) == table.MASTER_MID:
            for answer in self._master.answer(packet):
                self._cfe.sb.transmit_msg(answer)
            return
        done = self._commands.dispatch(packet)
        if done.outcome == BAD_CODE:
            self._rejected += 1
            text = f"ROS: invalid command code: ID = 0x{done.msg_id:04X}, CC = {done.fcn_code}"
            self._cfe.evs.send_err(COMMAND_ERR_EID, text)
        elif done.outcome == BAD_LENGTH:
            self._rejected += 1
            self._cfe.evs.send_err(COMMAND_ERR_EID, f"ROS: {done.length_text()}")

    def _noop(self, packet: bytes) -> None:
        self._accepted += 1
        self._cfe.evs.send_info(NOOP_INF_EID, "ROS: No-op command")

    def _reset_counters(self, packet: bytes) -> None:
        self._accepted = self._rejected = 0
        self._cfe.evs.send_info(RESET_INF_EID, "ROS: Reset counters command")

    def _send_hk(self, packet: bytes) -> None:
        free = self._rows.free
        values: dict[str, Any] = {
            "CommandCounter": self._accepted & 0xFF,
            "CommandErrorCounter": self._rejected & 0xFF,
            "Tables": len(self._images),
            "Parameters": self._rows.parameters,
            "RowsUsed": len(self._rows.rows) - free,
            "RowsFree": free,
        }
        self._cfe.sb.transmit_msg(table.HK_TLM.packet(**values))


def _first_line(error: Exception) -> str:
    return str(error).partition("\n")[0]
