/*
** LINK, the way to the ground that stays when CI_LAB, TO_LAB or SCH_LAB end: datagrams at its port go to the bus, what
** is on the bus goes to the ground. It also calls the CDS for the ground, and passes datagrams on to CI_LAB.
** dev/twin/link_app.py is its twin in Python; dev/twin/lives_flight.py compiles this file and talks to it.
*/
#include "cfe.h"
#include <arpa/inet.h>
#include <netinet/in.h>
#include <string.h>
#include <sys/socket.h>

#define UP_PORT 5200
#define DOWN_PORT 5201
#define CI_PORT 1234
#define DEPTH 50
#define PERIOD_MS 20
#define SLOTS 4
#define SHOWN 200
#define REQUEST_MID 0x18E5
#define REPLY_MID 0x08E5
#ifndef MORE_WATCHED
#define MORE_WATCHED
#endif

static const uint16 Watched[] = {MORE_WATCHED 0x800, 0x801, 0x803, 0x804, 0x805, 0x806, 0x808, 0x809, 0x80A, 0x80B, 0x80C,
                                 0x80D, 0x80E, 0x810, 0x880, 0x881, 0x883, 0x884, REPLY_MID};

static int                Socket;
static CFE_ES_CDSHandle_t Blocks[SLOTS];
static bool               IsNew[SLOTS]; /* what is in a new block that was never written is chance */

static void SendTo(int port, const void *data, size_t size)
{
    struct sockaddr_in target;

    memset(&target, 0, sizeof(target));
    target.sin_family      = AF_INET;
    target.sin_port        = htons(port);
    target.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    sendto(Socket, data, size, 0, (struct sockaddr *)&target, sizeof(target));
}

static void Reply(int32 status, const uint8 *data, size_t size)
{
    static struct
    {
        CFE_MSG_TelemetryHeader_t header;
        int32                     status;
        uint8                     data[SHOWN];
    } reply;

    CFE_MSG_Init(CFE_MSG_PTR(reply.header), CFE_SB_ValueToMsgId(REPLY_MID), sizeof(reply) - sizeof(reply.data) + size);
    reply.status = status;
    memcpy(reply.data, data, size);
    CFE_SB_TransmitMsg(CFE_MSG_PTR(reply.header), true);
}

/* behind the header: a letter, the slot of the block, its size, the byte to fill it with; then its name */
static void Answer(const uint8 *request)
{
    static uint8 data[65536];
    uint16       size;
    int          slot   = request[9] % SLOTS;
    int32        status = -1;
    const char * name   = (const char *)request + 13;

    memcpy(&size, request + 10, sizeof(size));
    memset(data, request[12], sizeof(data));
    switch (request[8])
    {
        case 'R':
            status      = CFE_ES_RegisterCDS(&Blocks[slot], size, name);
            IsNew[slot] = status == CFE_SUCCESS;
            if (status < 0)
            {
                Blocks[slot] = CFE_ES_CDS_BAD_HANDLE;
            }
            Reply(status, data, 0);
            break;
        case 'C':
            IsNew[slot] = false;
            Reply(CFE_ES_CopyToCDS(Blocks[slot], data), data, 0);
            break;
        default:
            memset(data, 0, sizeof(data));
            if (!IsNew[slot])
            {
                status = CFE_ES_RestoreFromCDS(data, Blocks[slot]);
            }
            Reply(status, data, status == CFE_SUCCESS ? SHOWN : 0);
            break;
    }
}

static void Take(uint8 *data, size_t size)
{
    CFE_SB_Buffer_t *buffer;

    if (data[0] == REQUEST_MID >> 8 && data[1] == (REQUEST_MID & 0xFF))
    {
        if (data[8] == 'U')
        {
            SendTo(CI_PORT, data + 9, size - 9);
        }
        else
        {
            Answer(data);
        }
        return;
    }
    buffer = CFE_SB_AllocateMessageBuffer(size + 1); /* some applications read a text to its NUL, behind the end */
    memcpy(buffer, data, size);
    ((uint8 *)buffer)[size] = 0;
    if (CFE_SB_TransmitBuffer(buffer, false) != CFE_SUCCESS)
    {
        CFE_SB_ReleaseMessageBuffer(buffer);
    }
}

void LINK_Main(void)
{
    uint32             run = CFE_ES_RunStatus_APP_RUN;
    struct sockaddr_in here;
    CFE_SB_PipeId_t    pipe;
    CFE_SB_Buffer_t *  buffer;
    CFE_MSG_Size_t     size;
    uint8              data[2048];
    ssize_t            length;
    size_t             at;
    osal_id_t          counted;

    CFE_EVS_Register(NULL, 0, CFE_EVS_EventFilter_BINARY);
    CFE_SB_CreatePipe(&pipe, DEPTH, "LINK_PIPE");
    for (at = 0; at < sizeof(Watched) / sizeof(Watched[0]); ++at)
    {
        CFE_SB_SubscribeEx(CFE_SB_ValueToMsgId(Watched[at]), pipe, CFE_SB_DEFAULT_QOS, DEPTH);
    }
    OS_SocketOpen(&counted, OS_SocketDomain_INET, OS_SocketType_DATAGRAM); /* its twin's socket is one of OSAL */
    Socket = socket(AF_INET, SOCK_DGRAM, 0);
    memset(&here, 0, sizeof(here));
    here.sin_family      = AF_INET;
    here.sin_port        = htons(UP_PORT);
    here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    bind(Socket, (struct sockaddr *)&here, sizeof(here));
    while (CFE_ES_RunLoop(&run))
    {
        OS_TaskDelay(PERIOD_MS);
        while ((length = recv(Socket, data, sizeof(data) - 1, MSG_DONTWAIT)) > 0)
        {
            data[length] = 0;
            Take(data, length);
        }
        while (CFE_SB_ReceiveBuffer(&buffer, pipe, CFE_SB_POLL) == CFE_SUCCESS)
        {
            CFE_MSG_GetSize(&buffer->Msg, &size);
            SendTo(DOWN_PORT, buffer, size);
        }
    }
    CFE_ES_ExitApp(run);
}
