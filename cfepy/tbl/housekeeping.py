"""What Table Services tell the ground of themselves: counters, the last validation, load, update and dump.

Stands for CFE_TBL_GetHkData and CFE_TBL_GetTblRegData. Builds values for the layouts in `cfepy.tbl.packets` and sends
nothing. Imports only cfepy.msg and its neighbours here.
"""

from __future__ import annotations

from typing import Any

from cfepy.msg import sys_time_fields
from cfepy.tbl.buffers import BufferMemory
from cfepy.tbl.dumps import Dumps
from cfepy.tbl.registry import Registry, Table, Validation

NO_LOAD = -1
_BYTE = 0xFF
_HALF = 0xFFFF


class Housekeeping:
    """Counters and last values.

    Attributes:
        last_updated: the table that changed last.
        last_file_loaded: the file of the ground's last load.
        last_table_loaded: the table of that load.
    """

    def __init__(self, registry: Registry, memory: BufferMemory, dumps: Dumps) -> None:
        self._registry = registry
        self._memory = memory
        self._dumps = dumps
        self._validations: list[Validation] = []
        self._last_validation = Validation("", 0, of_active=False)
        self._registry_request: Table | None = None
        self.last_updated: Table | None = None
        self.last_file_loaded = ""
        self.last_table_loaded = ""
        self.reset_counters()

    def reset_counters(self) -> None:
        """The RESET_COUNTERS command."""
        self._commands = self._errors = 0
        self._validated = self._successes = self._failures = self._requests = 0

    def count_command(self, accepted: bool) -> None:
        """Count a command done or refused."""
        self._commands += accepted
        self._errors += not accepted

    def add_validation(self, request: Validation, by_owner: bool = False) -> None:
        """Keep a validation request until its result was told; `by_owner`: an app has to do it."""
        self._validations.append(request)
        self._requests += by_owner

    def validations_under_way(self) -> int:
        """Requests whose results were not told yet."""
        return len(self._validations)

    def request_registry(self, table: Table) -> None:
        """Send a table's registry entry with the next housekeeping packet."""
        self._registry_request = table

    def take_registry_request(self) -> Table | None:
        """The table whose entry is wanted, if it still exists; asked for once."""
        table, self._registry_request = self._registry_request, None
        return table if table is not None and table.reg_id in self._registry.tables else None

    def _count_a_validation(self) -> None:
        """Take over one finished validation; the next one waits for the next packet, so that none is missed."""
        done = next((request for request in self._validations if request.performed), None)
        if done is None:
            return
        self._validations.remove(done)
        self._last_validation = done
        self._validated += 1
        self._successes += done.result == 0
        self._failures += done.result != 0

    def collect(self) -> dict[str, Any]:
        """The fields of packets.HOUSEKEEPING."""
        self._count_a_validation()
        last, table = self._last_validation, self.last_updated
        values: dict[str, Any] = {
            "CommandCounter": self._commands & _BYTE,
            "CommandErrorCounter": self._errors & _BYTE,
            "NumTables": len(self._registry.tables),
            "NumLoadPending": sum(table.loading is not None for table in self._registry.tables),
            "ValidationCounter": self._validated & _HALF,
            "LastValCrc": last.crc,
            "LastValStatus": last.result,
            "ActiveBuffer": last.of_active,
            "LastValTableName": last.table_name,
            "SuccessValCounter": self._successes & _BYTE,
            "FailedValCounter": self._failures & _BYTE,
            "NumValRequests": self._requests & _BYTE,
            "NumFreeSharedBufs": self._memory.free_shared,
            "MemPoolHandle": self._memory.pool_id,
            "LastFileLoaded": self.last_file_loaded,
            "LastFileDumped": self._dumps.last_file,
            "LastTableLoaded": self.last_table_loaded,
        }
        if table is not None:
            values |= {"LastUpdateTime": sys_time_fields(table.last_update), "LastUpdatedTable": table.name}
        return values

    def registry_packet(self, table: Table, owner_name: str) -> dict[str, Any]:
        """The fields of packets.REGISTRY_PACKET for one table."""
        inactive = table.inactive()
        return _common(table, owner_name) | {
            "ActiveBufferAddr": table.active.address if table.active else 0,
            "InactiveBufferAddr": inactive.address if inactive else 0,
            "ValidationFuncPtr": int(table.validator is not None),
            "Critical": table.critical,
        }

    def registry_record(self, table: Table, owner_name: str) -> dict[str, Any]:
        """The fields of packets.REGISTRY_RECORD for one table."""
        return _common(table, owner_name) | {
            "NumUsers": len(table.accesses),
            "LoadInProgress": table.loading.place if table.loading else NO_LOAD,
            "ValidationFunc": table.validator is not None,
            "CriticalTable": table.critical,
        }


def _common(table: Table, owner_name: str) -> dict[str, Any]:
    return {
        "Size": table.size,
        "Crc": table.active.crc if table.active else 0,
        "TimeOfLastUpdate": sys_time_fields(table.last_update),
        "FileTime": sys_time_fields(table.active.file_time if table.active else (0, 0)),
        "TableLoadedOnce": table.active is not None,
        "LoadPending": table.is_update_pending,
        "DumpOnly": table.dump_only,
        "DoubleBuffered": table.double_buffered,
        "Name": table.name,
        "LastFileLoaded": table.last_file,
        "OwnerAppName": owner_name,
    }
