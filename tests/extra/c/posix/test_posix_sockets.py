"""Sockets of POSIX in compiled applications."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.mission import Mission
from cfepy.osal import Datagram, Mailbox, Place
from cfepy.pilot.mission_check import check_mission
from cfepy.writing.console import Console
from tests.extra.c.building import (
    compile_c,
    compile_cpp,
    console_of,
    digest_of,
    fly,
    fly_c,
    needs_compiler,
    needs_cpp,
    said,
    write_mission,
)
from tests.extra.c.posix.comparing import FORTIFIED, compare

pytestmark = needs_compiler


def test_program_prints_the_same_in_flight(tmp_path: Path) -> None:
    compare(tmp_path, "sockets")


@pytest.mark.slow
def test_fortified_program_prints_the_same_in_flight(tmp_path: Path) -> None:
    compare(tmp_path, "sockets", *FORTIFIED)


HEAD = r"""
    #include <arpa/inet.h>
    #include <errno.h>
    #include <netinet/in.h>
    #include <sys/select.h>
    #include <sys/socket.h>
    #include <sys/time.h>
    #include <unistd.h>
    #define CHILD(function) CFE_ES_CreateChildTask(&child, #function, function, NULL, 16384, 60, 0)
    static uint32_t child;
    static struct sockaddr_in at(int port)
    {
        struct sockaddr_in made = {.sin_family = AF_INET, .sin_port = htons(port)};
        made.sin_addr.s_addr = htonl(0x7f000001);
        return made;
    }
    static int ms(void)
    {
        static struct timeval start;
        struct timeval now;
        gettimeofday(&now, NULL);
        if (start.tv_sec == 0)
            start = now;
        return (now.tv_sec - start.tv_sec) * 1000 + (now.tv_usec - start.tv_usec) / 1000;
    }
    static int bound(int port)
    {
        struct sockaddr_in own = at(port);
        int made = socket(AF_INET, SOCK_DGRAM, 0);
        if (bind(made, (struct sockaddr *)&own, sizeof own) != 0)
            SAY("bind %d", errno);
        return made;
    }
    static void SEND(int from, int port, const char *text)
    {
        struct sockaddr_in to = at(port);
        sendto(from, text, strlen(text), 0, (struct sockaddr *)&to, sizeof to);
    }
"""


def test_blocking_call_waits_in_virtual_time_for_the_network_of_osal(tmp_path: Path) -> None:
    source = (
        HEAD
        + r"""
        void TEST_Main(void)
        {
            char data[16] = "";
            struct sockaddr_in peer;
            socklen_t size = sizeof peer;
            int number = bound(5005);
            ms();
            int count = recvfrom(number, data, sizeof data, 0, (struct sockaddr *)&peer, &size);
            SAY("%d %s from %d after %d", count, data, ntohs(peer.sin_port), ms());
            SEND(number, 5006, "answer");
            fd_set readers;
            FD_ZERO(&readers);
            FD_SET(number, &readers);
            struct timeval wait = {0, 250000};
            count = select(number + 1, &readers, NULL, NULL, &wait);
            SAY("%d %d after %d", count, FD_ISSET(number, &readers) != 0, ms() / 10 * 10);
            OS_TaskDelay(9000);
        }
    """
    )
    compile_c(tmp_path, "TEST", source, "-Wno-unused")
    with Mission(write_mission(tmp_path, "TEST"), console=Console(quiet=True)) as mission:
        peer = Mailbox()
        mission.network.datagrams.bind(peer, Place("127.0.0.1", 5006))
        mission.run_for(1)
        mission.network.send(Datagram(Place("127.0.0.1", 5006), Place("127.0.0.1", 5005), b"call"))
        mission.run_for(1)
        assert peer.take().data == b"answer"
        assert said(console_of(mission)) == ["4 call from 5006 after 450", "0 0 after 700"]


def test_tcp_connects_two_tasks(tmp_path: Path) -> None:
    source = (
        HEAD
        + r"""
        static void server(void)
        {
            struct sockaddr_in own = at(7000);
            static char data[40000];
            int number = socket(AF_INET, SOCK_STREAM, 0);
            bind(number, (struct sockaddr *)&own, sizeof own);
            listen(number, 1);
            int made = accept(number, NULL, NULL);
            SAY("accepted");
            OS_TaskDelay(50);
            long total = 0, count;
            while ((count = recv(made, data, sizeof data, 0)) > 0)
                total += count;
            SAY("received %ld, end %ld at %d", total, count, ms());
            send(made, "thanks", 6, 0);
            close(made);
        }
        void TEST_Main(void)
        {
            static char block[200000];
            char answer[8] = "";
            struct sockaddr_in to = at(7000);
            ms();
            CHILD(server);
            OS_TaskDelay(100);
            int number = socket(AF_INET, SOCK_STREAM, 0);
            SAY("connect %d", connect(number, (struct sockaddr *)&to, sizeof to));
            int count = send(number, block, sizeof block, 0);
            SAY("sent %d at %d", count, ms());
            shutdown(number, SHUT_WR);
            count = recv(number, answer, sizeof answer, 0);
            SAY("answer %d %s", count, answer);
            OS_TaskDelay(9000);
        }
    """
    )
    found = said(fly_c(tmp_path, source, flags=("-Wno-unused",)))
    assert sorted(found) == sorted(
        ["connect 0", "accepted", "sent 200000 at 150", "received 200000, end 0 at 150", "answer 6 thanks"]
    )


def test_socket_that_is_closed_during_a_call_stays_open_until_its_end(tmp_path: Path) -> None:
    source = (
        HEAD
        + r"""
        static int number;
        static void reader(void)
        {
            char data[16] = "";
            int count = recv(number, data, sizeof data, 0);
            SAY("received %d %s", count, data);
            count = recv(number, data, sizeof data, 0);
            SAY("then %d %d", count, errno == EBADF);
        }
        void TEST_Main(void)
        {
            number = bound(5005);
            CHILD(reader);
            OS_TaskDelay(100);
            SAY("close %d", close(number));
            int other = bound(5006);
            SAY("number again %d", other == number);
            close(other);
            other = bound(5007);
            close(dup(other));
            number = 99;
            SEND(other, 5005, "late");
            OS_TaskDelay(100);
            SAY("port is free %d", bound(5005) > 0);
            OS_TaskDelay(9000);
        }
    """
    )
    found = said(fly_c(tmp_path, source, flags=("-Wno-unused",)))
    assert found == ["close 0", "number again 1", "received 4 late", "then -1 1", "port is free 1"]


def test_send_on_an_ended_connection_ends_the_process(tmp_path: Path) -> None:
    source = (
        HEAD
        + r"""
        void TEST_Main(void)
        {
            int number = socket(AF_INET, SOCK_STREAM, 0);
            send(number, "x", 1, 0);
        }
    """
    )
    compile_c(tmp_path, "TEST", source, "-Wno-unused")
    mission = fly(write_mission(tmp_path, "TEST"))
    assert mission.kernel.abortion is not None
    assert "SIGPIPE: the connection of the socket is over" in mission.kernel.abortion.text


def test_other_families_are_named_in_the_console(tmp_path: Path) -> None:
    source = (
        HEAD
        + r"""
        void TEST_Main(void)
        {
            SAY("%d", socket(AF_UNIX, SOCK_STREAM, 0));
            SAY("%d", socket(AF_INET, SOCK_RAW, 1));
        }
    """
    )
    console = fly_c(tmp_path, source, flags=("-Wno-unused",))
    assert said(console) == ["-1", "-1"]
    assert "TEST: socket() of family 1 is not available; errno is EAFNOSUPPORT" in console
    assert "TEST: socket() of type 3 is not available; errno is EPERM" in console


def test_check_reports_no_function_of_sockets(tmp_path: Path) -> None:
    source = (
        HEAD
        + r"""
        int gethostname(char *, size_t);
        void TEST_Main(void)
        {
            char name[9];
            SEND(bound(5), 6, "x");
            gethostname(name, 9);
        }
    """
    )
    compile_c(tmp_path, "TEST", source, "-Wno-unused")
    [text] = [each.text for each in check_mission(write_mission(tmp_path, "TEST"))]
    assert text.startswith("TEST needs gethostname (TEST.c:")
    assert "the mission's network has one host, localhost" in text


@pytest.mark.slow
def test_run_with_sockets_is_the_same_each_time(tmp_path: Path) -> None:
    source = (
        HEAD
        + r"""
        static void reader(void)
        {
            char data[16];
            for (int number = bound(5005);;)
                SAY("%d", (int)recv(number, data, sizeof data, 0));
        }
        void TEST_Main(void)
        {
            CHILD(reader);
            for (int number = bound(5006), i = 0;; i++)
            {
                SEND(number, 5005, "message" + i % 5);
                OS_TaskDelay(7);
            }
        }
    """
    )
    compile_c(tmp_path, "TEST", source, "-Wno-unused")
    folder = write_mission(tmp_path, "TEST")
    assert len({digest_of(folder, tasks) for tasks in ("thread", "greenlet", "thread")}) == 1


@needs_cpp
def test_cpp_sees_the_same_functions(tmp_path: Path) -> None:
    source = r"""
        #include <poll.h>
        #include <sys/socket.h>
        extern "C" void TEST_Main(void)
        {
            pollfd entry{socket(AF_INET, SOCK_DGRAM, 0), POLLIN | POLLOUT, 0};
            CFE_ES_WriteToSysLog("> %d %d\n", poll(&entry, 1, 100), entry.revents);
        }
    """
    compile_cpp(tmp_path, "TEST", source)
    assert said(console_of(fly(write_mission(tmp_path, "TEST"), 1))) in (["1 4"], ["1 0"])
