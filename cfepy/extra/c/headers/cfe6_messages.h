/* cFE 6: messages by pointer and by MsgId, on the functions of cFE 7. A MsgId is a number of 16 bits. */
#ifndef CFEPY_CFE6_MESSAGES_H
#define CFEPY_CFE6_MESSAGES_H

#include "cfe6_headers.h"
#include "sb_messages.h"

typedef CFE_SB_Msg_t *CFE_SB_MsgPtr_t;
typedef uint8 *CFE_SB_MsgPayloadPtr_t;
typedef cpuaddr CFE_SB_ZeroCopyHandle_t;
typedef uint32 CFE_SB_TimeOut_t;

static inline CFE_SB_MsgId_t CFEPY_6_Id(uint16 value)
{
    CFE_SB_MsgId_t id = CFE_SB_MSGID_WRAP_VALUE(value);
    return id;
}

typedef uint16 CFEPY_6_MsgId_t;
#define CFE_SB_MsgId_t      CFEPY_6_MsgId_t
#define CFE_SB_MsgId_Atom_t CFEPY_6_MsgId_t
#undef CFE_SB_INVALID_MSG_ID
#define CFE_SB_INVALID_MSG_ID              0xFFFF
#define CFE_SB_MsgIdToValue(id)            ((CFE_SB_MsgId_Atom_t)(id))
#define CFE_SB_ValueToMsgId(value)         ((CFE_SB_MsgId_t)(value))
#define CFE_SB_MsgId_Equal(one, other)     ((one) == (other))
#define CFE_SB_IsValidMsgId(id)            CFE_SB_IsValidMsgId(CFEPY_6_Id(id))
#define CFE_SB_Default_Qos                 CFE_SB_DEFAULT_QOS
#define CFE_SB_SUB_ENTRIES_PER_PKT         20
#define CFE_SB_SET_MEMADDR(into, address)  ((into) = (cpuaddr)(address))
#define CFE_SB_GET_MEMADDR(address)        ((cpuaddr)(address))

/* ---- pipes and subscriptions ---- */
#define CFE_SB_Subscribe(id, pipe)                     CFE_SB_Subscribe(CFEPY_6_Id(id), pipe)
#define CFE_SB_SubscribeEx(id, pipe, quality, limit)   CFE_SB_SubscribeEx(CFEPY_6_Id(id), pipe, quality, limit)
#define CFE_SB_SubscribeLocal(id, pipe, limit)         CFE_SB_SubscribeLocal(CFEPY_6_Id(id), pipe, limit)
#define CFE_SB_Unsubscribe(id, pipe)                   CFE_SB_Unsubscribe(CFEPY_6_Id(id), pipe)
#define CFE_SB_UnsubscribeLocal(id, pipe)              CFE_SB_UnsubscribeLocal(CFEPY_6_Id(id), pipe)
#define CFE_SB_RcvMsg(message, pipe, timeout) \
    CFE_SB_ReceiveBuffer((CFE_SB_Buffer_t **)(void *)(message), pipe, timeout)

/* ---- sending: SendMsg counts telemetry alone, and adds no checksum to a command ---- */
#define CFEPY_6_IS_TLM(message) ((((const uint8 *)(message))[0] & 0x10) == 0)
#define CFE_SB_SendMsg(message)                                                        \
    ({                                                                                 \
        const void *cfepy_sent = (const void *)(message);                              \
        CFE_SB_TransmitMsg((const CFE_MSG_Message_t *)cfepy_sent,                      \
                           cfepy_sent != NULL && CFEPY_6_IS_TLM(cfepy_sent));          \
    })
#define CFE_SB_PassMsg(message) CFE_SB_TransmitMsg((const CFE_MSG_Message_t *)(const void *)(message), false)
#define CFE_SB_ZeroCopyGetPtr(size, handle)                                            \
    ({                                                                                 \
        CFE_SB_ZeroCopyHandle_t *cfepy_handle = (CFE_SB_ZeroCopyHandle_t *)(handle);   \
        void *cfepy_buffer = CFE_SB_AllocateMessageBuffer((uint16)(size));             \
        if (cfepy_buffer != NULL) {                                                    \
            *cfepy_handle = (CFE_SB_ZeroCopyHandle_t)cfepy_buffer;                     \
        }                                                                              \
        (CFE_SB_Msg_t *)cfepy_buffer;                                                  \
    })
#define CFE_SB_ZeroCopyReleasePtr(message, handle) \
    ((void)(handle), CFE_SB_ReleaseMessageBuffer((CFE_SB_Buffer_t *)(void *)(message)))
#define CFE_SB_ZeroCopySend(message, handle)                                           \
    ({                                                                                 \
        void *cfepy_sent = (void *)(message);                                          \
        (void)(handle);                                                                \
        CFE_SB_TransmitBuffer((CFE_SB_Buffer_t *)cfepy_sent,                           \
                              cfepy_sent != NULL && CFEPY_6_IS_TLM(cfepy_sent));       \
    })
#define CFE_SB_ZeroCopyPass(message, handle) \
    ((void)(handle), CFE_SB_TransmitBuffer((CFE_SB_Buffer_t *)(void *)(message), false))

/* ---- the header of a message; without Clear, InitMsg keeps the sequence count and everything behind ---- */
#define CFEPY_6_AT(message) (*(CFE_SB_CmdHdr_t *)(void *)(message))
#define CFEPY_6_PRI(message) (*(CCSDS_PriHdr_t *)(void *)(message))
#if CFEPY_CFE_6 == 65
#define CFEPY_6_MARK(header)
#else
#define CFEPY_6_MARK(header) CCSDS_WR_SHDR(header, 1);
#endif
#define CFE_SB_InitMsg(message, id, size, clear)                                       \
    ((void)({                                                                          \
        CCSDS_PriHdr_t *cfepy_header = (CCSDS_PriHdr_t *)(void *)(message);            \
        const uint16 cfepy_id = (uint16)(id), cfepy_size = (uint16)(size);             \
        const uint16 cfepy_count = CCSDS_RD_SEQ(*cfepy_header);                        \
        const bool cfepy_clear = (clear);                                              \
        if (cfepy_clear) {                                                             \
            memset((void *)cfepy_header, 0, cfepy_size);                               \
        }                                                                              \
        CCSDS_CLR_PRI_HDR(*cfepy_header);                                              \
        CCSDS_WR_LEN(*cfepy_header, cfepy_size);                                       \
        CCSDS_WR_SID(*cfepy_header, cfepy_id);                                         \
        CFEPY_6_MARK(*cfepy_header)                                                    \
        CCSDS_WR_SEQ(*cfepy_header, cfepy_clear ? 0 : cfepy_count);                    \
    }))
#define CFE_SB_GetMsgId(message)                 ((CFE_SB_MsgId_t)CCSDS_RD_SID(CFEPY_6_PRI(message)))
#define CFE_SB_SetMsgId(message, id)             ((void)CCSDS_WR_SID(CFEPY_6_PRI(message), id))
#define CFE_SB_GetTotalMsgLength(message)        ((uint16)CCSDS_RD_LEN(CFEPY_6_PRI(message)))
#define CFE_SB_SetTotalMsgLength(message, size)  ((void)CCSDS_WR_LEN(CFEPY_6_PRI(message), size))
#define CFEPY_6_HEADER_SIZE(header)                                                    \
    ((uint16)(CCSDS_RD_SHDR(header) == 0           ? sizeof(CCSDS_PriHdr_t)            \
              : CCSDS_RD_TYPE(header) == CCSDS_CMD ? CFE_SB_CMD_HDR_SIZE               \
                                                   : CFE_SB_TLM_HDR_SIZE))
#if CFEPY_CFE_6 == 65
#define CFE_SB_MsgHdrSize(id)                                                          \
    ({                                                                                 \
        CCSDS_PriHdr_t cfepy_header;                                                   \
        CCSDS_WR_SID(cfepy_header, id);                                                \
        CFEPY_6_HEADER_SIZE(cfepy_header);                                             \
    })
#else
#define CFE_SB_MsgHdrSize(message) CFEPY_6_HEADER_SIZE(CFEPY_6_PRI(message))
#endif
#define CFE_SB_GetUserData(message)                                                    \
    ({                                                                                 \
        uint8 *cfepy_at = (uint8 *)(void *)(message);                                  \
        (void *)(cfepy_at + CFEPY_6_HEADER_SIZE(CFEPY_6_PRI(cfepy_at)));               \
    })
#define CFE_SB_GetUserDataLength(message) \
    ((uint16)(CFE_SB_GetTotalMsgLength(message) - CFEPY_6_HEADER_SIZE(CFEPY_6_PRI(message))))
#define CFE_SB_SetUserDataLength(message, size) \
    CFE_SB_SetTotalMsgLength(message, CFEPY_6_HEADER_SIZE(CFEPY_6_PRI(message)) + (size))

/* ---- time, function code, checksum ---- */
#define CFE_SB_TimeStampMsg(message) CFE_SB_TimeStampMsg((CFE_MSG_Message_t *)(void *)(message))
#define CFE_SB_GetMsgTime(message)                                                     \
    ({                                                                                 \
        CFE_TIME_SysTime_t cfepy_time = {0, 0};                                        \
        CFE_MSG_GetMsgTime((CFE_MSG_Message_t *)(void *)(message), &cfepy_time);       \
        cfepy_time;                                                                    \
    })
#define CFE_SB_SetMsgTime(message, time)                                               \
    CFEPY_6_Status(CFE_MSG_SetMsgTime((CFE_MSG_Message_t *)(void *)(message), time) == CFE_SUCCESS \
                       ? CFE_SUCCESS                                                   \
                       : CFE_SB_WRONG_MSG_TYPE)
#define CFEPY_6_IS_CMD(message) ((CFEPY_6_PRI(message).StreamId[0] & 0x18) == 0x18)
#define CFE_SB_GetCmdCode(message) \
    ((uint16)(CFEPY_6_IS_CMD(message) ? CCSDS_RD_FC(CFEPY_6_AT(message).Sec) : 0))
#define CFE_SB_SetCmdCode(message, code)                                               \
    CFEPY_6_Status(CFEPY_6_IS_CMD(message)                                             \
                       ? ((void)CCSDS_WR_FC(CFEPY_6_AT(message).Sec, code), CFE_SUCCESS) \
                       : CFE_SB_WRONG_MSG_TYPE)
#define CFE_SB_GetChecksum(message) \
    ((uint16)(CFEPY_6_IS_CMD(message) ? CCSDS_RD_CHECKSUM(CFEPY_6_AT(message).Sec) : 0))
#define CFE_SB_GenerateChecksum(message) ((void)CFE_MSG_GenerateChecksum((CFE_MSG_Message_t *)(void *)(message)))
#define CFE_SB_ValidateChecksum(message)                                               \
    ({                                                                                 \
        bool cfepy_fits = false;                                                       \
        CFE_MSG_ValidateChecksum((const CFE_MSG_Message_t *)(const void *)(message), &cfepy_fits); \
        (boolean)cfepy_fits;                                                           \
    })
#define CCSDS_LoadCheckSum(packet)  CFE_SB_GenerateChecksum(packet)
#define CCSDS_ValidCheckSum(packet) CFE_SB_ValidateChecksum(packet)
#define CCSDS_ComputeCheckSum(packet)                                                  \
    ({                                                                                 \
        const uint8 *cfepy_at = (const uint8 *)(const void *)(packet);                 \
        uint16 cfepy_left = (uint16)(CFEPY_6_BIG(cfepy_at + 4) + 7);                   \
        uint8 cfepy_sum = 0xFF;                                                        \
        while (cfepy_left-- > 0) {                                                     \
            cfepy_sum ^= *cfepy_at++;                                                  \
        }                                                                              \
        cfepy_sum;                                                                     \
    })
#define CCSDS_InitPkt(packet, id, size, clear) CFE_SB_InitMsg(packet, id, size, clear)

#endif
