/* CFE_Config: settings and versions by id and name. */
#ifndef CFEPY_SETTINGS_H
#define CFEPY_SETTINGS_H

#include "config_ids.h"
#include "ids.h"

CFEPY_C_BEGIN

typedef CFE_ResourceId_t CFE_ConfigId_t;
typedef void (*CFE_Config_Callback_t)(void *Arg, CFE_ConfigId_t Id, const char *Name);

typedef struct CFE_Config_ArrayValue {
    size_t NumElements;
    const void *ElementPtr;
} CFE_Config_ArrayValue_t;

#define CFE_CONFIGID_C(value)   ((CFE_ConfigId_t)CFE_RESOURCEID_WRAP(value))
#define CFE_CONFIGID_UNDEFINED  CFE_CONFIGID_C(CFE_RESOURCEID_UNDEFINED)
CFE_Config_ArrayValue_t CFE_Config_GetArrayValue(CFE_ConfigId_t ConfigId);
CFE_ConfigId_t CFE_Config_GetIdByName(const char *Name);
const char *CFE_Config_GetName(CFE_ConfigId_t ConfigId);
const void *CFE_Config_GetObjPointer(CFE_ConfigId_t ConfigId);
const char *CFE_Config_GetString(CFE_ConfigId_t ConfigId);
uint32 CFE_Config_GetValue(CFE_ConfigId_t ConfigId);
void CFE_Config_GetVersionString(char *Buf, size_t Size, const char *Component, const char *SrcVersion,
    const char *CodeName, const char *LastOffcRel);
void CFE_Config_IterateAll(void *Arg, CFE_Config_Callback_t Callback);

CFEPY_C_END

#endif
