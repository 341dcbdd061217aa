"""Sockets of nodes on a virtual network with a bridge: successful connections, waits, and failures."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from cfepy.osal.network import Network, Place


@pytest.fixture
def network() -> Network:
    """Return a network whose bridge finds no external peer."""
    made = Network()
    made.dial = lambda source, target: None
    return made


Run = Callable[..., Any]


def test_a_server_and_a_client(run: Run, network: Network) -> None:
    program = run(
        """
        import socket, threading, time
        def serve(server):
            connection, address = server.accept()
            with connection:
                while data := connection.recv(100):
                    connection.sendall(data.upper())
            print("over", address[0], time.monotonic() >= 1)
        with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as server:
            server.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            server.bind(("", 5000)); server.listen(1)
            print(server.getsockname(), server.getsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR))
            threading.Thread(target=serve, args=(server,)).start()
            with socket.create_connection(("localhost", 5000), timeout=2) as client:
                client.sendall(b"hello"); print(client.recv(3), client.recv(100), client.getpeername())
                time.sleep(1)
                client.shutdown(socket.SHUT_WR); print(client.recv(1))
        print(server, client.fileno())
        """,
        network=network,
    )
    assert program.lines == [
        "('0.0.0.0', 5000) 1",
        "b'HEL' b'LO' ('127.0.0.1', 5000)",
        "over 127.0.0.1 True",
        "b''",
        "<socket.socket [closed] fd=-1, family=2, type=1, proto=0> -1",
    ]
    assert not network.streams.bound


def test_datagrams(run: Run, network: Network) -> None:
    program = run(
        """
        import socket
        one, two = (socket.socket(type=socket.SOCK_DGRAM) for _ in range(2))
        one.bind(("127.0.0.1", 6000)); two.connect(("127.0.0.1", 6000))
        print(two.send(b"abc"), two.sendto(b"defg", ("localhost", 6000)))
        print(one.recv(2, socket.MSG_PEEK), one.recvfrom(2)[0])
        buffer = bytearray(8)
        size, source = one.recvfrom_into(buffer)
        print(size, bytes(buffer[:size]), source == two.getsockname())
        one.sendto(b"back", source); print(two.recv(10))
        one.setblocking(False)
        try:
            one.recv(1)
        except BlockingIOError as error:
            print(error)
        one.settimeout(0.5)
        try:
            one.recv(1)
        except socket.timeout as error:
            print(repr(error), one.gettimeout(), one.getblocking())
        """,
        network=network,
    )
    assert program.lines == [
        "3 4",
        "b'ab' b'ab'",
        "4 b'defg' True",
        "b'back'",
        "[Errno 11] Resource temporarily unavailable",
        "TimeoutError('timed out') 0.5 True",
    ]


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ("s.connect(('localhost', 9))", "ConnectionRefusedError: [Errno 111] Connection refused"),
        ("s.connect(('10.1.2.3', 9))", "OSError: [Errno 101] Network is unreachable"),
        ("s.connect(('nowhere.example', 9))", "socket.gaierror: [Errno -2] Name or service not known"),
        ("s.connect(('localhost', 70000))", "OverflowError: connect(): port must be 0-65535."),
        ("s.connect('localhost')", "TypeError: connect(): AF_INET address must be tuple, not str"),
        ("s.recv(1)", "OSError: [Errno 107] Transport endpoint is not connected"),
        ("s.getpeername()", "OSError: [Errno 107] Transport endpoint is not connected"),
        ("s.accept()", "OSError: [Errno 22] Invalid argument"),
        ("s.bind(('10.1.2.3', 9))", "OSError: [Errno 99] Cannot assign requested address"),
        ("s.bind(('', 9)); socket.socket().bind(('', 9))", "OSError: [Errno 98] Address already in use"),
        ("s.close(); s.send(b'')", "OSError: [Errno 9] Bad file descriptor"),
        ("socket.socket(socket.AF_UNIX)", "OSError: [Errno 97] Address family not supported by protocol"),
        ("d.send(b'')", "OSError: [Errno 89] Destination address required"),
        ("d.sendto(bytes(70000), ('', 9))", "OSError: [Errno 90] Message too long"),
        ("a, b = socket.socketpair(); b.close(); a.send(b'x')", "BrokenPipeError: [Errno 32] Broken pipe"),
    ],
)
def test_errors(run: Run, network: Network, body: str, said: str) -> None:
    begin = "import socket; s = socket.socket(); d = socket.socket(type=socket.SOCK_DGRAM)\n"
    assert run(begin + body, network=network).lines[-1] == said


def test_connect_ex_and_a_closed_server(run: Run, network: Network) -> None:
    program = run(
        """
        import errno, socket, threading, time
        server = socket.create_server(("", 7000))
        client = socket.socket()
        print(client.connect_ex(("localhost", 7000)), client.connect_ex(("localhost", 7000)) == errno.EISCONN)
        print(socket.socket().connect_ex(("localhost", 7001)) == errno.ECONNREFUSED)
        def waits():
            try:
                server.accept()
            except OSError as error:
                print("accept:", error)
        client.close(); server.accept()[0].close()
        threading.Thread(target=waits).start(); time.sleep(1); server.close()
        """,
        network=network,
    )
    assert program.lines == ["0 True", "True", "accept: [Errno 9] Bad file descriptor"]


def test_back_pressure_and_makefile(run: Run, network: Network) -> None:
    program = run(
        """
        import socket, threading, time
        near, far = socket.socketpair()
        def read():
            time.sleep(1)
            with far.makefile("rb") as file:
                print(len(file.readline()), file.read(3), time.monotonic() >= 1)
        thread = threading.Thread(target=read); thread.start()
        with near.makefile("w") as file:
            file.write("x" * 200_000 + "\\nend")
        print(time.monotonic() >= 1)
        near.close(); thread.join()
        """
    )
    assert sorted(program.lines) == ["200001 b'end' True", "True"]


def test_select_poll_and_selectors(run: Run, network: Network) -> None:
    program = run(
        """
        import select, selectors, socket, sys, threading, time
        near, far = socket.socketpair()
        print(select.select([near, sys.stdin], [near], [near], 0)[1] == [near], select.select([near], [], [], 0.25))
        threading.Timer(1, far.send, (b"x",)).start()
        start = time.monotonic()
        print(select.select([far, near], [], [])[0] == [near], round(time.monotonic() - start, 3))
        poll = select.poll(); poll.register(near, select.POLLIN); poll.register(far, select.POLLOUT)
        print(poll.poll(1000) == [(near.fileno(), select.POLLIN), (far.fileno(), select.POLLOUT)])
        poll.unregister(far); near.recv(1); print(poll.poll(100)); far.close(); print(poll.poll()[0][1] & select.POLLIN)
        with selectors.DefaultSelector() as chosen:
            chosen.register(near, selectors.EVENT_READ, "data")
            print([(key.data, mask) for key, mask in chosen.select()])
        fd = near.fileno(); near.close()
        for closed in (near, fd):
            try:
                select.select([closed], [], [])
            except (OSError, ValueError) as error:
                print(repr(error))
        """
    )
    assert program.lines == [
        "True ([], [], [])",
        "True 1.0",
        "True",
        "[]",
        "1",
        "[('data', 1)]",
        "ValueError('file descriptor cannot be a negative integer (-1)')",
        "OSError(9, 'Bad file descriptor')",
    ]


def test_servers_of_the_standard_library(run: Run, network: Network) -> None:
    program = run(
        """
        import http.server, socketserver, threading, urllib.request
        class Upper(socketserver.StreamRequestHandler):
            def handle(self):
                self.wfile.write(self.rfile.readline().upper())
        class Page(http.server.BaseHTTPRequestHandler):
            def do_GET(self):
                self.send_response(200); self.end_headers(); self.wfile.write(self.path.encode())
            def log_message(self, *args): pass
        class Text(socketserver.BaseRequestHandler):
            def handle(self):
                data, sock = self.request
                sock.sendto(data[::-1], self.client_address)
        lines = socketserver.ThreadingTCPServer(("", 8000), Upper)
        web = http.server.ThreadingHTTPServer(("", 8080), Page)
        back = socketserver.UDPServer(("", 8001), Text)
        for server in (lines, web, back):
            threading.Thread(target=server.serve_forever, daemon=True).start()
        import socket
        with socket.create_connection(("localhost", 8000)) as client:
            client.sendall(b"hello\\n"); print(client.makefile().read())
        print(urllib.request.urlopen("http://localhost:8080/status").read())
        client = socket.socket(type=socket.SOCK_DGRAM); client.sendto(b"abc", ("localhost", 8001))
        print(client.recv(9))
        for server in (lines, web, back):
            server.shutdown(); server.server_close()
        """,
        network=network,
    )
    assert program.lines == ["HELLO", "", "b'/status'", "b'cba'"]


def test_two_nodes_connect_and_an_ended_node_leaves_nothing(start: Run, network: Network) -> None:
    server = start(
        """
        import socket, time
        listening = socket.create_server(("", 9000))
        connection, _ = listening.accept()
        print(connection.recv(9)); raise SystemExit
        """,
        name="server",
        network=network,
    )
    client = start(
        """
        import socket
        connection = socket.create_connection(("127.0.0.1", 9000))
        connection.send(b"hi"); print(connection.recv(9))
        """,
        name="client",
        network=network,
    )
    server.kernel.run()
    assert (server.lines, client.lines) == (["b'hi'"], ["b''"])
    assert network.streams.find(Place("127.0.0.1", 9000)) is None


def test_names(run: Run) -> None:
    program = run("""
        import socket
        print(socket.gethostname(), socket.gethostbyname("localhost"), socket.gethostbyname(socket.gethostname()))
        print(socket.getaddrinfo("localhost", 80, type=socket.SOCK_STREAM)[0][3:], socket.getfqdn())
        print(socket.inet_aton("1.2.3.4"), socket.AF_INET, socket.SOCK_DGRAM)
    """)
    assert program.lines == [
        "cfepy 127.0.0.1 127.0.0.1",
        "('', ('127.0.0.1', 80)) cfepy",
        "b'\\x01\\x02\\x03\\x04' 2 2",
    ]


@pytest.mark.parametrize("body", ["import socket\nsocket.socket()", "import subprocess\nsubprocess.run(['ls'])"])
def test_refusal_names_the_node_and_the_line(run: Run, body: str) -> None:
    program = run(body, name="driver")
    assert program.lines[-1].endswith(f"(node driver, {program.universe.script}:2)")
    assert "is not available on the simulated computer; " in program.lines[-1]


def test_asyncio_streams_and_datagrams(run: Run, network: Network) -> None:
    program = run(
        """
        import asyncio
        async def serve(reader, writer):
            line = await reader.readline()
            await asyncio.sleep(1)
            writer.write(line.upper()); await writer.drain(); writer.close()
        class Datagrams(asyncio.DatagramProtocol):
            def __init__(self): self.got = asyncio.get_running_loop().create_future()
            def datagram_received(self, data, address): self.got.set_result(data)
        async def main():
            loop = asyncio.get_running_loop()
            async with await asyncio.start_server(serve, "127.0.0.1", 5555):
                reader, writer = await asyncio.open_connection("localhost", 5555)
                writer.write(b"hello\\n")
                print(await reader.read(), round(loop.time(), 2)); writer.close()
            _, end = await loop.create_datagram_endpoint(Datagrams, local_addr=("127.0.0.1", 5556))
            sender, _ = await loop.create_datagram_endpoint(Datagrams, remote_addr=("127.0.0.1", 5556))
            sender.sendto(b"datagram"); print(await end.got)
            try:
                await asyncio.open_connection("localhost", 5557)
            except ConnectionRefusedError as error:
                print("refused")
        asyncio.run(main())
        """,
        network=network,
    )
    assert program.lines == ["b'HELLO\\n' 1.0", "b'datagram'", "refused"]
