"""OS_*: files, folders, disks, sockets and select, as C code sees them; status codes are NASA's."""

from __future__ import annotations

from pathlib import Path

from tests.extra.c.building import needs_compiler
from tests.extra.c.test_osal import results

pytestmark = needs_compiler


def test_files(tmp_path: Path) -> None:
    body = """
        Id id = 9;
        char text[20] = "";
        FileStat stat;
        FileInfo info;
        DID(OS_OpenCreate(&id, NULL, 0, 0));
        DID(id);
        DID(OS_OpenCreate(&id, NULL, 0, 7));
        DID(OS_OpenCreate(NULL, "/ram/x", 1, 2));
        DID(OS_OpenCreate(&id, "/ram/none", 0, 0));
        DID(OS_OpenCreate(&id, "/nowhere/x", 1, 2));
        DID(OS_OpenCreate(&id, "/ram/x", 3, 2));
        DID(OS_write(id, "hello", 5));
        DID(OS_write(id, NULL, 5));
        DID(OS_write(id, text, 0));
        DID(OS_TimedWrite(id, " you", 4, 10));
        DID(OS_lseek(id, -4, 2));
        DID(OS_read(id, text, sizeof text));
        SAY("%s", text);
        DID(OS_read(id, text, sizeof text));
        DID(OS_read(id, NULL, 1));
        DID(OS_read(id, text, 0));
        DID(OS_TimedRead(0, text, 1, 0));
        DID(OS_FileAllocate(id, 0, 20));
        DID(OS_FileTruncate(id, 12));
        DID(OS_stat("/ram/x", &stat));
        SAY("%zu bytes, mode %x", stat.size, stat.mode);
        DID(OS_stat(NULL, &stat));
        DID(stat.mode);
        DID(OS_stat("/ram/x", NULL));
        DID(OS_FDGetInfo(id, &info));
        SAY("%s %d", info.path, info.valid);
        DID(OS_FileOpenCheck("/ram/x"));
        DID(OS_CloseFileByName("/ram/x"));
        DID(OS_FileOpenCheck("/ram/x"));
        DID(OS_FDGetInfo(id, &info));
        SAY("[%s] %d", info.path, info.valid);
        DID(OS_close(id));
    """
    assert results(tmp_path, body) == [
        *("-2", "0", "-1", "-2", "-1", "-108", "0", "5", "-2", "-40", "4", "5", "4", " you", "0", "-2", "-40", "-16"),
        *("0", "0", "0", "12 bytes, mode 6", "-2", "0", "-2", "0", "/ram/x 1", "0", "0", "-1", "-16", "[] 0", "-16"),
    ]


def test_paths_and_folders(tmp_path: Path) -> None:
    body = """
        Id id = 9;
        char name[20];
        DID(OS_mkdir("/ram/logs", 2));
        DID(OS_OpenCreate(&id, "/ram/logs/a", 1, 1));
        OS_close(id);
        DID(OS_cp("/ram/logs/a", "/ram/logs/b"));
        DID(OS_mv("/ram/logs/a", "/ram/logs/c"));
        DID(OS_rename("/ram/logs", "/ram/old"));
        DID(OS_remove(NULL));
        DID(OS_chmod("/ram/old/b", 0));
        DID(OS_DirectoryOpen(&id, "/ram/none"));
        DID(id);
        DID(OS_DirectoryOpen(&id, "/ram/old"));
        while (OS_DirectoryRead(id, name) == 0)
            SAY("%s", name);
        DID(OS_DirectoryRewind(id));
        DID(OS_DirectoryRead(id, name));
        DID(OS_DirectoryRead(id, NULL));
        DID(OS_DirectoryClose(id));
        DID(OS_DirectoryRead(id, name));
        DID(OS_rmdir("/ram/old"));
    """
    assert results(tmp_path, body) == [
        *("0", "0", "0", "0", "0", "-2", "0", "-1", "0", "0", ".", "..", "b", "c", "0", "0", "-2", "0", "-16", "-1")
    ]


def test_disks(tmp_path: Path) -> None:
    body = """
        char memory[16], path[128];
        VolumeStat stat;
        FsInfo info;
        DID(OS_mkfs(NULL, "/ramdev1", "RAM1", 512, 8));
        DID(OS_mkfs(memory, "/ssr", "SSR1", 512, 8));
        DID(OS_mkfs(NULL, "/ssr", NULL, 512, 8));
        DID(OS_mount("/ssr", "/ssr"));
        DID(OS_FileSysStatVolume("/ssr/x", &stat));
        SAY("%zu %zu %zu", stat.block_size, stat.total_blocks, stat.blocks_free);
        DID(OS_FileSysStatVolume("/none", &stat));
        DID(OS_FileSysStatVolume("/ssr", NULL));
        DID(OS_chkfs("/ssr", false));
        DID(OS_FS_GetPhysDriveName(path, "/ssr"));
        DID(OS_TranslatePath("/ssr/x", path));
        SAY("%s", path);
        DID(OS_TranslatePath("/ssr/12345678901234567890", path));
        DID(OS_GetFsInfo(&info));
        SAY("%u %u", info.max_fds, info.max_volumes - info.free_volumes);
        DID(OS_unmount("/ssr"));
        DID(OS_rmfs("/ssr"));
        DID(OS_rmfs("/ssr"));
    """
    assert results(tmp_path, body) == [
        *("0", "0", "-2", "0", "0", "512 8 8", "-17", "-2", "-28", "0", "0", "SSR1:/ssr/x", "-104"),
        *("0", "50 4", "0", "0", "-17"),
    ]


ADDRESS = """
    static SockAddr at(int port)
    {
        SockAddr made;
        OS_SocketAddrInit(&made, 1);
        OS_SocketAddrFromString(&made, "127.0.0.1");
        OS_SocketAddrSetPort(&made, port);
        return made;
    }
"""


def test_addresses_of_the_network(tmp_path: Path) -> None:
    body = """
        SockAddr a = at(0x1234), six, none = {0};
        char text[50];
        uint16_t port;
        SAY("%zu bytes: %d %d, port %x %x, %d.%d.%d.%d", a.length, a.data[0], a.data[1], a.data[2], a.data[3],
            a.data[4], a.data[5], a.data[6], a.data[7]);
        DID(OS_SocketAddrInit(&six, 2));
        DID(OS_SocketAddrFromString(&six, "::1"));
        SAY("%zu bytes: %d, %d", six.length, six.data[0], six.data[23]);
        DID(OS_SocketAddrToString(text, sizeof text, &six));
        SAY("%s", text);
        DID(OS_SocketAddrToString(text, 4, &a));
        DID(OS_SocketAddrToString(text, 0, &a));
        DID(OS_SocketAddrFromString(&a, "nobody"));
        DID(OS_SocketAddrGetPort(&port, &a));
        SAY("%x", port);
        DID(OS_SocketAddrGetPort(&port, &none));
        DID(OS_SocketAddrSetPort(&none, 5));
        DID(OS_SocketAddrToString(text, sizeof text, &none));
        DID(OS_SocketAddrFromString(&none, "127.0.0.1"));
        DID(OS_SocketAddrInit(&none, 3));
        DID(OS_SocketAddrInit(NULL, 1));
    """
    assert results(tmp_path, body, before=ADDRESS) == [
        *("16 bytes: 2 0, port 12 34, 127.0.0.1", "0", "0", "28 bytes: 10, 1", "0", "::1"),
        *("-1", "-40", "-43", "0", "1234", "-34", "-34", "-34", "-34", "-28", "-2"),
    ]


def test_datagrams(tmp_path: Path) -> None:
    body = """
        Id a = 9, b;
        SockAddr here = at(5000), there = at(5001), from;
        char text[20] = "";
        int32_t option = 3;
        Named named;
        uint16_t port;
        DID(OS_SocketOpen(&a, 1, 7));
        DID(a);
        DID(OS_SocketOpen(&a, 1, 1));
        OS_SocketOpen(&b, 1, 1);
        DID(OS_SocketBind(a, &here));
        DID(OS_SocketBind(a, &here));
        DID(OS_SocketBind(b, &there));
        DID(OS_SocketRecvFrom(a, text, sizeof text, NULL, 0));
        DID(OS_SocketRecvFrom(a, text, sizeof text, NULL, 20));
        DID(OS_SocketSendTo(b, "hello", 6, &here));
        here.length = 28;
        DID(OS_SocketSendTo(b, "hello", 6, &here));
        DID(OS_SocketRecvFrom(a, text, sizeof text, &from, -1));
        OS_SocketAddrGetPort(&port, &from);
        SAY("%s from %d", text, port);
        DID(OS_SocketSetOption(a, 1, &option));
        option = 0;
        DID(OS_SocketGetOption(a, 1, &option));
        DID(option);
        DID(OS_SocketGetOption(a, 2, &option));
        DID(OS_SocketGetInfo(a, &named));
        SAY("%s", named.name);
    """
    assert results(tmp_path, body, before=ADDRESS) == [
        *("-28", "0", "0", "0", "-35", "0", "-4", "-4", "6", "-34", "6", "hello from 5001"),
        *("0", "0", "3", "-42", "0", "localhost:5000"),
    ]


def test_addresses_without_a_family_are_refused_as_by_osal_7_0_0(tmp_path: Path) -> None:
    """As OSAL 7.0.0 on Linux answers them: without a length they reach the kernel, which refuses them."""
    body = """
        for (int domain = 1; domain <= 2; domain++)
            for (int type = 1; type <= 2; type++)
                for (int length = 0; length <= 16; length += 16) {
                    SockAddr none = {length, {0}};
                    Id socket;
                    OS_SocketOpen(&socket, domain, type);
                    int sent = OS_SocketSendTo(socket, "x", 1, &none), connected = OS_SocketConnect(socket, &none, 0);
                    SAY("%d %d %d", sent, connected, OS_SocketBind(socket, &none));
                    OS_close(socket);
                }
    """
    datagram, stream = ["-1 -1 -34", "-34 -34 -34"], ["-36 -1 -34", "-36 -34 -34"]
    assert results(tmp_path, body) == 2 * (datagram + stream)


def test_connections_and_select(tmp_path: Path) -> None:
    before = (
        ADDRESS
        + """
    static void client(void)
    {
        Id id;
        SockAddr server = at(6000);
        OS_SocketOpen(&id, 1, 2);
        OS_SocketConnect(id, &server, 100);
        OS_write(id, "hi", 3);
        OS_TaskDelay(50);
        OS_SocketShutdown(id, 3);
        OS_close(id);
    }
    """
    )
    body = """
        Id server, id = 9, task;
        SockAddr here = at(6000), from;
        uint32_t flags = 5;
        FdSet set;
        char text[8] = "";
        OS_SocketOpen(&server, 1, 2);
        DID(OS_SocketBind(server, &here));
        DID(OS_SocketAccept(server, &id, &from, 10));
        DID(id);
        DID(OS_SelectSingle(server, &flags, 10));
        DID(flags);
        OS_TaskCreate(&task, "CLIENT", client, NULL, 8192, 80, 0);
        OS_SelectFdZero(&set);
        OS_SelectFdAdd(&set, server);
        DID(OS_SelectMultiple(&set, NULL, 100));
        DID(OS_SelectFdIsSet(&set, server));
        DID(OS_SocketAccept(server, &id, &from, -1));
        DID(OS_SelectFdClear(&set, server));
        OS_SelectFdAdd(&set, id);
        DID(OS_TimedRead(id, text, sizeof text, 100));
        SAY("%s", text);
        DID(OS_SelectMultiple(&set, NULL, 10));
        DID(OS_TimedRead(id, text, sizeof text, 10));
        DID(OS_read(id, text, sizeof text));
        DID(OS_SelectMultiple(NULL, NULL, 10));
        DID(OS_SelectFdAdd(&set, 1));
        DID(OS_SelectFdIsSet(NULL, id));
        DID(OS_SelectSingle(id, NULL, 10));
    """
    assert results(tmp_path, body, before=before) == [
        *("0", "-4", "0", "-4", "0", "0", "1", "0", "0", "3", "hi"),
        *("-4", "-4", "0", "-16", "-16", "0", "-2"),
    ]
