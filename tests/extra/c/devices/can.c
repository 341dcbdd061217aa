/* An application with CAN buses by sockets. */
#include "cfe.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

static void Say(const char *What, long Value)
{
    CFE_EVS_SendEvent(1, CFE_EVS_EventType_INFORMATION, "%s %ld", What, Value);
}

static int Opened(const char *Name)
{
    struct sockaddr_can Address = {.can_family = AF_CAN};
    struct ifreq        Request = {0};
    int                 Fd      = socket(PF_CAN, SOCK_RAW, CAN_RAW);

    strncpy(Request.ifr_name, Name, IFNAMSIZ - 1);
    Say(Name, ioctl(Fd, SIOCGIFINDEX, &Request));
    Address.can_ifindex = Request.ifr_ifindex;
    Say("bind", bind(Fd, (struct sockaddr *)&Address, sizeof(Address)));
    return Fd;
}

void CAN_Main(void)
{
    struct can_frame  Frame = {.can_id = 0x123, .can_dlc = 3, .data = {1, 2, 3}}, Got = {0};
    struct can_filter Filter = {0x200, 0x700};
    struct pollfd     Entry;
    int               First, Second, Status;

    CFE_EVS_Register(NULL, 0, CFE_EVS_EventFilter_BINARY);
    Status = socket(PF_CAN, SOCK_RAW, CAN_RAW);
    Say("unbound", write(Status, &Frame, sizeof(Frame)));
    Say("ENXIO", errno == ENXIO);
    First  = Opened("can0");
    Second = Opened("can0");
    Status = Opened("can7");
    Say("ENODEV", errno == ENODEV);
    Say("index", if_nametoindex("can0"));
    Say("write", write(First, &Frame, sizeof(Frame)));
    Say("short", write(First, &Frame, 8));
    Say("read", read(First, &Got, sizeof(Got)));
    Say("id", Got.can_id);
    Say("second", read(Second, &Got, sizeof(Got)));
    Say("echo", recv(Second, &Got, sizeof(Got), 0));
    Say("data", Got.data[2]);
    fcntl(First, F_SETFL, O_NONBLOCK);
    Say("nonblocking", read(First, &Got, sizeof(Got)));
    Say("EAGAIN", errno == EAGAIN);
    Say("filter", setsockopt(First, SOL_CAN_RAW, CAN_RAW_FILTER, &Filter, sizeof(Filter)));
    write(Second, &Frame, sizeof(Frame));
    Say("filtered", read(First, &Got, sizeof(Got)));
    Frame.can_id = 0x2FF;
    write(Second, &Frame, sizeof(Frame));
    Entry = (struct pollfd){First, POLLIN, 0};
    Say("poll", poll(&Entry, 1, 100));
    Say("passed", read(First, &Got, sizeof(Got)));
    Say("id", Got.can_id);
    OS_TaskDelay(9000);
}
