/* CFE_TBL: tables. */
#ifndef CFEPY_TBL_H
#define CFEPY_TBL_H

#include "es.h"
#include "fs.h"
#include "sb.h"

CFEPY_C_BEGIN

enum CFE_TBL_BufferSelect { CFE_TBL_BufferSelect_INACTIVE = 0, CFE_TBL_BufferSelect_ACTIVE = 1 };
typedef uint16 CFE_TBL_BufferSelect_Enum_t;

typedef struct CFE_TBL_File_Hdr {
    uint32 Reserved, Offset, NumBytes;
    char TableName[40];
} CFE_TBL_File_Hdr_t;

typedef struct CFE_TBL_CombinedFileHdr {
    CFE_FS_Header_t Std;
    CFE_TBL_File_Hdr_t Tbl;
} CFE_TBL_CombinedFileHdr_t;

typedef CFE_ResourceId_t CFE_TBL_RegId_t;
typedef CFE_ResourceId_t CFE_TBL_HandleId_t;
typedef int32 (*CFE_TBL_CallbackFuncPtr_t)(void *TblPtr);
typedef enum CFE_TBL_SrcEnum { CFE_TBL_SRC_FILE = 0, CFE_TBL_SRC_ADDRESS } CFE_TBL_SrcEnum_t;

typedef struct CFE_TBL_Info {
    size_t Size;
    uint32 NumUsers;
    CFE_TIME_SysTime_t FileTime;
    uint32 Crc;
    CFE_TIME_SysTime_t TimeOfLastUpdate;
    bool TableLoadedOnce, DumpOnly, DoubleBuffered, UserDefAddr, Critical;
    char LastFileLoaded[CFE_MISSION_MAX_PATH_LEN];
} CFE_TBL_Info_t;

#define CFE_TBL_OPT_DEFAULT      0
#define CFE_TBL_OPT_LOAD_DUMP    0x0
#define CFE_TBL_OPT_NOT_CRITICAL 0x0
#define CFE_TBL_OPT_NOT_USR_DEF  0x0
#define CFE_TBL_OPT_SNGL_BUFFER  0x0
#define CFE_TBL_OPT_BUFFER_MSK   0x1
#define CFE_TBL_OPT_DBL_BUFFER   0x1
#define CFE_TBL_OPT_DUMP_ONLY    0x2
#define CFE_TBL_OPT_LD_DMP_MSK   0x2
#define CFE_TBL_OPT_USR_DEF_MSK  0x4
#define CFE_TBL_OPT_USR_DEF_ADDR 0x6
#define CFE_TBL_OPT_CRITICAL     0x8
#define CFE_TBL_OPT_CRITICAL_MSK 0x8
#define CFE_TBL_MAX_FULL_NAME_LEN CFE_MISSION_TBL_MAX_FULL_NAME_LEN

#define CFE_TBL_REGID_C(value)    ((CFE_TBL_RegId_t)CFE_RESOURCEID_WRAP(value))
#define CFE_TBL_REGID_UNDEFINED   CFE_TBL_REGID_C(CFE_RESOURCEID_UNDEFINED)
#define CFE_TBL_HANDLEID_C(value) ((CFE_TBL_HandleId_t)CFE_RESOURCEID_WRAP(value))
#define CFE_TBL_HANDLEID_UNDEFINED CFE_TBL_HANDLEID_C(CFE_RESOURCEID_UNDEFINED)
static inline bool CFE_TBL_HandleID_IsEqual(CFE_TBL_HandleId_t one, CFE_TBL_HandleId_t other)
{
    return CFE_ResourceId_Equal(one, other);
}
static inline unsigned long CFE_TBL_HandleID_AsInt(CFE_TBL_HandleId_t id)
{
    return CFE_ResourceId_ToInteger(id);
}
static inline bool CFE_TBL_HandleID_IsDefined(CFE_TBL_HandleId_t id)
{
    return CFE_ResourceId_IsDefined(id);
}

/* A handle is an index of 16 bits, and an id of 32 bits where deprecated names are left out: the macros go with both. */
#ifdef CFE_OMIT_DEPRECATED_6_8
typedef CFE_TBL_HandleId_t CFE_TBL_Handle_t;
#define CFE_TBL_BAD_TABLE_HANDLE       CFE_TBL_HANDLEID_UNDEFINED
#define CFE_TBL_HANDLE_EQ(one, other)  CFE_TBL_HandleID_IsEqual(one, other)
#define CFE_TBL_HANDLE_INT(handle)     CFE_TBL_HandleID_AsInt(handle)
#define CFE_TBL_HANDLE_IS_VALID(handle) CFE_TBL_HandleID_IsDefined(handle)
#else
typedef int16 CFE_TBL_Handle_t;
#define CFE_TBL_BAD_TABLE_HANDLE       ((CFE_TBL_Handle_t)(-1))
#define CFE_TBL_HANDLE_EQ(one, other)  ((one) == (other))
#define CFE_TBL_HANDLE_INT(handle)     ((unsigned long)(handle))
#define CFE_TBL_HANDLE_IS_VALID(handle) ((handle) != CFE_TBL_BAD_TABLE_HANDLE)
#endif
CFE_TBL_Handle_t CFE_TBL_HandleFromID(CFE_TBL_HandleId_t TblId);
CFE_TBL_HandleId_t CFE_TBL_HandleToID(CFE_TBL_Handle_t TblHandle);

/* ---- registration ---- */
CFE_Status_t CFE_TBL_NotifyByMessage(CFE_TBL_Handle_t TblHandle, CFE_SB_MsgId_t MsgId, CFE_MSG_FcnCode_t CommandCode,
    uint32 Parameter);
CFE_Status_t CFE_TBL_Register(CFE_TBL_Handle_t *TblHandlePtr, const char *Name, size_t Size, uint16 TblOptionFlags,
    CFE_TBL_CallbackFuncPtr_t TblValidationFuncPtr);
CFE_Status_t CFE_TBL_Share(CFE_TBL_Handle_t *TblHandlePtr, const char *TblName);
CFE_Status_t CFE_TBL_Unregister(CFE_TBL_Handle_t TblHandle);

/* ---- contents ---- */
CFE_Status_t CFE_TBL_DumpToBuffer(CFE_TBL_Handle_t TblHandle);
CFE_Status_t CFE_TBL_Load(CFE_TBL_Handle_t TblHandle, CFE_TBL_SrcEnum_t SrcType, const void *SrcDataPtr);
CFE_Status_t CFE_TBL_Manage(CFE_TBL_Handle_t TblHandle);
CFE_Status_t CFE_TBL_Modified(CFE_TBL_Handle_t TblHandle);
CFE_Status_t CFE_TBL_Update(CFE_TBL_Handle_t TblHandle);
CFE_Status_t CFE_TBL_Validate(CFE_TBL_Handle_t TblHandle);
CFE_Status_t CFE_TBL_GetAddress(void **TblPtr, CFE_TBL_Handle_t TblHandle);
CFE_Status_t CFE_TBL_GetAddresses(void **TblPtrs[], uint16 NumTables, const CFE_TBL_Handle_t TblHandles[]);
CFE_Status_t CFE_TBL_ReleaseAddress(CFE_TBL_Handle_t TblHandle);
CFE_Status_t CFE_TBL_ReleaseAddresses(uint16 NumTables, const CFE_TBL_Handle_t TblHandles[]);
CFE_Status_t CFE_TBL_GetInfo(CFE_TBL_Info_t *TblInfoPtr, const char *TblName);
CFE_Status_t CFE_TBL_GetStatus(CFE_TBL_Handle_t TblHandle);

/* ---- source files of tables ---- */
typedef struct CFE_TBL_FileDef {
    char ObjectName[CFE_MISSION_MAX_PATH_LEN], TableName[40], Description[32], TgtFilename[CFE_MISSION_MAX_API_LEN];
    uint32 ObjectSize;
} CFE_TBL_FileDef_t;

/* With a NUL of its own, a text that fills its field to the last byte is one too long, and the compiler says so. */
#define CFE_TBL_FILEDEF(Object, Table, Text, File) \
    CFE_TBL_FileDef_t CFE_TBL_FileDef = {#Object "\0", #Table "\0", #Text "\0", #File "\0", sizeof(Object)};

CFEPY_C_END

#endif
