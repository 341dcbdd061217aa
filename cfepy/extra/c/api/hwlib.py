"""uart_*, i2c_*, spi_*, gpio_* and can_*: the calls of NOS3's hwlib and of libsocketcan, on the mission's devices.

A mission that brings hwlib itself as a library uses that one, on device files (`device_files`). Without a device,
before it is initialized and after it is closed, the functions fail as on Linux with a descriptor that is not open.
"""

from __future__ import annotations

from struct import Struct
from typing import TYPE_CHECKING, NamedTuple

from cfepy.extra.c.api.device_files import TENTH_NS, awaited, i2c_bytes, i2c_messages
from cfepy.status import OS_ERR_FILE, OS_ERROR
from cfepy.units import NS_PER_S, NS_PER_US

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.devices import Device
    from cfepy.extra.c.runtime import CRuntime

FAILED = -1
SUCCESS = 0
UART_OPEN, SPI_OPEN, GPIO_OPEN, CAN_UP = 12, 21, 9, 8
"""Offsets of isOpen and isUp in uart_info_t, spi_info_t, gpio_info_t and can_info_t."""
UART_HANDLE, SPI_HANDLE, GPIO_HANDLE, SPI_MODE, I2C_IS_OPEN = 8, 8, 4, 20, 8
I2C_OPEN, I2C_CLOSED = 0, 1
SPI_ERR_FILE_OPEN, SPI_ERR_FILE_HANDLE, SPI_ERR_INVAL_MD, SPI_ERR_IOC_MSG, HIGHEST_MODE = -2, -4, -5, -12, 3
GPIO_READ_ERR = -4
CAN_SOCK_OPEN_ERR, CAN_WRITE_ERR, CAN_READ_TIMEOUT_ERR = -6, -9, -11
CAN_FRAME = Struct("<IB3x8s")
"""struct can_frame: identifier, length, data."""
CAN_BYTES = 8
CAN_STATE_ERROR_ACTIVE = 0


class Hwlib:
    """The functions of hwlib for one processor.

    Args:
        c: its C side.
    """

    def __init__(self, c: CRuntime) -> None:
        self._c = c
        self._buses: set[int] = set()  # numbers of the I2C buses that are open

    def _named(self, info: int, open_at: int | None = None) -> Device | None:
        """Return the device that the first member of a structure names.

        Args:
            info: address of the structure.
            open_at: offset of its member isOpen or isUp, without which there is no device; None while it is opened.
        """
        if open_at is not None and not self._c.memory.u8(info + open_at):
            return None
        address = self._c.memory.u64(info)
        return self._c.devices.find(self._c.memory.text(address)) if address else None

    def _put(self, address: int, value: int) -> None:
        self._c.memory.poke(address, bytes([value]))

    def _data(self, address: int, count: int) -> bytes:
        return bytes(self._c.memory.peek(address, count))

    # -- serial ports ------------------------------------------------------------------------------------------------

    def uart_init(self, info: int) -> int:
        is_there = self._named(info) is not None
        self._put(info + UART_OPEN, is_there)
        self._c.memory.put_u32(info + UART_HANDLE, 0 if is_there else FAILED)
        return SUCCESS if is_there else OS_ERR_FILE

    def uart_waiting(self, info: int) -> int:
        device = self._named(info, UART_OPEN)
        return 0 if device is None else device.waiting()

    def uart_flush(self, info: int) -> int:
        device = self._named(info, UART_OPEN)
        while device is not None and device.waiting():
            device.read(device.waiting())
        return SUCCESS

    def uart_read(self, info: int, buffer: int, count: int) -> int:
        device = self._named(info, UART_OPEN)
        if not buffer:
            return OS_ERR_FILE
        if device is None:
            return FAILED
        data = awaited(self._c, device, count, TENTH_NS)  # hwlib sets VTIME to 1
        self._c.memory.poke(buffer, data)
        return len(data)

    def uart_write(self, info: int, buffer: int, count: int) -> int:
        device = self._named(info, UART_OPEN)
        if device is None:
            return FAILED
        device.write(self._data(buffer, count))
        return count

    def uart_close(self, info: int) -> int:
        is_there = self._named(info, UART_OPEN) is not None
        self._put(info + UART_OPEN, 0)
        return SUCCESS if is_there else OS_ERR_FILE

    # -- I2C -----------------------------------------------------------------------------------------------------------

    def i2c_init(self, info: int) -> int:
        is_there = self._c.devices.has_bus(self._bus(info))
        self._put(info + I2C_IS_OPEN, I2C_OPEN if is_there else I2C_CLOSED)
        if is_there:
            self._buses.add(self._bus(info))
        return SUCCESS if is_there else OS_ERROR

    def i2c_transaction(self, info: int, address: int, sent: int, sent_count: int, received: int, count: int) -> int:
        bus = self._bus(info)
        device = self._c.devices.i2c(bus, address) if bus in self._buses else None
        if device is None:
            return OS_ERROR
        if sent_count:
            device.write(self._data(sent, sent_count))
        if count:
            self._c.memory.poke(received, i2c_bytes(device, count))
        return SUCCESS

    def i2c_several(self, info: int, argument: int) -> int:
        bus = self._bus(info)
        done = i2c_messages(self._c.memory, self._c.devices, bus, argument) if bus in self._buses else None
        return OS_ERROR if done is None else SUCCESS

    def i2c_close(self, info: int) -> int:
        self._put(info + I2C_IS_OPEN, I2C_CLOSED)
        self._buses.discard(self._bus(info))
        return SUCCESS

    def _bus(self, info: int) -> int:
        return self._c.memory.u32(info)

    # -- SPI -----------------------------------------------------------------------------------------------------------

    def spi_init(self, info: int) -> int:
        is_there = self._named(info) is not None
        self._c.memory.put_u32(info + SPI_HANDLE, 0 if is_there else FAILED)
        status = self.spi_set_mode(info) if is_there else SPI_ERR_FILE_OPEN
        self._put(info + SPI_OPEN, status == SUCCESS)
        return status

    def spi_set_mode(self, info: int) -> int:
        return SUCCESS if self._c.memory.u8(info + SPI_MODE) <= HIGHEST_MODE else SPI_ERR_INVAL_MD

    def spi_transaction(self, info: int, sent: int, received: int, count: int) -> int:
        device = self._named(info, SPI_OPEN)
        if device is None:
            return SPI_ERR_IOC_MSG
        answer = device.transfer(self._data(sent, count) if sent else bytes(count))
        if received:
            self._c.memory.poke(received, answer[:count].ljust(count, b"\0"))
        return SUCCESS

    def spi_close(self, info: int) -> int:
        is_there = self._named(info, SPI_OPEN) is not None
        self._put(info + SPI_OPEN, 0)
        return SUCCESS if is_there else SPI_ERR_FILE_HANDLE

    # -- pins ----------------------------------------------------------------------------------------------------------

    def _pin(self, info: int, is_open: bool = True) -> Device | None:
        if is_open and not self._c.memory.u8(info + GPIO_OPEN):
            return None
        return self._c.devices.find(f"gpio{self._c.memory.u32(info)}")

    def gpio_init(self, info: int) -> int:
        is_there = self._pin(info, is_open=False) is not None
        self._put(info + GPIO_OPEN, is_there)
        self._c.memory.put_u32(info + GPIO_HANDLE, 0 if is_there else FAILED)
        return SUCCESS if is_there else OS_ERR_FILE

    def gpio_read(self, info: int, value: int) -> int:
        device = self._pin(info)
        data = b"" if device is None else device.read(1)
        if not data:
            return GPIO_READ_ERR
        self._put(value, data[0])
        return SUCCESS

    def gpio_write(self, info: int, value: int) -> int:
        device = self._pin(info)
        if device is None:
            return OS_ERR_FILE  # the file of a pin that is not exported does not exist
        device.write(bytes([value]))
        return SUCCESS

    def gpio_close(self, info: int) -> int:
        self._put(info + GPIO_OPEN, 0)
        return SUCCESS

    # -- CAN -----------------------------------------------------------------------------------------------------------

    def can_init(self, info: int) -> int:
        is_there = self._named(info) is not None
        self._put(info + CAN_UP, is_there)
        return SUCCESS if is_there else CAN_SOCK_OPEN_ERR

    def can_write(self, info: int, identifier: int, buffer: int, count: int) -> int:
        device = self._named(info, CAN_UP)
        if device is None or count > CAN_BYTES:
            return CAN_WRITE_ERR
        device.write(CAN_FRAME.pack(identifier, count, self._data(buffer, count)))
        return SUCCESS

    def can_read(self, info: int, frame: int, wait_ns: int | None) -> int:
        found = self._frame(info, wait_ns)
        if found is None:
            return CAN_READ_TIMEOUT_ERR
        self._c.memory.poke(frame, found)
        return SUCCESS

    def can_exchange(self, info: int, call: CanCall) -> int:
        status = self.can_write(info, call.identifier, call.sent, call.sent_count)
        if status != SUCCESS:
            return status
        found = self._frame(info, call.wait_ns)
        if found is None:
            return CAN_READ_TIMEOUT_ERR
        _, count, data = CAN_FRAME.unpack(found)
        self._c.memory.poke(call.received, data[: min(count, call.room)])
        return SUCCESS

    def can_close(self, info: int) -> int:
        self._put(info + CAN_UP, 0)
        return SUCCESS

    def interface(self, name: int) -> int:
        """Return the result of a function of libsocketcan that starts, stops or sets a CAN interface."""
        return FAILED if self._c.devices.find(self._c.memory.text(name)) is None else SUCCESS

    def interface_state(self, name: int, state: int) -> int:
        found = self.interface(name)
        if found == SUCCESS:
            self._c.memory.put_u32(state, CAN_STATE_ERROR_ACTIVE)
        return found

    def _frame(self, info: int, wait_ns: int | None) -> bytes | None:
        device = self._named(info, CAN_UP)
        data = b"" if device is None else awaited(self._c, device, CAN_FRAME.size, wait_ns)
        return data if len(data) == CAN_FRAME.size else None


class CanCall(NamedTuple):
    """The arguments of can_master_transaction after the device."""

    identifier: int
    sent: int
    sent_count: int
    received: int
    room: int
    wait_ns: int


def _wait(seconds: int, microseconds: int) -> int:
    return seconds * NS_PER_S + microseconds * NS_PER_US


def declare(api: Declarations, c: CRuntime) -> None:
    hwlib = Hwlib(c)
    api.add("uart_init_port", "P", hwlib.uart_init, FAILED)
    api.add("uart_bytes_available", "$P", hwlib.uart_waiting, FAILED)
    api.add("uart_flush", "P", hwlib.uart_flush, FAILED)
    api.add("uart_read_port", "$PpI", hwlib.uart_read, FAILED)
    api.add("uart_write_port", "$PPI", hwlib.uart_write, FAILED)
    api.add("uart_close_port", "P", hwlib.uart_close, FAILED)
    api.add("i2c_master_init", "P", hwlib.i2c_init, FAILED)
    api.add("i2c_master_transaction", "$PBpBpB-", hwlib.i2c_transaction, FAILED)
    api.add("i2c_read_transaction", "$PBPB-", lambda i, a, rx, n: hwlib.i2c_transaction(i, a, 0, 0, rx, n), FAILED)
    api.add("i2c_write_transaction", "$PBPB-", lambda i, a, tx, n: hwlib.i2c_transaction(i, a, tx, n, 0, 0), FAILED)
    api.add("i2c_multiple_transaction", "$P-P-", hwlib.i2c_several, FAILED)
    api.add("i2c_master_close", "P", hwlib.i2c_close, FAILED)
    api.add("spi_init_dev", "P", hwlib.spi_init, FAILED)
    api.add("spi_set_mode", "P", hwlib.spi_set_mode, FAILED)
    api.add("spi_get_mode", "P", lambda info: SUCCESS, FAILED)
    api.add("spi_write", "$PPI", lambda info, tx, n: hwlib.spi_transaction(info, tx, 0, n), FAILED)
    api.add("spi_read", "$PPI", lambda info, rx, n: hwlib.spi_transaction(info, 0, rx, n), FAILED)
    api.add("spi_transaction", "$PppI---", hwlib.spi_transaction, FAILED)
    api.add("spi_select_chip", "P", lambda info: SUCCESS, FAILED)
    api.add("spi_unselect_chip", "P", lambda info: SUCCESS, FAILED)
    api.add("spi_close_device", "P", hwlib.spi_close, FAILED)
    api.add("gpio_init", "P", hwlib.gpio_init, FAILED)
    api.add("gpio_read", "$PP", hwlib.gpio_read, FAILED)
    api.add("gpio_write", "PB", hwlib.gpio_write, FAILED)
    api.add("gpio_close", "P", hwlib.gpio_close, FAILED)
    api.add("can_init_dev", "P", hwlib.can_init, FAILED)
    api.add("can_set_modes", "P", lambda info: SUCCESS, FAILED)
    api.add("can_write", "$PIPI", hwlib.can_write, FAILED)
    api.add("can_blocking_read", "$PP-", lambda info, frame: hwlib.can_read(info, frame, None), FAILED)
    api.add(
        "can_nonblocking_read", "$PP-II", lambda info, frame, s, us: hwlib.can_read(info, frame, _wait(s, us)), FAILED
    )
    api.add(
        "can_master_transaction",
        "$PIPIPIII",
        lambda info, i, tx, n, rx, m, s, us: hwlib.can_exchange(info, CanCall(i, tx, n, rx, m, _wait(s, us))),
        FAILED,
    )
    api.add("can_close_device", "P", hwlib.can_close, FAILED)
    for name in ("can_do_start", "can_do_stop", "can_do_restart"):
        api.add(name, "P", hwlib.interface, FAILED)
    for name in ("can_set_bitrate", "can_set_restart_ms"):
        api.add(name, "PI", lambda name, value: hwlib.interface(name), FAILED)
    for name in ("can_set_bittiming", "can_set_ctrlmode"):
        api.add(name, "PP", lambda name, value: hwlib.interface(name), FAILED)
    for name in ("can_get_bittiming", "can_get_ctrlmode", "can_get_restart_ms"):
        api.add(name, "PP", lambda name, value: FAILED, FAILED)  # as of an interface whose driver does not tell
    api.add("can_get_state", "PP", hwlib.interface_state, FAILED)
