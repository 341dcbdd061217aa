/* An application in the style of cFE 6: messages by pointer, arrays of bytes as headers, the names of cFE 6. */
#include "cfe.h"
#include "cfe_error.h"
#include "network_includes.h"
#include "osapi-os-core.h"
#include "ccsds.h"
#include "veteran_msgids.h"
#include "veteran_tbl.h"

#define VETERAN_NOOP_CC  0
#define VETERAN_FILES_CC 2

/* These two names differ between the releases; the build may give those of 6.7. */
#ifndef PRIMARY_OF
#define PRIMARY_OF(message) (message)->Hdr
#define SIZE_OF_FILE(stat)  (stat).st_size
#endif

typedef struct {
    uint8 CmdHeader[CFE_SB_CMD_HDR_SIZE];
    uint16 Value;
} OS_PACK VETERAN_FilesCmd_t;

typedef struct {
    uint8 TlmHeader[CFE_SB_TLM_HDR_SIZE];
    uint8 CmdCounter, ErrCounter;
    uint16 Limit;
    uint32 Copied;
} OS_PACK VETERAN_HkTlm_t;

typedef struct {
    CFE_SB_MsgPtr_t MsgPtr;
    CFE_SB_PipeId_t Pipe, OwnPipe;
    CFE_TBL_Handle_t Table;
    VETERAN_HkTlm_t Hk;
    uint32 Queue;
    boolean IsReady;
} VETERAN_Data_t;

static VETERAN_Data_t Data;
static CFE_EVS_BinFilter_t Filters[] = {{1, CFE_EVS_NO_FILTER}, {2, 0x0000}};

static void Inform(const char *Text, uint32 Value)
{
    CFE_EVS_SendEvent(1, CFE_EVS_INFORMATION, "%s 0x%X", Text, (unsigned int)Value);
}

static boolean HasLength(CFE_SB_MsgPtr_t Msg, uint16 Expected)
{
    uint16 Actual = CFE_SB_GetTotalMsgLength(Msg);
    boolean Fits = (Actual == Expected) ? TRUE : FALSE;

    if (!Fits) {
        CFE_EVS_SendEvent(2, CFE_EVS_ERROR, "length of 0x%04X, code %u: %u, not %u", CFE_SB_GetMsgId(Msg),
                          CFE_SB_GetCmdCode(Msg), Actual, Expected);
        Data.Hk.ErrCounter++;
    }
    return Fits;
}

static int32 LookAtFiles(void)
{
    int32 Fd;
    os_fstat_t Stat;
    os_dirp_t Folder;
    os_dirent_t *Entry;
    uint32 Count = 0;
    char Text[8];

    Fd = OS_open("/ram/none.txt", OS_READ_ONLY, 0);
    Inform("missing", Fd < 0);
    Fd = OS_creat("/ram/veteran.txt", OS_READ_WRITE);
    if (Fd < OS_FS_SUCCESS) {
        return Fd;
    }
    OS_write(Fd, "abcd", 4);
    OS_lseek(Fd, 0, OS_SEEK_SET);
    Inform("read", OS_read(Fd, Text, sizeof(Text)));
    OS_close(Fd);
    OS_stat("/ram/veteran.txt", &Stat);
    Inform("size", SIZE_OF_FILE(Stat));
    Folder = OS_opendir("/ram");
    while ((Entry = OS_readdir(Folder)) != NULL) {
        Count += strcmp(OS_DIRENTRY_NAME(*Entry), "veteran.txt") == 0;
    }
    OS_closedir(Folder);
    Inform("found", Count);
    return OS_FS_SUCCESS;
}

static void SendHk(void)
{
    VETERAN_Row_t *Rows = NULL;
    CFE_SB_MsgPtr_t Copy;
    int32 Status;
    uint32 Guard[2] = {0xFFFFFFFF, 0x5A5A5A5A};
    uint16 Sent = 0x1234;

    Status = CFE_TBL_GetAddress((void **)&Rows, Data.Table);
    if (Status >= CFE_SUCCESS) {
        Data.Hk.Limit = Rows[0].Limit + (Rows[1].MsgId == CFE_SB_HIGHEST_VALID_MSGID);
        CFE_TBL_ReleaseAddress(Data.Table);
    }
    OS_QueuePut(Data.Queue, &Sent, sizeof(Sent), 0);
    OS_QueueGet(Data.Queue, &Sent, sizeof(Sent), &Guard[0], OS_CHECK);
    Data.Hk.Copied = Guard[0] + (Guard[1] != 0x5A5A5A5A);
    CFE_SB_TimeStampMsg((CFE_SB_Msg_t *)&Data.Hk);
    CFE_SB_SendMsg((CFE_SB_Msg_t *)&Data.Hk);
    if (CFE_SB_RcvMsg(&Copy, Data.OwnPipe, CFE_SB_POLL) == CFE_SUCCESS) {
        Inform("own payload of", CFE_SB_GetUserDataLength(Copy));
        Inform("own time", CFE_SB_GetMsgTime(Copy).Seconds);
    }
}

static void Send(uint16 Code)
{
    VETERAN_FilesCmd_t Cmd;
    CFE_SB_ZeroCopyHandle_t Handle;
    CFE_SB_Msg_t *Copy;

    Cmd.Value = 0x55AA;
    CCSDS_WR_SEQ(*(CCSDS_PriHdr_t *)&Cmd, 5);
    CFE_SB_InitMsg(&Cmd, VETERAN_CMD_MID, sizeof(Cmd), FALSE);
    CFE_SB_SetCmdCode((CFE_SB_MsgPtr_t)&Cmd, Code);
    CFE_SB_GenerateChecksum((CFE_SB_MsgPtr_t)&Cmd);
    Inform("checksum is right", CFE_SB_ValidateChecksum((CFE_SB_MsgPtr_t)&Cmd));
    Inform("payload at", (uint32)((uint8 *)CFE_SB_GetUserData((CFE_SB_MsgPtr_t)&Cmd) - (uint8 *)&Cmd));
    Inform("payload", Cmd.Value);
    Copy = CFE_SB_ZeroCopyGetPtr(sizeof(Cmd), &Handle);
    memcpy(Copy, &Cmd, sizeof(Cmd));
    CFE_SB_ZeroCopySend(Copy, Handle);
}

static void Command(CFE_SB_MsgPtr_t Msg)
{
    switch (CFE_SB_GetCmdCode(Msg)) {
        case VETERAN_NOOP_CC:
            if (HasLength(Msg, CFE_SB_CMD_HDR_SIZE)) {
                Data.Hk.CmdCounter++;
                CFE_EVS_SendEvent(1, CFE_EVS_INFORMATION, "NOOP of %u", CFE_SPACECRAFT_ID);
                Send(VETERAN_FILES_CC);
            }
            break;
        case VETERAN_FILES_CC:
            if (HasLength(Msg, sizeof(VETERAN_FilesCmd_t))) {
                Data.Hk.CmdCounter++;
                Inform("count in the header", CCSDS_RD_SEQ(PRIMARY_OF(Msg)));
                Inform("value", ((VETERAN_FilesCmd_t *)Msg)->Value);
                LookAtFiles();
            }
            break;
        default:
            Data.Hk.ErrCounter++;
    }
}

static int32 Begin(void)
{
    OS_time_t Now;
    int32 Status = CFE_ES_RegisterApp();

    if (Status != CFE_SUCCESS) {
        return Status;
    }
    CFE_EVS_Register(Filters, sizeof(Filters) / sizeof(CFE_EVS_BinFilter_t), CFE_EVS_BINARY_FILTER);
    CFE_SB_CreatePipe(&Data.Pipe, 10, "VETERAN_PIPE");
    CFE_SB_Subscribe(VETERAN_CMD_MID, Data.Pipe);
    CFE_SB_SubscribeEx(VETERAN_SEND_HK_MID, Data.Pipe, CFE_SB_Default_Qos, 4);
    CFE_SB_CreatePipe(&Data.OwnPipe, 4, "VETERAN_OWN");
    CFE_SB_SubscribeLocal(VETERAN_HK_TLM_MID, Data.OwnPipe, 4);
    CFE_SB_InitMsg(&Data.Hk, VETERAN_HK_TLM_MID, sizeof(Data.Hk), TRUE);
    Status = CFE_TBL_Register(&Data.Table, "Rows", 2 * sizeof(VETERAN_Row_t), CFE_TBL_OPT_DEFAULT, NULL);
    if (Status == CFE_SUCCESS) {
        Status = CFE_TBL_Load(Data.Table, CFE_TBL_SRC_FILE, "/cf/veteran_rows.tbl");
    }
    CFE_TBL_Manage(Data.Table);
    OS_QueueCreate(&Data.Queue, "VETERAN_Q", 2, 2, 0);
    OS_GetLocalTime(&Now);
    OS_printf("VETERAN: %u microseconds\n", (unsigned int)(Now.microsecs < 1000000));
    Data.IsReady = TRUE;
    Inform("headers", (uint32)(CFE_SB_TLM_HDR_SIZE << 8 | CFE_SB_CMD_HDR_SIZE));
    return Status;
}

void VETERAN_Main(void)
{
    uint32 RunStatus = CFE_ES_APP_RUN;
    int32 Status = Begin();

    if (Status != CFE_SUCCESS) {
        RunStatus = CFE_ES_APP_ERROR;
    }
    while (CFE_ES_RunLoop(&RunStatus) == TRUE) {
        Status = CFE_SB_RcvMsg(&Data.MsgPtr, Data.Pipe, 5000);
        if (Status == CFE_SB_TIME_OUT) {
            Inform("no message", Data.MsgPtr == NULL);
            continue;
        }
        switch (CFE_SB_GetMsgId(Data.MsgPtr)) {
            case VETERAN_CMD_MID:
                Command(Data.MsgPtr);
                break;
            case VETERAN_SEND_HK_MID:
                SendHk();
                break;
            default:
                Data.Hk.ErrCounter++;
        }
    }
    CFE_ES_ExitApp(RunStatus);
}
