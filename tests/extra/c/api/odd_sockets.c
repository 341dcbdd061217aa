/* Sockets in odd ways: after the peer's end, refused, not connected, shut down, in the wrong order. */
#include "api_test.h"

static osal_id_t server, client, peer, other;
static OS_SockAddr_t here, from;
static char text[200];

static void address(OS_SockAddr_t *at, uint16 port)
{
    OS_SocketAddrInit(at, OS_SocketDomain_INET);
    OS_SocketAddrFromString(at, "127.0.0.1");
    OS_SocketAddrSetPort(at, port);
}

static void get(osal_id_t from_whom, size_t size, int32 timeout)
{
    memset(text, 0, sizeof text);
    int32 got = OS_TimedRead(from_whom, text, size, timeout);
    SAY("read %d [%s]", (int)got, got > 0 ? text : "");
}

static void serve(uint16 port)
{
    address(&here, port);
    TELL(OS_SocketOpen(&server, OS_SocketDomain_INET, OS_SocketType_STREAM));
    TELL(OS_SocketBind(server, &here));
    TELL(OS_SocketOpen(&client, OS_SocketDomain_INET, OS_SocketType_STREAM));
    TELL(OS_SocketConnect(client, &here, 500));
    TELL(OS_SocketAccept(server, &peer, &from, 500));
}

static void end(void)
{
    OS_close(server);
    OS_close(client);
    OS_close(peer);
    OS_TaskDelay(50);
}

static void after_the_end(void)
{
    SAY("-- after the peer's end");
    serve(5001);
    TELL(OS_write(client, "abc", 3));
    TELL(OS_close(client));
    OS_TaskDelay(50);
    get(peer, 2, 100);
    get(peer, 5, 100);
    get(peer, 5, 100);
    TELL(OS_TimedWrite(peer, "x", 1, 100));
    OS_TaskDelay(50);
    get(peer, 5, 100);
    TELL(OS_TimedWrite(peer, "y", 1, 100));
    TELL(OS_TimedWrite(peer, "z", 1, 100));
    get(peer, 5, 100);
    TELL(OS_SocketShutdown(peer, OS_SocketShutdownMode_SHUT_WRITE));
    TELL(OS_close(client));
    end();
    SAY("-- unread bytes at the end");
    serve(5002);
    TELL(OS_write(peer, "unread", 6));
    TELL(OS_write(client, "before", 6));
    OS_TaskDelay(50);
    TELL(OS_close(client));
    OS_TaskDelay(50);
    get(peer, 10, 100);
    get(peer, 10, 100);
    TELL(OS_TimedWrite(peer, "x", 1, 100));
    TELL(OS_TimedWrite(peer, "x", 1, 100));
    end();
    SAY("-- shut down");
    serve(5003);
    TELL(OS_write(client, "last", 4));
    TELL(OS_SocketShutdown(client, OS_SocketShutdownMode_SHUT_WRITE));
    TELL(OS_TimedWrite(client, "x", 1, 100));
    get(peer, 10, 100);
    get(peer, 10, 100);
    TELL(OS_TimedWrite(peer, "back", 4, 100));
    get(client, 10, 100);
    TELL(OS_SocketShutdown(client, OS_SocketShutdownMode_SHUT_READ));
    get(client, 10, 100);
    TELL(OS_TimedWrite(peer, "more", 4, 100));
    OS_TaskDelay(50);
    get(client, 10, 100);
    get(client, 10, 100);
    TELL(OS_SocketShutdown(client, OS_SocketShutdownMode_SHUT_READWRITE));
    TELL(OS_SocketShutdown(client, OS_SocketShutdownMode_SHUT_READWRITE));
    TELL(OS_SocketConnect(client, &here, 100));
    end();
    SAY("-- never accepted");
    address(&here, 5004);
    TELL(OS_SocketOpen(&server, OS_SocketDomain_INET, OS_SocketType_STREAM));
    TELL(OS_SocketBind(server, &here));
    TELL(OS_SocketOpen(&client, OS_SocketDomain_INET, OS_SocketType_STREAM));
    TELL(OS_SocketConnect(client, &here, 500));
    TELL(OS_TimedWrite(client, "x", 1, 100));
    TELL(OS_close(server));
    OS_TaskDelay(50);
    get(client, 10, 100);
    get(client, 10, 100);
    TELL(OS_TimedWrite(client, "x", 1, 100));
    OS_close(client);
}

static void refused(void)
{
    SAY("-- refused");
    address(&here, 5010);
    TELL(OS_SocketOpen(&client, OS_SocketDomain_INET, OS_SocketType_STREAM));
    get(client, 5, 50);
    TELL(OS_TimedWrite(client, "x", 1, 50));
    get(client, 5, 0);
    TELL(OS_SocketConnect(client, &here, 500));
    get(client, 5, 50);
    TELL(OS_TimedWrite(client, "x", 1, 50));
    TELL(OS_SocketShutdown(client, OS_SocketShutdownMode_SHUT_READ));
    TELL(OS_SocketConnect(client, &here, 500));
    TELL(OS_SocketOpen(&server, OS_SocketDomain_INET, OS_SocketType_STREAM));
    TELL(OS_SocketBindAddress(server, &here));
    TELL(OS_SocketConnect(client, &here, 500));
    TELL(OS_SocketAccept(server, &peer, &from, 50));
    get(server, 5, 50);
    TELL(OS_TimedWrite(server, "x", 1, 50));
    TELL(OS_SocketListen(server));
    TELL(OS_SocketListen(server));
    get(server, 5, 50);
    TELL(OS_TimedWrite(server, "x", 1, 50));
    TELL(OS_SocketAccept(server, &peer, &from, 50));
    TELL(OS_SocketAccept(server, &peer, &from, 0));
    TELL(OS_SocketConnect(client, &here, 500));
    TELL(OS_SocketConnect(client, &here, 500));
    TELL(OS_SocketAccept(server, &peer, &from, 50));
    TELL(OS_SocketAccept(peer, &other, &from, 50));
    TELL(OS_SocketListen(peer));
    TELL(OS_SocketBind(peer, &here));
    TELL(OS_SocketBind(server, &here));
    TELL(OS_SocketConnect(server, &here, 50));
    TELL(OS_SocketSendTo(client, "x", 1, &here));
    TELL(OS_SocketRecvFrom(client, text, 5, &from, 50));
    TELL(OS_SocketOpen(&other, OS_SocketDomain_INET, OS_SocketType_STREAM));
    TELL(OS_SocketBind(other, &here));
    TELL(OS_SocketListen(other));
    TELL(OS_SocketAccept(other, &peer, &from, 0));
    TELL(OS_close(other));
    end();
}

static void as_a_file(void)
{
    OS_file_prop_t facts;
    SAY("-- as a file");
    serve(5020);
    TELL(OS_lseek(client, 0, OS_SEEK_SET));
    TELL(OS_lseek(client, 0, 7));
    TELL(OS_FileTruncate(client, 0));
    TELL(OS_FileAllocate(client, 0, 10));
    TELL(OS_FDGetInfo(server, &facts));
    SAY("named %d, valid %d", facts.Path[0] != 0, facts.IsValid);
    TELL(OS_CloseFileByName("127.0.0.1:5020"));
    TELL(OS_FileOpenCheck("127.0.0.1:5020"));
    TELL(OS_read(client, text, 0));
    TELL(OS_write(client, text, 0));
    TELL(OS_read(client, NULL, 1));
    end();
    TELL(OS_OpenCreate(&other, "/ram/a", OS_FILE_FLAG_CREATE, OS_READ_WRITE));
    TELL(OS_SocketBind(other, &here));
    TELL(OS_SocketConnect(other, &here, 0));
    TELL(OS_SocketListen(other));
    TELL(OS_SocketAccept(other, &peer, &from, 0));
    TELL(OS_SocketShutdown(other, OS_SocketShutdownMode_SHUT_READ));
    TELL(OS_SocketSendTo(other, "x", 1, &here));
    TELL(OS_SocketRecvFrom(other, text, 5, &from, 0));
    OS_close(other);
    OS_remove("/ram/a");
}

static void datagrams(void)
{
    SAY("-- datagrams");
    address(&here, 5030);
    TELL(OS_SocketOpen(&client, OS_SocketDomain_INET, OS_SocketType_DATAGRAM));
    TELL(OS_SocketRecvFrom(client, text, 5, &from, 0));
    get(client, 5, 50);
    TELL(OS_TimedWrite(client, "x", 1, 50));
    TELL(OS_SocketSendTo(client, "x", 1, &here));
    TELL(OS_SocketSendTo(client, "x", 0, &here));
    TELL(OS_SocketConnect(client, &here, 50));
    TELL(OS_TimedWrite(client, "x", 1, 50));
    OS_TaskDelay(20);
    get(client, 5, 50);
    get(client, 5, 50);
    TELL(OS_TimedWrite(client, "x", 1, 50));
    OS_TaskDelay(20);
    TELL(OS_TimedWrite(client, "y", 1, 50));
    TELL(OS_TimedWrite(client, "z", 1, 50));
    OS_TaskDelay(20);
    TELL(OS_SocketOpen(&server, OS_SocketDomain_INET, OS_SocketType_DATAGRAM));
    TELL(OS_SocketBind(server, &here));
    TELL(OS_SocketListen(server));
    TELL(OS_SocketAccept(server, &peer, &from, 0));
    TELL(OS_TimedWrite(client, "first", 5, 50));
    TELL(OS_TimedWrite(client, "first", 5, 50));
    TELL(OS_TimedWrite(client, "second", 6, 50));
    TELL(OS_SocketRecvFrom(server, text, 3, &from, 50));
    get(server, 20, 50);
    get(server, 20, 50);
    TELL(OS_SocketRecvFrom(server, text, 0, &from, 50));
    TELL(OS_SocketRecvFrom(server, text, 5, NULL, 0));
    TELL(OS_SocketShutdown(server, OS_SocketShutdownMode_SHUT_READ));
    TELL(OS_SocketShutdown(client, OS_SocketShutdownMode_SHUT_WRITE));
    TELL(OS_TimedWrite(client, "x", 1, 50));
    TELL(OS_SocketSendTo(client, "x", 1, &here));
    TELL(OS_SocketShutdown(client, OS_SocketShutdownMode_SHUT_READ));
    get(client, 5, 50);
    TELL(OS_close(client));
    TELL(OS_close(server));
    TELL(OS_SocketOpen(&client, OS_SocketDomain_INET, OS_SocketType_DATAGRAM));
    TELL(OS_SocketShutdown(client, OS_SocketShutdownMode_SHUT_WRITE));
    TELL(OS_SocketSendTo(client, "x", 1, &here));
    TELL(OS_close(client));
}

void APITEST_Main(void)
{
    after_the_end();
    refused();
    as_a_file();
    datagrams();
    CFE_ES_ExitApp(CFE_ES_RunStatus_APP_EXIT);
}
