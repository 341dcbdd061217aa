/* An application between cFE 6 and 7: messages of cFE 7, MsgIds that are numbers, and some names of cFE 6. */
#include "cfe.h"
#include "cfe_msg_api.h"

#define BETWEEN_CMD_MID     0x1890
#define BETWEEN_SEND_HK_MID 0x1891
#define BETWEEN_HK_TLM_MID  0x0890
#define BETWEEN_NOOP_CC     0

typedef struct {
    CFE_SB_CmdHdr_t CmdHeader;
} BETWEEN_NoopCmd_t;

typedef struct {
    CFE_MSG_TelemetryHeader_t TlmHeader;
    uint16                    Count;
    uint16                    Last;
} BETWEEN_HkTlm_t;

static BETWEEN_HkTlm_t Hk;
static BETWEEN_NoopCmd_t Echo;

static void Answer(CFE_SB_Buffer_t *buffer)
{
    CFE_SB_MsgId_t    id = CFE_SB_INVALID_MSG_ID;
    CFE_MSG_FcnCode_t code = 99;
    CFE_MSG_Type_t    type;

    CFE_MSG_GetMsgId(&buffer->Msg, &id);
    switch (id)
    {
        case BETWEEN_SEND_HK_MID:
            CFE_SB_TimeStampMsg(&Hk.TlmHeader.Msg);
            CFE_SB_SendMsg(&Hk.TlmHeader.Msg);
            CFE_SB_SetCmdCode(&Echo.CmdHeader.Msg, 5);
            CFE_SB_SendMsg(&Echo.CmdHeader.Msg);
            break;
        case BETWEEN_CMD_MID:
            CFE_MSG_GetFcnCode(&buffer->Msg, &code);
            Hk.Count++;
            Hk.Last = id;
            CFE_MSG_GetTypeFromMsgId(id, &type);
            CFE_EVS_SendEvent(1, CFE_EVS_EventType_INFORMATION, "NOOP %d of 0x%x, %d bytes, %d, %d", code,
                              (unsigned int)CFE_SB_GetMsgId(&buffer->Msg),
                              (int)CFE_SB_GetTotalMsgLength(&buffer->Msg), type == CFE_MSG_Type_Cmd,
                              (int)CFE_MSG_GetMsgId(&buffer->Msg, NULL) == CFE_MSG_BAD_ARGUMENT);
            break;
    }
}

void BETWEEN_Main(void)
{
    CFE_SB_PipeId_t pipe;
    CFE_SB_Msg_t *  buffer;

    CFE_ES_RegisterApp();
    CFE_EVS_Register(NULL, 0, CFE_EVS_EventFilter_BINARY);
    CFE_SB_CreatePipe(&pipe, 5, "BETWEEN");
    CFE_SB_Subscribe(BETWEEN_CMD_MID, pipe);
    CFE_SB_SubscribeEx(BETWEEN_SEND_HK_MID, pipe, CFE_SB_DEFAULT_QOS, 4);
    CFE_MSG_Init(&Hk.TlmHeader.Msg, BETWEEN_HK_TLM_MID, sizeof(Hk));
    CFE_SB_InitMsg(&Echo, BETWEEN_CMD_MID, sizeof(Echo), false);
    while (CFE_ES_RunLoop(NULL))
    {
        if (CFE_SB_RcvMsg(&buffer, pipe, CFE_SB_PEND_FOREVER) == CFE_SUCCESS)
        {
            Answer(buffer);
        }
    }
}
