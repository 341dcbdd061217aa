/* CFE_FS: headers of files, names of files, files that are written in the background. */
#ifndef CFEPY_FS_H
#define CFEPY_FS_H

#include "status.h"
#include "time.h"

CFEPY_C_BEGIN

enum CFE_FS_SubType {
    CFE_FS_SubType_ES_ERLOG = 1, CFE_FS_SubType_ES_SYSLOG = 2, CFE_FS_SubType_ES_QUERYALL = 3,
    CFE_FS_SubType_ES_PERFDATA = 4, CFE_FS_SubType_ES_CDS_REG = 6, CFE_FS_SubType_TBL_REG = 9,
    CFE_FS_SubType_TBL_IMG = 8, CFE_FS_SubType_EVS_APPDATA = 15, CFE_FS_SubType_EVS_EVENTLOG = 16,
    CFE_FS_SubType_SB_PIPEDATA = 20, CFE_FS_SubType_SB_ROUTEDATA = 21, CFE_FS_SubType_SB_MAPDATA = 22,
    CFE_FS_SubType_ES_QUERYALLTASKS = 23
};

typedef uint32 CFE_FS_SubType_Enum_t;

typedef struct CFE_FS_Header {
    uint32 ContentType, SubType, Length, SpacecraftID, ProcessorID, ApplicationID, TimeSeconds, TimeSubSeconds;
    char Description[32];
} CFE_FS_Header_t;

typedef enum {
    CFE_FS_FileCategory_UNKNOWN, CFE_FS_FileCategory_DYNAMIC_MODULE, CFE_FS_FileCategory_BINARY_DATA_DUMP,
    CFE_FS_FileCategory_TEXT_LOG, CFE_FS_FileCategory_SCRIPT, CFE_FS_FileCategory_TEMP, CFE_FS_FileCategory_MAX
} CFE_FS_FileCategory_t;

typedef enum {
    CFE_FS_FileWriteEvent_UNDEFINED, CFE_FS_FileWriteEvent_COMPLETE, CFE_FS_FileWriteEvent_CREATE_ERROR,
    CFE_FS_FileWriteEvent_HEADER_WRITE_ERROR, CFE_FS_FileWriteEvent_RECORD_WRITE_ERROR, CFE_FS_FileWriteEvent_MAX
} CFE_FS_FileWriteEvent_t;

typedef bool (*CFE_FS_FileWriteGetData_t)(void *Meta, uint32 RecordNum, void **Buffer, size_t *BufSize);
typedef void (*CFE_FS_FileWriteOnEvent_t)(void *Meta, CFE_FS_FileWriteEvent_t Event, int32 Status, uint32 RecordNum,
    size_t BlockSize, size_t Position);

typedef struct CFE_FS_FileWriteMetaData {
    volatile bool IsPending;
    char FileName[CFE_MISSION_MAX_PATH_LEN];
    uint32 FileSubType;
    char Description[32];
    CFE_FS_FileWriteGetData_t GetData;
    CFE_FS_FileWriteOnEvent_t OnEvent;
} CFE_FS_FileWriteMetaData_t;

void CFE_FS_InitHeader(CFE_FS_Header_t *Hdr, const char *Description, uint32 SubType);
CFE_Status_t CFE_FS_ReadHeader(CFE_FS_Header_t *Hdr, osal_id_t FileDes);
CFE_Status_t CFE_FS_WriteHeader(osal_id_t FileDes, CFE_FS_Header_t *Hdr);
bool CFE_FS_BackgroundFileDumpIsPending(const CFE_FS_FileWriteMetaData_t *Meta);
int32 CFE_FS_BackgroundFileDumpRequest(CFE_FS_FileWriteMetaData_t *Meta);
CFE_Status_t CFE_FS_ExtractFilenameFromPath(const char *OriginalPath, char *FileNameOnly);
const char *CFE_FS_GetDefaultExtension(CFE_FS_FileCategory_t FileCategory);
const char *CFE_FS_GetDefaultMountPoint(CFE_FS_FileCategory_t FileCategory);
int32 CFE_FS_ParseInputFileName(char *OutputBuffer, const char *InputName, size_t OutputBufSize,
    CFE_FS_FileCategory_t FileCategory);
int32 CFE_FS_ParseInputFileNameEx(char *OutputBuffer, const char *InputBuffer, size_t OutputBufSize,
    size_t InputBufSize, const char *DefaultInput, const char *DefaultPath, const char *DefaultExtension);
CFE_Status_t CFE_FS_SetTimestamp(osal_id_t FileDes, CFE_TIME_SysTime_t NewTimestamp);

CFEPY_C_END

#endif
