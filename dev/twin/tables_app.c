/*
** Three applications in one object, for flights of tables beside NASA's cFE: TTT listens to Event and Table Services,
** TTA and TTB call Table Services. Each does what datagrams at a port of its own ask for, and answers with the result.
** dev/twin/tables_flight.py has their twins in Python; tables_real.py compiles this file and talks to it.
*/
#include "cfe.h"
#include "cfe_tbl_msg.h"
#include "cfe_tbl_msgids.h"
#include "cfe_tbl_eventids.h"
#include "cfe_tbl_fcncodes.h"
#include "cfe_evs_msg.h"
#include "cfe_evs_msgids.h"
#include "cfe_evs_module_all.h"
#include <sys/time.h>
#include <sys/socket.h>
#include <netinet/in.h>
#include <arpa/inet.h>
#include <string.h>
#include <unistd.h>

#define SLOTS 16
#define BARRIER_CC 77

typedef struct
{
    char   op;
    uint8  slot;
    uint16 opts;
    uint32 arg;
    uint32 arg2;
    char   text[128];
} Req_t;

static int32 Judge(void *p)
{
    uint8 b = *(uint8 *)p;
    if (b == 0xEE)
        return -5;
    if (b == 0xDD)
        return 7;
    return 0;
}

static size_t Drain(CFE_SB_PipeId_t pipe, uint8 *out, size_t room, int barrier)
{
    CFE_SB_Buffer_t *buf;
    CFE_MSG_Size_t   size;
    CFE_SB_MsgId_t   mid;
    size_t           used = 0;
    while (CFE_SB_ReceiveBuffer(&buf, pipe, barrier ? 3000 : CFE_SB_POLL) == CFE_SUCCESS)
    {
        CFE_MSG_GetSize(&buf->Msg, &size);
        CFE_MSG_GetMsgId(&buf->Msg, &mid);
        if (barrier && CFE_SB_MsgIdToValue(mid) == CFE_EVS_LONG_EVENT_MSG_MID)
        {
            CFE_EVS_LongEventTlm_t *ev = (CFE_EVS_LongEventTlm_t *)buf;
            if (ev->Payload.PacketID.EventID == CFE_TBL_CC1_ERR_EID && strstr(ev->Payload.Message, "CC = 77"))
                return used;
        }
        if (used + size + 2 <= room)
        {
            out[used++] = size >> 8;
            out[used++] = size & 255;
            memcpy(out + used, buf, size);
            used += size;
        }
    }
    if (barrier)
        memcpy(out + used, "\xff\xff", 2), used += 2;
    return used;
}

static void Serve(int port, bool tap)
{
    int                sock = socket(AF_INET, SOCK_DGRAM, 0);
    struct sockaddr_in me, from;
    socklen_t          len;
    struct timeval     tv = {0, 50000};
    CFE_SB_PipeId_t    pipe;
    CFE_TBL_Handle_t   h[SLOTS];
    uint8             *held[SLOTS];
    uint32             size[SLOTS];
    static uint8       memA[2][16384], memB[2][16384];
    static CFE_SB_Buffer_t *sb;
    char               name[32];
    uint8              rx[2048];
    static uint8       tx[3][60000];
    uint8             *out = tx[port % 3];
    uint32             run = CFE_ES_RunStatus_APP_RUN;
    int                who = port % 3;
    for (int i = 0; i < SLOTS; ++i)
        h[i] = CFE_TBL_BAD_TABLE_HANDLE, held[i] = NULL, size[i] = 0;
    memset(&me, 0, sizeof(me));
    me.sin_family      = AF_INET;
    me.sin_port        = htons(port);
    me.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    int on = 1;
    setsockopt(sock, SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
    bind(sock, (struct sockaddr *)&me, sizeof(me));
    setsockopt(sock, SOL_SOCKET, SO_RCVTIMEO, &tv, sizeof(tv));
    snprintf(name, sizeof(name), "TTPIPE%d", port);
    CFE_SB_CreatePipe(&pipe, 50, name);
    if (tap)
    {
        CFE_SB_SubscribeEx(CFE_SB_ValueToMsgId(CFE_EVS_LONG_EVENT_MSG_MID), pipe, CFE_SB_DEFAULT_QOS, 50);
        CFE_SB_SubscribeEx(CFE_SB_ValueToMsgId(CFE_TBL_HK_TLM_MID), pipe, CFE_SB_DEFAULT_QOS, 50);
        CFE_SB_SubscribeEx(CFE_SB_ValueToMsgId(CFE_TBL_REG_TLM_MID), pipe, CFE_SB_DEFAULT_QOS, 50);
    }
    else
    {
        CFE_SB_SubscribeEx(CFE_SB_ValueToMsgId(0x18F0 + who), pipe, CFE_SB_DEFAULT_QOS, 50);
    }
    while (CFE_ES_RunLoop(&run))
    {
        len       = sizeof(from);
        ssize_t n = recvfrom(sock, rx, sizeof(rx), 0, (struct sockaddr *)&from, &len);
        if (n <= 0)
            continue;
        size_t used = 0;
        if (tap)
        {
            for (int i = 0; i < CFE_PLATFORM_ES_MAX_APPLICATIONS; ++i)
                CFE_EVS_Global.AppData[i].SquelchTokens = CFE_PLATFORM_EVS_MAX_APP_EVENT_BURST * 1000;
            if (rx[0] == 'C')
            {
                sb = CFE_SB_AllocateMessageBuffer(n - 1);
                memcpy(sb, rx + 1, n - 1);
                CFE_SB_TransmitBuffer(sb, false);
            }
            if (rx[0] == 'D')
                OS_TaskDelay(rx[1] * 10);
            CFE_TBL_NoopCmd_t bar;
            CFE_MSG_Init(CFE_MSG_PTR(bar.CommandHeader), CFE_SB_ValueToMsgId(CFE_TBL_CMD_MID), sizeof(bar));
            CFE_MSG_SetFcnCode(CFE_MSG_PTR(bar.CommandHeader), BARRIER_CC);
            CFE_SB_TransmitMsg(CFE_MSG_PTR(bar.CommandHeader), true);
            used = Drain(pipe, out, 60000, 1);
        }
        else
        {
            Req_t   q;
            int32   st = 0x7777;
            void   *p  = NULL;
            memset(&q, 0, sizeof(q));
            memcpy(&q, rx, n < (ssize_t)sizeof(q) ? n : (ssize_t)sizeof(q));
            int   s   = q.slot % SLOTS;
            uint8 *m  = who == 1 ? memA[s & 1] : memB[s & 1];
            used      = 4;
            switch (q.op)
            {
                case 'R':
                    st = CFE_TBL_Register(&h[s], q.text, q.arg, q.opts, q.arg2 ? Judge : NULL);
                    size[s] = q.arg;
                    break;
                case 'S':
                    st = CFE_TBL_Share(&h[s], q.text);
                    size[s] = 4;
                    break;
                case 'U':
                    st = CFE_TBL_Unregister(h[s]);
                    break;
                case 'F':
                    st = CFE_TBL_Load(h[s], CFE_TBL_SRC_FILE, q.text);
                    break;
                case 'A':
                    memset(m, q.arg, 16384);
                    st = CFE_TBL_Load(h[s], CFE_TBL_SRC_ADDRESS, m);
                    break;
                case 'P':
                    st = CFE_TBL_Update(h[s]);
                    break;
                case 'G':
                    st = CFE_TBL_GetAddress(&p, h[s]);
                    if (p)
                        memcpy(out + used, p, size[s]), used += size[s];
                    break;
                case 'E':
                    st = CFE_TBL_ReleaseAddress(h[s]);
                    break;
                case 'V':
                    st = CFE_TBL_Validate(h[s]);
                    break;
                case 'M':
                    st = CFE_TBL_Manage(h[s]);
                    break;
                case 'T':
                    st = CFE_TBL_GetStatus(h[s]);
                    break;
                case 'I':
                {
                    CFE_TBL_Info_t info;
                    memset(&info, 0, sizeof(info));
                    st = CFE_TBL_GetInfo(&info, q.text);
                    if (st == 0)
                    {
                        int k = snprintf((char *)out + used, 400, "%lu %u %u.%u %u %d %d %d %d %d %d %s",
                            (unsigned long)info.Size, (unsigned)info.NumUsers, (unsigned)info.FileTime.Seconds,
                            (unsigned)info.FileTime.Subseconds, (unsigned)info.Crc, info.TimeOfLastUpdate.Seconds != 0,
                            info.TableLoadedOnce, info.DumpOnly, info.DoubleBuffered, info.UserDefAddr, info.Critical,
                            info.LastFileLoaded);
                        used += k;
                    }
                    break;
                }
                case 'B':
                    st = CFE_TBL_DumpToBuffer(h[s]);
                    break;
                case 'O':
                    st = CFE_TBL_GetAddress(&p, h[s]);
                    if (p)
                    {
                        memset(p, q.arg, size[s] < 4 ? size[s] : 4);
                        st = CFE_TBL_Modified(h[s]);
                        CFE_TBL_ReleaseAddress(h[s]);
                    }
                    break;
                case 'N':
                    st = CFE_TBL_NotifyByMessage(h[s], CFE_SB_ValueToMsgId(q.arg), q.opts, q.arg2);
                    break;
                case 'Q':
                    st = 0;
                    used += Drain(pipe, out + used, 50000, 0);
                    break;
                case 'L':
                {
                    osal_id_t fd;
                    st = OS_OpenCreate(&fd, q.text, OS_FILE_FLAG_NONE, OS_READ_ONLY);
                    if (st == 0)
                    {
                        int k = OS_read(fd, out + used, 50000);
                        if (k > 0)
                            used += k;
                        OS_close(fd);
                    }
                    break;
                }
                case 'K':
                    st = OS_CloseAllFiles();
                    break;
                case 'X':
                    st = OS_remove(q.text);
                    break;
                case 'W':
                {
                    osal_id_t fd;
                    st = OS_OpenCreate(&fd, q.text, OS_FILE_FLAG_CREATE | OS_FILE_FLAG_TRUNCATE, OS_WRITE_ONLY);
                    if (st == 0)
                    {
                        OS_write(fd, rx + sizeof(q), n - sizeof(q));
                        OS_close(fd);
                    }
                    break;
                }
            }
            memcpy(out, &st, 4);
        }
        sendto(sock, out, used, 0, (struct sockaddr *)&from, len);
    }
    close(sock);
    CFE_ES_ExitApp(run);
}

void TTT_Main(void) { CFE_EVS_Register(NULL, 0, CFE_EVS_EventFilter_BINARY); Serve(5100, true); }
void TTA_Main(void) { CFE_EVS_Register(NULL, 0, CFE_EVS_EventFilter_BINARY); Serve(5101, false); }
void TTB_Main(void) { CFE_EVS_Register(NULL, 0, CFE_EVS_EventFilter_BINARY); Serve(5102, false); }
