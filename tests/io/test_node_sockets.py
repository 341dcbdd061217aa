"""Sockets of ROS nodes in a paced mission: with programs on this computer, and with cFE's applications."""

from __future__ import annotations

import socket
import textwrap
from pathlib import Path

from cfepy.io.host_network import TCP
from cfepy.mission import Mission
from cfepy.writing.console import Console
from tests.io.test_host_network import LAB, LOOPBACK, session

NODE = "CFE_APP, node.py, __main__, NODE, 100, 16384, 0x0, 0;\n!\n"


def write_node(folder: Path, source: str) -> None:
    (folder / "node.py").write_text(textwrap.dedent(source), encoding="utf-8")


def test_a_program_connects_with_a_node(tmp_path: Path) -> None:
    write_node(
        tmp_path,
        """
        import socket
        with socket.create_server(("", 7)) as server:
            connection, address = server.accept()
            print("from", address[0])
            connection.sendall(connection.recv(100).upper())
            connection.close()
        """,
    )
    with session(tmp_path, NODE) as run:
        run.run_while(lambda: run.bridge.host_port(7, TCP) is None)
        with socket.create_connection((LOOPBACK, run.bridge.host_port(7, TCP) or 0)) as client:
            client.sendall(b"hello")
            run.run_while(lambda: not run.console_has("[NODE] from 127.0.0.1"))
            run.run_while(lambda: not run.mission.ros.all_finished())
            assert client.recv(100) == b"HELLO"


def test_a_node_connects_with_a_program(tmp_path: Path) -> None:
    write_node(
        tmp_path,
        """
        import socket
        with socket.create_connection(("localhost", 8)) as client:
            client.sendall(b"hello")
            print("heard", client.recv(100))
        try:
            socket.create_connection(("localhost", 9))
        except ConnectionRefusedError as error:
            print(error)
        """,
    )
    with socket.create_server((LOOPBACK, 0)) as server, socket.create_server((LOOPBACK, 0)) as closed:
        ports = {8: server.getsockname()[1], 9: closed.getsockname()[1]}
        closed.close()
        server.setblocking(False)
        with session(tmp_path, NODE, ports=ports) as run:
            accepted: list[socket.socket] = []

            def waiting() -> bool:
                try:
                    accepted.append(server.accept()[0])
                except BlockingIOError:
                    return True
                return False

            run.run_while(waiting)
            with accepted[0] as connection:
                connection.setblocking(False)
                received = bytearray()

                def missing() -> bool:
                    try:
                        received.extend(connection.recv(100))
                    except BlockingIOError:
                        return True
                    return len(received) < 5

                run.run_while(missing)
                connection.sendall(b"back")
                run.run_while(lambda: not run.console_has("[NODE] heard b'back'"))
            run.run_while(lambda: not run.console_has("[Errno 111] Connection refused"))


def test_node_receives_the_answer_of_a_program(tmp_path: Path) -> None:
    write_node(
        tmp_path,
        """
        import socket
        client = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        client.sendto(b"question", ("127.0.0.1", 1235))
        print("heard", *client.recvfrom(100))
        client.close()
        """,
    )
    with session(tmp_path, NODE) as run:
        heard: list[bytes] = []

        def missing() -> bool:
            try:
                data, source = run.ground.recvfrom(100)
            except BlockingIOError:
                return True
            heard.append(data)
            run.ground.sendto(b"answer", source)
            return False

        run.run_while(missing)
        assert heard == [b"question"]
        run.run_while(lambda: not run.console_has("[NODE] heard b'answer' ('127.0.0.1', "))


def test_a_node_commands_the_computer_over_ci_lab(tmp_path: Path) -> None:
    write_node(
        tmp_path,
        """
        import socket, time
        time.sleep(1)
        client = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        client.sendto(bytes.fromhex("1884c000000100a2"), ("localhost", 1234))
        """,
    )
    with session(tmp_path, LAB.removesuffix("!\n") + NODE) as run:
        run.run_while(lambda: not run.console_has("CI: NOOP command"))


def test_sockets_are_refused_in_virtual_time(tmp_path: Path) -> None:
    write_node(tmp_path, "import socket\nsocket.socket()\n")
    (tmp_path / "startup.scr").write_text(NODE, encoding="utf-8")
    with Mission(str(tmp_path), console=Console(quiet=True)) as mission:
        mission.run_for(1)
        text = "socket.socket is not available on the simulated computer; run the mission with --realtime"
        assert any(text in line for line in mission.console.lines)
