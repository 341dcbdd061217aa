/* CFE_MSG: headers of messages, and functions that look into them. */
#ifndef CFEPY_MSG_H
#define CFEPY_MSG_H

#include "ids.h"
#include "time.h"

CFEPY_C_BEGIN

typedef uint32 CFE_SB_MsgId_Atom_t;

typedef struct {
    CFE_SB_MsgId_Atom_t Value;
} CFE_SB_MsgId_t;

typedef size_t CFE_MSG_Size_t;
typedef uint32 CFE_MSG_Checksum_t;
typedef uint16 CFE_MSG_FcnCode_t;
typedef uint16 CFE_MSG_HeaderVersion_t;
typedef uint16 CFE_MSG_ApId_t;
typedef uint16 CFE_MSG_SequenceCount_t;
typedef uint16 CFE_MSG_EDSVersion_t;
typedef uint16 CFE_MSG_Subsystem_t;
typedef uint16 CFE_MSG_System_t;
typedef enum CFE_MSG_Type { CFE_MSG_Type_Invalid, CFE_MSG_Type_Cmd, CFE_MSG_Type_Tlm } CFE_MSG_Type_t;

typedef enum CFE_MSG_SegmentationFlag {
    CFE_MSG_SegFlag_Invalid, CFE_MSG_SegFlag_Continue, CFE_MSG_SegFlag_First, CFE_MSG_SegFlag_Last,
    CFE_MSG_SegFlag_Unsegmented
} CFE_MSG_SegmentationFlag_t;

typedef enum CFE_MSG_Endian { CFE_MSG_Endian_Invalid, CFE_MSG_Endian_Big, CFE_MSG_Endian_Little } CFE_MSG_Endian_t;

typedef enum CFE_MSG_PlaybackFlag {
    CFE_MSG_PlayFlag_Invalid, CFE_MSG_PlayFlag_Original, CFE_MSG_PlayFlag_Playback
} CFE_MSG_PlaybackFlag_t;

typedef struct CFE_MSG_Message CFE_MSG_Message_t;
typedef struct CFE_MSG_CommandHeader CFE_MSG_CommandHeader_t;
typedef struct CFE_MSG_TelemetryHeader CFE_MSG_TelemetryHeader_t;

typedef struct CCSDS_PrimaryHeader {
    uint8 StreamId[2], Sequence[2], Length[2];
} CCSDS_PrimaryHeader_t;

typedef struct CCSDS_ExtendedHeader {
    uint8 Subsystem[2], SystemId[2];
} CCSDS_ExtendedHeader_t;

typedef struct {
    uint8 FunctionCode, Checksum;
} CFE_MSG_CommandSecondaryHeader_t;

typedef struct {
    uint8 Time[6];
} CFE_MSG_TelemetrySecondaryHeader_t;

typedef struct {
    CCSDS_PrimaryHeader_t Pri;
} CCSDS_SpacePacket_t;

struct CFE_MSG_Message {
    CCSDS_SpacePacket_t CCSDS;
};

struct CFE_MSG_CommandHeader {
    CFE_MSG_Message_t Msg;
    CFE_MSG_CommandSecondaryHeader_t Sec;
};

struct CFE_MSG_TelemetryHeader {
    CFE_MSG_Message_t Msg;
    CFE_MSG_TelemetrySecondaryHeader_t Sec;
    uint8 Spare[4];
};

#define CFE_MSG_BAD_ARGUMENT    CFE_STATUS_C(0xca000003)
#define CFE_MSG_WRONG_MSG_TYPE  CFE_STATUS_C(0xca00000d)
#define CFE_MSG_NOT_IMPLEMENTED CFE_STATUS_C(0xca00ffff)

/* The header inside a structure that begins with one, and a command's header as an initialiser. */
#define CFE_MSG_PTR(header) (&((header).Msg))
#define CFE_MSG_CMD_HDR_SEC_INIT(code, checksum) .Sec = {.FunctionCode = (code), .Checksum = (checksum)}
#define CFE_MSG_CMD_HDR_INIT(mid, size, code, checksum)                                \
    {                                                                                  \
        .Msg.CCSDS.Pri = {.StreamId = {((mid) >> 8) & 0xFF, (mid)&0xFF},               \
                          .Sequence = {0xC0, 0},                                       \
                          .Length   = {((size)-7) >> 8, ((size)-7) & 0xFF}},           \
        CFE_MSG_CMD_HDR_SEC_INIT(code, checksum)                                       \
    }

CFE_MSG_SequenceCount_t CFE_MSG_GetNextSequenceCount(CFE_MSG_SequenceCount_t SeqCnt);
CFE_Status_t CFE_MSG_GetTypeFromMsgId(CFE_SB_MsgId_t MsgId, CFE_MSG_Type_t *Type);
CFE_Status_t CFE_MSG_Init(CFE_MSG_Message_t *MsgPtr, CFE_SB_MsgId_t MsgId, CFE_MSG_Size_t Size);
CFE_Status_t CFE_MSG_OriginationAction(CFE_MSG_Message_t *MsgPtr, size_t BufferSize, bool *IsAcceptable);
CFE_Status_t CFE_MSG_VerificationAction(const CFE_MSG_Message_t *MsgPtr, size_t BufferSize, bool *IsAcceptable);
CFE_Status_t CFE_MSG_GetApId(const CFE_MSG_Message_t *MsgPtr, CFE_MSG_ApId_t *ApId);
CFE_Status_t CFE_MSG_GetEDSVersion(const CFE_MSG_Message_t *MsgPtr, CFE_MSG_EDSVersion_t *Version);
CFE_Status_t CFE_MSG_GetEndian(const CFE_MSG_Message_t *MsgPtr, CFE_MSG_Endian_t *Endian);
CFE_Status_t CFE_MSG_GetFcnCode(const CFE_MSG_Message_t *MsgPtr, CFE_MSG_FcnCode_t *FcnCode);
CFE_Status_t CFE_MSG_GetHasSecondaryHeader(const CFE_MSG_Message_t *MsgPtr, bool *HasSecondary);
CFE_Status_t CFE_MSG_GetHeaderVersion(const CFE_MSG_Message_t *MsgPtr, CFE_MSG_HeaderVersion_t *Version);
CFE_Status_t CFE_MSG_GetMsgId(const CFE_MSG_Message_t *MsgPtr, CFE_SB_MsgId_t *MsgId);
CFE_Status_t CFE_MSG_GetMsgTime(const CFE_MSG_Message_t *MsgPtr, CFE_TIME_SysTime_t *Time);
CFE_Status_t CFE_MSG_GetPlaybackFlag(const CFE_MSG_Message_t *MsgPtr, CFE_MSG_PlaybackFlag_t *PlayFlag);
CFE_Status_t CFE_MSG_GetSegmentationFlag(const CFE_MSG_Message_t *MsgPtr, CFE_MSG_SegmentationFlag_t *SegFlag);
CFE_Status_t CFE_MSG_GetSequenceCount(const CFE_MSG_Message_t *MsgPtr, CFE_MSG_SequenceCount_t *SeqCnt);
CFE_Status_t CFE_MSG_GetSize(const CFE_MSG_Message_t *MsgPtr, CFE_MSG_Size_t *Size);
CFE_Status_t CFE_MSG_GetSubsystem(const CFE_MSG_Message_t *MsgPtr, CFE_MSG_Subsystem_t *Subsystem);
CFE_Status_t CFE_MSG_GetSystem(const CFE_MSG_Message_t *MsgPtr, CFE_MSG_System_t *System);
CFE_Status_t CFE_MSG_GetType(const CFE_MSG_Message_t *MsgPtr, CFE_MSG_Type_t *Type);
CFE_Status_t CFE_MSG_SetApId(CFE_MSG_Message_t *MsgPtr, CFE_MSG_ApId_t ApId);
CFE_Status_t CFE_MSG_SetEDSVersion(CFE_MSG_Message_t *MsgPtr, CFE_MSG_EDSVersion_t Version);
CFE_Status_t CFE_MSG_SetEndian(CFE_MSG_Message_t *MsgPtr, CFE_MSG_Endian_t Endian);
CFE_Status_t CFE_MSG_SetFcnCode(CFE_MSG_Message_t *MsgPtr, CFE_MSG_FcnCode_t FcnCode);
CFE_Status_t CFE_MSG_SetHasSecondaryHeader(CFE_MSG_Message_t *MsgPtr, bool HasSecondary);
CFE_Status_t CFE_MSG_SetHeaderVersion(CFE_MSG_Message_t *MsgPtr, CFE_MSG_HeaderVersion_t Version);
CFE_Status_t CFE_MSG_SetMsgId(CFE_MSG_Message_t *MsgPtr, CFE_SB_MsgId_t MsgId);
CFE_Status_t CFE_MSG_SetMsgTime(CFE_MSG_Message_t *MsgPtr, CFE_TIME_SysTime_t NewTime);
CFE_Status_t CFE_MSG_SetPlaybackFlag(CFE_MSG_Message_t *MsgPtr, CFE_MSG_PlaybackFlag_t PlayFlag);
CFE_Status_t CFE_MSG_SetSegmentationFlag(CFE_MSG_Message_t *MsgPtr, CFE_MSG_SegmentationFlag_t SegFlag);
CFE_Status_t CFE_MSG_SetSequenceCount(CFE_MSG_Message_t *MsgPtr, CFE_MSG_SequenceCount_t SeqCnt);
CFE_Status_t CFE_MSG_SetSize(CFE_MSG_Message_t *MsgPtr, CFE_MSG_Size_t Size);
CFE_Status_t CFE_MSG_SetSubsystem(CFE_MSG_Message_t *MsgPtr, CFE_MSG_Subsystem_t Subsystem);
CFE_Status_t CFE_MSG_SetSystem(CFE_MSG_Message_t *MsgPtr, CFE_MSG_System_t System);
CFE_Status_t CFE_MSG_SetType(CFE_MSG_Message_t *MsgPtr, CFE_MSG_Type_t Type);
CFE_Status_t CFE_MSG_GenerateChecksum(CFE_MSG_Message_t *MsgPtr);
CFE_Status_t CFE_MSG_ValidateChecksum(const CFE_MSG_Message_t *MsgPtr, bool *IsValid);

CFEPY_C_END

#endif
