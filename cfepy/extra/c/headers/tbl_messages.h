/* Commands and telemetry of CFE_TBL: function codes, payloads, packets. */
#ifndef CFEPY_TBL_MESSAGES_H
#define CFEPY_TBL_MESSAGES_H

#include "message_kinds.h"

CFEPY_C_BEGIN

enum CFE_TBL_FunctionCode_ {
    CFE_TBL_FunctionCode_NOOP = 0, CFE_TBL_FunctionCode_RESET_COUNTERS = 1, CFE_TBL_FunctionCode_LOAD = 2,
    CFE_TBL_FunctionCode_DUMP = 3, CFE_TBL_FunctionCode_VALIDATE = 4, CFE_TBL_FunctionCode_ACTIVATE = 5,
    CFE_TBL_FunctionCode_DUMP_REGISTRY = 6, CFE_TBL_FunctionCode_SEND_REGISTRY = 7,
    CFE_TBL_FunctionCode_DELETE_CDS = 8, CFE_TBL_FunctionCode_ABORT_LOAD = 9
};

#define CFE_TBL_NOOP_CC           0
#define CFE_TBL_RESET_COUNTERS_CC 1
#define CFE_TBL_LOAD_CC           2
#define CFE_TBL_DUMP_CC           3
#define CFE_TBL_VALIDATE_CC       4
#define CFE_TBL_ACTIVATE_CC       5
#define CFE_TBL_DUMP_REGISTRY_CC  6
#define CFE_TBL_SEND_REGISTRY_CC  7
#define CFE_TBL_DELETE_CDS_CC     8
#define CFE_TBL_ABORT_LOAD_CC     9

typedef struct CFE_TBL_LoadCmd_Payload {
    char LoadFilename[CFE_MISSION_MAX_PATH_LEN];
} CFE_TBL_LoadCmd_Payload_t;

typedef struct CFE_TBL_DumpCmd_Payload {
    CFE_TBL_BufferSelect_Enum_t ActiveTableFlag;
    char TableName[40], DumpFilename[CFE_MISSION_MAX_PATH_LEN];
} CFE_TBL_DumpCmd_Payload_t;

typedef struct CFE_TBL_ValidateCmd_Payload {
    CFE_TBL_BufferSelect_Enum_t ActiveTableFlag;
    char TableName[40];
} CFE_TBL_ValidateCmd_Payload_t;

typedef struct CFE_TBL_ActivateCmd_Payload {
    char TableName[40];
} CFE_TBL_ActivateCmd_Payload_t;

typedef struct CFE_TBL_DumpRegistryCmd_Payload {
    char DumpFilename[CFE_MISSION_MAX_PATH_LEN];
} CFE_TBL_DumpRegistryCmd_Payload_t;

typedef struct CFE_TBL_SendRegistryCmd_Payload {
    char TableName[40];
} CFE_TBL_SendRegistryCmd_Payload_t;

typedef struct CFE_TBL_DelCDSCmd_Payload {
    char TableName[40];
} CFE_TBL_DelCDSCmd_Payload_t;

typedef struct CFE_TBL_AbortLoadCmd_Payload {
    char TableName[40];
} CFE_TBL_AbortLoadCmd_Payload_t;

typedef struct CFE_TBL_NotifyCmd_Payload {
    uint32 Parameter;
} CFE_TBL_NotifyCmd_Payload_t;

typedef struct CFE_TBL_HousekeepingTlm_Payload {
    uint8 CommandCounter, CommandErrorCounter;
    uint16 NumTables, NumLoadPending, ValidationCounter;
    uint32 LastValCrc;
    int32 LastValStatus;
    bool ActiveBuffer;
    char LastValTableName[40];
    uint8 SuccessValCounter, FailedValCounter, NumValRequests, NumFreeSharedBufs, ByteAlignPad1;
    CFE_ES_MemHandle_t MemPoolHandle;
    CFE_TIME_SysTime_t LastUpdateTime;
    char LastUpdatedTable[40], LastFileLoaded[CFE_MISSION_MAX_PATH_LEN], LastFileDumped[CFE_MISSION_MAX_PATH_LEN],
        LastTableLoaded[40];
} CFE_TBL_HousekeepingTlm_Payload_t;

typedef struct CFE_TBL_TblRegPacket_Payload {
    CFE_ES_MemOffset_t Size;
    uint32 Crc;
    CFE_ES_MemAddress_t ActiveBufferAddr, InactiveBufferAddr, ValidationFuncPtr;
    CFE_TIME_SysTime_t TimeOfLastUpdate, FileTime;
    bool TableLoadedOnce, LoadPending, DumpOnly, DoubleBuffered;
    char Name[40], LastFileLoaded[CFE_MISSION_MAX_PATH_LEN], OwnerAppName[CFE_MISSION_MAX_API_LEN];
    bool Critical;
    uint8 ByteAlign4;
} CFE_TBL_TblRegPacket_Payload_t;


CFEPY_COMMAND(CFE_TBL_NoopCmd);
CFEPY_COMMAND(CFE_TBL_ResetCountersCmd);
CFEPY_COMMAND(CFE_TBL_SendHkCmd);
CFEPY_COMMAND_WITH(CFE_TBL_LoadCmd, CFE_TBL_LoadCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_TBL_DumpCmd, CFE_TBL_DumpCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_TBL_ValidateCmd, CFE_TBL_ValidateCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_TBL_ActivateCmd, CFE_TBL_ActivateCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_TBL_DumpRegistryCmd, CFE_TBL_DumpRegistryCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_TBL_SendRegistryCmd, CFE_TBL_SendRegistryCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_TBL_DeleteCDSCmd, CFE_TBL_DelCDSCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_TBL_AbortLoadCmd, CFE_TBL_AbortLoadCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_TBL_NotifyCmd, CFE_TBL_NotifyCmd_Payload_t);
CFEPY_TELEMETRY(CFE_TBL_HousekeepingTlm, CFE_TBL_HousekeepingTlm_Payload_t);
CFEPY_TELEMETRY(CFE_TBL_TableRegistryTlm, CFE_TBL_TblRegPacket_Payload_t);

CFEPY_C_END

#endif
