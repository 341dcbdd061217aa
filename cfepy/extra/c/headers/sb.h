/* CFE_SB: pipes, subscriptions and messages of the Software Bus. */
#ifndef CFEPY_SB_H
#define CFEPY_SB_H

#include "msg.h"

CFEPY_C_BEGIN

enum CFE_SB_QosPriority { CFE_SB_QosPriority_LOW = 0, CFE_SB_QosPriority_HIGH = 1 };
typedef uint8 CFE_SB_QosPriority_Enum_t;
enum CFE_SB_QosReliability { CFE_SB_QosReliability_LOW = 0, CFE_SB_QosReliability_HIGH = 1 };
typedef uint8 CFE_SB_QosReliability_Enum_t;
typedef uint16 CFE_SB_RouteId_Atom_t;
typedef CFE_ResourceId_t CFE_SB_PipeId_t;

typedef struct {
    uint8 Priority, Reliability;
} CFE_SB_Qos_t;

typedef union CFE_SB_Msg {
    CFE_MSG_Message_t Msg;
    long long int LongInt;
    long double LongDouble;
} CFE_SB_Buffer_t;

#define CFE_SB_PEND_FOREVER        (-1)
#define CFE_SB_POLL                0
#define CFE_SB_SUBSCRIPTION        0
#define CFE_SB_PIPEOPTS_IGNOREMINE 0x1
#define CFE_SB_UNSUBSCRIPTION      1
#define CFE_SB_DEFAULT_QOS ((CFE_SB_Qos_t){0})

/* ---- message ids ---- */
#define CFE_SB_MSGID_WRAP_VALUE(value) {value}
#define CFE_SB_MSGID_UNWRAP_VALUE(mid) ((mid).Value)
#define CFE_SB_MSGID_C(value)          ((CFE_SB_MsgId_t)CFE_SB_MSGID_WRAP_VALUE(value))
#define CFE_SB_MSGID_RESERVED          CFE_SB_MSGID_WRAP_VALUE(0)
#define CFE_SB_INVALID_MSG_ID          CFE_SB_MSGID_C(0)
CFE_SB_MsgId_Atom_t CFE_SB_CmdTopicIdToMsgId(uint16 TopicId, uint16 InstanceNum);
CFE_SB_MsgId_Atom_t CFE_SB_GlobalCmdTopicIdToMsgId(uint16 TopicId);
CFE_SB_MsgId_Atom_t CFE_SB_GlobalTlmTopicIdToMsgId(uint16 TopicId);
bool CFE_SB_IsValidMsgId(CFE_SB_MsgId_t MsgId);
CFE_SB_MsgId_Atom_t CFE_SB_LocalCmdTopicIdToMsgId(uint16 TopicId);
CFE_SB_MsgId_Atom_t CFE_SB_LocalTlmTopicIdToMsgId(uint16 TopicId);
CFE_SB_MsgId_Atom_t CFE_SB_TlmTopicIdToMsgId(uint16 TopicId, uint16 InstanceNum);
static inline bool CFE_SB_MsgId_Equal(CFE_SB_MsgId_t one, CFE_SB_MsgId_t other)
{
    return one.Value == other.Value;
}
static inline CFE_SB_MsgId_Atom_t CFE_SB_MsgIdToValue(CFE_SB_MsgId_t mid)
{
    return mid.Value;
}
static inline CFE_SB_MsgId_t CFE_SB_ValueToMsgId(CFE_SB_MsgId_Atom_t value)
{
    CFE_SB_MsgId_t mid = CFE_SB_MSGID_WRAP_VALUE(value);
    return mid;
}

/* ---- pipes ---- */
#define CFE_SB_PIPEID_C(value) ((CFE_SB_PipeId_t)CFE_RESOURCEID_WRAP(value))
#define CFE_SB_INVALID_PIPE    CFE_SB_PIPEID_C(CFE_RESOURCEID_UNDEFINED)
CFE_Status_t CFE_SB_CreatePipe(CFE_SB_PipeId_t *PipeIdPtr, uint16 Depth, const char *PipeName);
CFE_Status_t CFE_SB_DeletePipe(CFE_SB_PipeId_t PipeId);
CFE_Status_t CFE_SB_GetPipeIdByName(CFE_SB_PipeId_t *PipeIdPtr, const char *PipeName);
CFE_Status_t CFE_SB_GetPipeName(char *PipeNameBuf, size_t PipeNameSize, CFE_SB_PipeId_t PipeId);
CFE_Status_t CFE_SB_GetPipeOpts(CFE_SB_PipeId_t PipeId, uint8 *OptsPtr);
CFE_Status_t CFE_SB_PipeId_ToIndex(CFE_SB_PipeId_t PipeID, uint32 *Idx);
CFE_Status_t CFE_SB_SetPipeOpts(CFE_SB_PipeId_t PipeId, uint8 Opts);

/* ---- subscriptions ---- */
CFE_Status_t CFE_SB_Subscribe(CFE_SB_MsgId_t MsgId, CFE_SB_PipeId_t PipeId);
CFE_Status_t CFE_SB_SubscribeEx(CFE_SB_MsgId_t MsgId, CFE_SB_PipeId_t PipeId, CFE_SB_Qos_t Quality, uint16 MsgLim);
CFE_Status_t CFE_SB_SubscribeLocal(CFE_SB_MsgId_t MsgId, CFE_SB_PipeId_t PipeId, uint16 MsgLim);
CFE_Status_t CFE_SB_Unsubscribe(CFE_SB_MsgId_t MsgId, CFE_SB_PipeId_t PipeId);
CFE_Status_t CFE_SB_UnsubscribeLocal(CFE_SB_MsgId_t MsgId, CFE_SB_PipeId_t PipeId);

/* ---- messages ---- */
CFE_SB_Buffer_t *CFE_SB_AllocateMessageBuffer(size_t MsgSize);
void *CFE_SB_GetUserData(CFE_MSG_Message_t *MsgPtr);
size_t CFE_SB_GetUserDataLength(const CFE_MSG_Message_t *MsgPtr);
int32 CFE_SB_MessageStringGet(char *DestStringPtr, const char *SourceStringPtr, const char *DefaultString,
    size_t DestMaxSize, size_t SourceMaxSize);
int32 CFE_SB_MessageStringSet(char *DestStringPtr, const char *SourceStringPtr, size_t DestMaxSize,
    size_t SourceMaxSize);
CFE_Status_t CFE_SB_ReceiveBuffer(CFE_SB_Buffer_t **BufPtr, CFE_SB_PipeId_t PipeId, int32 TimeOut);
CFE_Status_t CFE_SB_ReleaseMessageBuffer(CFE_SB_Buffer_t *BufPtr);
void CFE_SB_SetUserDataLength(CFE_MSG_Message_t *MsgPtr, size_t DataLength);
void CFE_SB_TimeStampMsg(CFE_MSG_Message_t *MsgPtr);
CFE_Status_t CFE_SB_TransmitBuffer(CFE_SB_Buffer_t *BufPtr, bool IsOrigination);
CFE_Status_t CFE_SB_TransmitMsg(const CFE_MSG_Message_t *MsgPtr, bool IsOrigination);

/* ---- bits ---- */
#define CFE_BIT(number)        (1 << (number))
#define CFE_SET(word, number)  ((word) |= CFE_BIT(number))
#define CFE_CLR(word, number)  ((word) &= ~CFE_BIT(number))
#define CFE_TST(word, number)  (((word) & CFE_BIT(number)) != 0)

CFEPY_C_END

#endif
