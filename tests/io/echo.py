"""What tests with real sockets have in common: an application to talk to, and how long they have patience."""

from __future__ import annotations

from cfepy.rtos.units import NS_PER_S

LOOPBACK = "127.0.0.1"
FAST = 500.0  # virtual seconds for a real one
PATIENCE_NS = 3_000 * NS_PER_S
ECHO = '''
def Echo(cfe):
    """Sends back what comes to TCP port 7, in capitals, until the other side has no more."""
    server = cfe.os.socket_open(1, 2)
    address = cfe.os.socket_addr_init(1)
    cfe.os.socket_addr_set_port(address, 7)
    cfe.os.socket_bind(server, address)
    while True:
        connection, _ = cfe.os.socket_accept(server)
        while data := cfe.os.read(connection, 5000):
            at = 0
            while at < len(data):
                at += cfe.os.write(connection, data[at:].upper())
        cfe.os.close(connection)
'''
