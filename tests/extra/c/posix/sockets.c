/* Sockets of UDP and TCP with themselves, select, poll, and addresses. */
#include "trial.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

#define TRY(call)                                                             \
    do {                                                                      \
        errno = 0;                                                            \
        long answer = (long)(call);                                           \
        SAY("%s = %ld, %d", #call, answer, answer == -1 ? errno : 0);         \
    } while (0)

typedef struct sockaddr_in Address;
#define TO(address) (struct sockaddr *)&(address), sizeof(address)

static Address local(int port)
{
    Address made = {.sin_family = AF_INET, .sin_port = htons(port), .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    return made;
}

static Address name_of(int number)
{
    Address name = {0};
    socklen_t size = sizeof name;
    int status = getsockname(number, (struct sockaddr *)&name, &size);
    SAY("name %d size %d family %d host %s port %d", status, (int)size, name.sin_family, inet_ntoa(name.sin_addr), name.sin_port != 0);
    return name;
}

static void events(const char *what, int number)
{
    struct pollfd entry = {number, POLLIN | POLLOUT | POLLPRI | POLLRDNORM | POLLWRNORM, 77};
    int count = poll(&entry, 1, 0);
    fd_set readers, writers;
    FD_ZERO(&readers);
    FD_ZERO(&writers);
    FD_SET(number, &readers);
    FD_SET(number, &writers);
    struct timeval none = {0};
    int found = select(number + 1, &readers, &writers, NULL, &none);
    SAY("events %s: %d %x, %d %d%d", what, count, entry.revents, found, !!FD_ISSET(number, &readers), !!FD_ISSET(number, &writers));
}

static int option(int number, int level, int name)
{
    int value = -99;
    socklen_t size = sizeof value;
    int status = getsockopt(number, level, name, &value, &size);
    return status ? -errno : value;
}

static void datagrams(void)
{
    char data[64] = "";
    Address any = {.sin_family = AF_INET, .sin_addr.s_addr = INADDR_ANY}, peer = {0};
    socklen_t size = sizeof peer;
    int one = socket(AF_INET, SOCK_DGRAM, 0), other = socket(AF_INET, SOCK_DGRAM, IPPROTO_UDP), yes = 1;
    events("new", one);
    name_of(one);
    TRY(bind(one, TO(any)));
    Address to = name_of(one);
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    TRY(bind(one, TO(any)));
    TRY(bind(other, TO(to)));
    TRY(bind(other, (struct sockaddr *)&to, 3));
    TRY(recv(one, data, sizeof data, MSG_DONTWAIT));
    TRY(sendto(other, "first", 5, 0, TO(to)));
    TRY(sendto(other, "second one", 10, 0, TO(to)));
    TRY(sendto(other, "", 0, 0, TO(to)));
    name_of(other);
    int waiting = -1;
    TRY(ioctl(one, FIONREAD, &waiting));
    SAY("waiting %d", waiting);
    events("filled", one);
    TRY(recvfrom(one, data, sizeof data, MSG_PEEK, (struct sockaddr *)&peer, &size));
    TRY(recvfrom(one, data, sizeof data, 0, (struct sockaddr *)&peer, &size));
    SAY("got %s from %s size %d same %d", data, inet_ntoa(peer.sin_addr), (int)size, peer.sin_port != to.sin_port);
    TRY(recv(one, data, 3, MSG_TRUNC));
    SAY("cut %.3s", data);
    TRY(read(one, data, sizeof data));
    TRY(recv(one, data, sizeof data, MSG_DONTWAIT));
    TRY(fcntl(one, F_SETFL, fcntl(one, F_GETFL) | O_NONBLOCK));
    TRY(read(one, data, sizeof data));
    TRY(fcntl(one, F_SETFL, 0));
    struct timeval wait = {0, 20000};
    TRY(setsockopt(one, SOL_SOCKET, SO_RCVTIMEO, &wait, sizeof wait));
    TRY(recv(one, data, sizeof data, 0));
    TRY(send(other, "x", 1, 0));
    TRY(connect(one, TO(peer)));
    TRY(connect(other, TO(to)));
    name_of(other);
    TRY(send(one, "answer", 6, 0));
    TRY(write(other, "call", 4));
    TRY(read(other, data, sizeof data));
    TRY(read(one, data, sizeof data));
    TRY(shutdown(one, SHUT_RDWR));
    events("shut", one);
    TRY(close(one));
    TRY(send(other, "lost", 4, 0));
    events("refused", other);
    TRY(send(other, "lost", 4, 0));
    TRY(send(other, "lost", 4, 0));
    TRY(option(other, SOL_SOCKET, SO_ERROR));
    TRY(option(other, SOL_SOCKET, SO_ERROR));
    static char large[70000];
    TRY(sendto(other, large, sizeof large, 0, TO(to)));
    TRY(close(other));
    TRY(recv(other, data, 1, 0));
    int first = socket(AF_INET, SOCK_DGRAM, 0), second = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK, 0);
    setsockopt(first, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    bind(first, TO(any));
    Address shared = name_of(first);
    TRY(bind(second, TO(shared)));
    setsockopt(second, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    TRY(bind(second, TO(shared)));
    TRY(recv(second, data, 1, 0));
    TRY(option(second, SOL_SOCKET, SO_REUSEADDR));
    TRY(option(second, SOL_SOCKET, SO_TYPE));
    Address wide = local(9);
    wide.sin_addr.s_addr = INADDR_BROADCAST;
    TRY(sendto(first, "x", 1, 0, TO(wide)));
    int group = socket(AF_INET, SOCK_DGRAM, 0);
    wide.sin_port = 0;
    TRY(bind(group, TO(wide)));
    name_of(group);
    close(group);
    group = socket(AF_INET, SOCK_DGRAM, 0);
    wide.sin_addr.s_addr = htonl(0x0a010203);
    TRY(bind(group, TO(wide)));
    close(group);
    struct iovec pieces[2] = {{"mes", 3}, {"sage", 4}};
    shared.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    struct msghdr message = {&shared, sizeof shared, pieces, 2, NULL, 0, 0};
    TRY(sendmsg(first, &message, 0));
    struct iovec rooms[2] = {{data, 2}, {data + 10, 3}};
    struct msghdr received = {&peer, sizeof peer, rooms, 2, NULL, 0, 0};
    TRY(recvmsg(second, &received, 0));
    SAY("pieces %.2s %.3s flags %x size %d", data, data + 10, received.msg_flags, (int)received.msg_namelen);
    close(first);
    close(second);
}

static void streams(void)
{
    char data[64] = "";
    Address any = local(0), peer = {0};
    socklen_t size = sizeof peer;
    int server = socket(AF_INET, SOCK_STREAM, 0), client = socket(AF_INET, SOCK_STREAM, 0), no_delay = 1;
    events("new", client);
    TRY(recv(client, data, 1, 0));
    TRY(send(client, data, 1, MSG_NOSIGNAL));
    TRY(accept(server, NULL, NULL));
    TRY(bind(server, TO(any)));
    Address to = name_of(server);
    TRY(connect(client, TO(to)));
    TRY(listen(server, 3));
    events("listening", server);
    TRY(option(server, SOL_SOCKET, SO_ACCEPTCONN));
    TRY(connect(client, TO(to)));
    TRY(connect(client, TO(to)));
    events("pending", server);
    int made = accept(server, (struct sockaddr *)&peer, &size);
    SAY("accepted %d family %d size %d", made > client, peer.sin_family, (int)size);
    Address own = name_of(client);
    SAY("same port %d", own.sin_port == peer.sin_port);
    TRY(getpeername(client, (struct sockaddr *)&peer, &size));
    SAY("peer is server %d", peer.sin_port == to.sin_port);
    events("connected", client);
    TRY(setsockopt(client, IPPROTO_TCP, TCP_NODELAY, &no_delay, sizeof no_delay));
    TRY(send(client, "0123456789", 10, 0));
    events("readable", made);
    TRY(recv(made, data, 4, 0));
    TRY(recv(made, data, 4, MSG_PEEK));
    SAY("data %.4s", data);
    TRY(recv(made, data, 40, 0));
    TRY(recv(made, data, 40, MSG_DONTWAIT));
    size = sizeof peer;
    TRY(write(made, "answer", 6));
    TRY(recvfrom(client, data, 40, 0, (struct sockaddr *)&peer, &size));
    SAY("size %d", (int)size);
    TRY(shutdown(client, SHUT_WR));
    TRY(send(client, "x", 1, MSG_NOSIGNAL));
    TRY(recv(made, data, 40, 0));
    events("ended", made);
    TRY(write(made, "last", 4));
    TRY(close(made));
    TRY(recv(client, data, 40, 0));
    TRY(recv(client, data, 40, 0));
    TRY(close(client));
    client = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0);
    TRY(connect(client, TO(to)));
    events("connecting", client);
    TRY(connect(client, TO(to)));
    TRY(connect(client, TO(to)));
    TRY(option(client, SOL_SOCKET, SO_ERROR));
    made = accept4(server, NULL, NULL, SOCK_NONBLOCK);
    TRY(recv(made, data, 1, 0));
    TRY(send(client, "unread", 6, 0));
    TRY(close(made));
    TRY(recv(client, data, 1, 0));
    events("reset", client);
    TRY(send(client, "x", 1, MSG_NOSIGNAL));
    TRY(close(client));
    TRY(fcntl(server, F_SETFL, O_NONBLOCK));
    TRY(accept(server, NULL, NULL));
    TRY(close(server));
    client = socket(AF_INET, SOCK_STREAM, 0);
    TRY(connect(client, TO(to)));
    TRY(close(client));
    client = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0);
    TRY(connect(client, TO(to)));
    TRY(option(client, SOL_SOCKET, SO_ERROR));
    TRY(close(client));
}

static void waits(void)
{
    struct timeval wait = {0, 30000};
    TRY(select(0, NULL, NULL, NULL, &wait));
    SAY("rest %ld", (long)wait.tv_usec);
    TRY(poll(NULL, 0, 10));
    TRY(select(-1, NULL, NULL, NULL, &wait));
    wait.tv_sec = -1;
    TRY(select(0, NULL, NULL, NULL, &wait));
    struct pollfd closed[2] = {{500, POLLIN, 0}, {-1, POLLIN, 5}};
    TRY(poll(closed, 2, 1000));
    SAY("revents %x %x", closed[0].revents, closed[1].revents);
    fd_set set;
    FD_ZERO(&set);
    FD_SET(60, &set);
    wait.tv_sec = 0;
    TRY(select(61, &set, NULL, NULL, &wait));
    TRY(socket(AF_INET, 77, 0));
    TRY(socket(77, SOCK_STREAM, 0));
    TRY(socket(AF_INET, SOCK_STREAM, IPPROTO_UDP));
    int file = open("cf/s.bin", O_RDWR | O_CREAT, 0600);
    Address any = local(0);
    TRY(bind(file, TO(any)));
    TRY(send(file, "x", 1, 0));
    events("file", file);
    close(file);
}

static void names(void)
{
    static const char *const texts[] = {"127.0.0.1", "1.2.3", "0x7f.1", "010.0.0.1", "1.2.3.4.5", "256.1.1.1", "4294967295", "", "x",
                                        "1.2.3.4 rest", " 1.2.3.4", "1..2", "::1", "fe80::1:2", "0", "01.2.3.4"};
    for (size_t i = 0; i < COUNT(texts); i++) {
        struct in_addr four = {0};
        struct in6_addr six = {0};
        char text[64] = "";
        int status = inet_aton(texts[i], &four);
        SAY("%s: addr %x aton %d %x", quoted(texts[i]), inet_addr(texts[i]), status, four.s_addr);
        status = inet_pton(AF_INET, texts[i], &four);
        int other = inet_pton(AF_INET6, texts[i], &six);
        const char *shown = inet_ntop(AF_INET, &four, text, sizeof text);
        SAY("pton %d %d ntop %s", status, other, shown);
        SAY("six %s", inet_ntop(AF_INET6, &six, text, sizeof text));
    }
    char small[8];
    struct in_addr four = {0x0100007f};
    TRY(inet_ntop(AF_INET, &four, small, sizeof small) == NULL && errno == ENOSPC);
    TRY(inet_pton(99, "1", &four));
    struct hostent *host = gethostbyname("127.0.0.1");
    SAY("host %s %d %d %s", host->h_name, host->h_addrtype, host->h_length, inet_ntoa(*(struct in_addr *)host->h_addr));
    struct addrinfo hints = {.ai_family = AF_INET, .ai_socktype = SOCK_DGRAM}, *found = NULL;
    int status = getaddrinfo("127.0.0.1", "5000", &hints, &found);
    SAY("info %d %d %d %d", status, found->ai_family, found->ai_protocol, ntohs(((Address *)found->ai_addr)->sin_port));
    SAY("next %d", found->ai_next != NULL);
    freeaddrinfo(found);
    SAY("order %x %x", htons(0x1234), htonl(0x12345678));
}

static void trial(void)
{
    datagrams();
    streams();
    waits();
    names();
}
