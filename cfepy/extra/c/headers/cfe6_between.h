/* Between cFE 6 and 7: development versions of 2020 and 2021 (6.7.99, cFE 6.8) up to 7.0.0-rc4. They have the messages
 * and headers of cFE 7, but a MsgId is a number of 32 bits, and most names of cFE 6 are there as well. */
#ifndef CFEPY_CFE6_BETWEEN_H
#define CFEPY_CFE6_BETWEEN_H

#include "base.h"
#include "msg.h"
#include "sb_messages.h"

/* A status that an application may ignore without a warning. */
static inline int32 CFEPY_6_Status(int32 status)
{
    return status;
}

static inline CFE_SB_MsgId_t CFEPY_6_Id(uint32 value)
{
    CFE_SB_MsgId_t id = CFE_SB_MSGID_WRAP_VALUE(value);
    return id;
}

static inline uint32 CFEPY_6_Value(CFE_SB_MsgId_t id)
{
    return CFE_SB_MsgIdToValue(id);
}

/* ---- a MsgId ---- */
#define CFEPY_6_STATUS_AND_VALUE(call)                                                 \
    ({                                                                                 \
        CFE_SB_MsgId_t cfepy_id = CFE_SB_MSGID_WRAP_VALUE(0);                          \
        const CFE_Status_t cfepy_status = (call);                                      \
        if (cfepy_to != NULL) {                                                        \
            *cfepy_to = CFEPY_6_Value(cfepy_id);                                       \
        }                                                                              \
        cfepy_status;                                                                  \
    })
typedef uint32 CFEPY_6_MsgId_t;
static inline CFE_Status_t CFEPY_6_GetMsgId(const CFE_MSG_Message_t *message, CFEPY_6_MsgId_t *cfepy_to)
{
    return CFEPY_6_STATUS_AND_VALUE(CFE_MSG_GetMsgId(message, cfepy_to == NULL ? NULL : &cfepy_id));
}
#define CFE_SB_MsgId_t      CFEPY_6_MsgId_t
#define CFE_SB_MsgId_Atom_t CFEPY_6_MsgId_t
#undef CFE_SB_MSGID_WRAP_VALUE
#undef CFE_SB_MSGID_C
#undef CFE_SB_MSGID_UNWRAP_VALUE
#undef CFE_SB_MSGID_RESERVED
#undef CFE_SB_INVALID_MSG_ID
#define CFE_SB_MSGID_WRAP_VALUE(value)     ((CFE_SB_MsgId_t)(value))
#define CFE_SB_MSGID_C(value)              ((CFE_SB_MsgId_t)(value))
#define CFE_SB_MSGID_UNWRAP_VALUE(id)      ((CFE_SB_MsgId_Atom_t)(id))
#define CFE_SB_MSGID_RESERVED              CFE_SB_MSGID_WRAP_VALUE(-1)
#define CFE_SB_INVALID_MSG_ID              CFE_SB_MSGID_RESERVED
#define CFE_SB_MsgIdToValue(id)            ((CFE_SB_MsgId_Atom_t)(id))
#define CFE_SB_ValueToMsgId(value)         ((CFE_SB_MsgId_t)(value))
#define CFE_SB_MsgId_Equal(one, other)     ((one) == (other))
#define CFE_SB_IsValidMsgId(id)            CFE_SB_IsValidMsgId(CFEPY_6_Id(id))
#define CFE_SB_Subscribe(id, pipe)                     CFE_SB_Subscribe(CFEPY_6_Id(id), pipe)
#define CFE_SB_SubscribeEx(id, pipe, quality, limit)   CFE_SB_SubscribeEx(CFEPY_6_Id(id), pipe, quality, limit)
#define CFE_SB_SubscribeLocal(id, pipe, limit)         CFE_SB_SubscribeLocal(CFEPY_6_Id(id), pipe, limit)
#define CFE_SB_Unsubscribe(id, pipe)                   CFE_SB_Unsubscribe(CFEPY_6_Id(id), pipe)
#define CFE_SB_UnsubscribeLocal(id, pipe)              CFE_SB_UnsubscribeLocal(CFEPY_6_Id(id), pipe)
#define CFE_MSG_Init(message, id, size)                CFE_MSG_Init(message, CFEPY_6_Id(id), size)
#define CFE_MSG_GetMsgId(message, id)                  CFEPY_6_GetMsgId(message, id)
#define CFE_MSG_SetMsgId(message, id)                  CFE_MSG_SetMsgId(message, CFEPY_6_Id(id))
#define CFE_MSG_GetTypeFromMsgId(id, type)             CFE_MSG_GetTypeFromMsgId(CFEPY_6_Id(id), type)

/* ---- names of cFE 6 that are still there ---- */
typedef CFE_SB_Buffer_t CFE_SB_Msg_t;
typedef CFE_MSG_Message_t *CFE_SB_MsgPtr_t;
typedef CFE_MSG_CommandHeader_t CFE_SB_CmdHdr_t;
typedef CFE_MSG_TelemetryHeader_t CFE_SB_TlmHdr_t;
typedef uint8 *CFE_SB_MsgPayloadPtr_t;
typedef cpuaddr CFE_SB_ZeroCopyHandle_t;
typedef uint32 CFE_SB_TimeOut_t;
#define CFE_SB_CMD_HDR_SIZE sizeof(CFE_MSG_CommandHeader_t)
#define CFE_SB_TLM_HDR_SIZE sizeof(CFE_MSG_TelemetryHeader_t)
#define CFE_SB_Default_Qos  CFE_SB_DEFAULT_QOS
#define CFEPY_6_MESSAGE(message) ((CFE_MSG_Message_t *)(void *)(message))
#define CFE_SB_InitMsg(message, id, size, clear) ((void)(clear), (void)CFE_MSG_Init(CFEPY_6_MESSAGE(message), id, size))
#define CFE_SB_RcvMsg(message, pipe, timeout) \
    CFE_SB_ReceiveBuffer((CFE_SB_Buffer_t **)(void *)(message), pipe, timeout)
#define CFE_SB_SendMsg(message) CFE_SB_TransmitMsg(CFEPY_6_MESSAGE(message), true)
#define CFE_SB_PassMsg(message) CFE_SB_TransmitMsg(CFEPY_6_MESSAGE(message), false)
#define CFE_SB_ZeroCopyGetPtr(size, handle) \
    ((void)(*(CFE_SB_ZeroCopyHandle_t *)(handle) = 0), CFE_SB_AllocateMessageBuffer(size))
#define CFE_SB_ZeroCopyReleasePtr(buffer, handle) ((void)(handle), CFE_SB_ReleaseMessageBuffer(buffer))
#define CFE_SB_ZeroCopySend(buffer, handle)       ((void)(handle), CFE_SB_TransmitBuffer(buffer, true))
#define CFE_SB_ZeroCopyPass(buffer, handle)       ((void)(handle), CFE_SB_TransmitBuffer(buffer, false))

#define CFEPY_6_FIELD(type, get, message)                                              \
    ({                                                                                 \
        type cfepy_field;                                                              \
        memset(&cfepy_field, 0, sizeof(cfepy_field));                                  \
        get(CFEPY_6_MESSAGE(message), &cfepy_field);                                   \
        cfepy_field;                                                                   \
    })
#define CFE_SB_GetMsgId(message)                CFEPY_6_FIELD(CFEPY_6_MsgId_t, CFE_MSG_GetMsgId, message)
#define CFE_SB_SetMsgId(message, id)            ((void)CFE_MSG_SetMsgId(CFEPY_6_MESSAGE(message), id))
#define CFE_SB_GetTotalMsgLength(message)       CFEPY_6_FIELD(CFE_MSG_Size_t, CFE_MSG_GetSize, message)
#define CFE_SB_SetTotalMsgLength(message, size) ((void)CFE_MSG_SetSize(CFEPY_6_MESSAGE(message), size))
#define CFE_SB_GetCmdCode(message)              CFEPY_6_FIELD(CFE_MSG_FcnCode_t, CFE_MSG_GetFcnCode, message)
#define CFE_SB_SetCmdCode(message, code)        CFEPY_6_Status(CFE_MSG_SetFcnCode(CFEPY_6_MESSAGE(message), code))
#define CFE_SB_GetMsgTime(message)              CFEPY_6_FIELD(CFE_TIME_SysTime_t, CFE_MSG_GetMsgTime, message)
#define CFE_SB_SetMsgTime(message, time)        CFEPY_6_Status(CFE_MSG_SetMsgTime(CFEPY_6_MESSAGE(message), time))
#define CFE_SB_TimeStampMsg(message)            CFE_SB_TimeStampMsg(CFEPY_6_MESSAGE(message))
#define CFE_SB_GetUserData(message)             CFE_SB_GetUserData(CFEPY_6_MESSAGE(message))
#define CFE_SB_GetUserDataLength(message)       CFE_SB_GetUserDataLength(CFEPY_6_MESSAGE(message))
#define CFE_SB_SetUserDataLength(message, size) CFE_SB_SetUserDataLength(CFEPY_6_MESSAGE(message), size)
#define CFE_SB_GenerateChecksum(message)        ((void)CFE_MSG_GenerateChecksum(CFEPY_6_MESSAGE(message)))
#define CFE_SB_ValidateChecksum(message)        CFEPY_6_FIELD(bool, CFE_MSG_ValidateChecksum, message)

/* ---- OSAL: a task is registered before it runs ---- */
#define OS_TaskRegister() CFEPY_6_Status(OS_SUCCESS)

#endif
