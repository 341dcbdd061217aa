/* cFE 6: OSAL 4.2 and 5.0, on OSAL 7. Ids stay numbers of 32 bits; a file's descriptor is its id. */
#ifndef CFEPY_CFE6_OSAL_H
#define CFEPY_CFE6_OSAL_H

#include <sys/stat.h>

#include "cfe6_headers.h"
#include "osal_files.h"

/* ---- status codes ---- */
#define OS_FS_SUCCESS             OS_SUCCESS
#define OS_FS_ERROR               OS_ERROR
#define OS_FS_ERR_INVALID_POINTER OS_INVALID_POINTER
#define OS_FS_ERR_NO_FREE_FDS     OS_ERR_NO_FREE_IDS
#define OS_FS_ERR_INVALID_FD      OS_ERR_INVALID_ID
#define OS_FS_UNIMPLEMENTED       OS_ERR_NOT_IMPLEMENTED
#define CFE_OS_ERROR              OS_ERROR
#define CFE_OS_INVALID_POINTER    OS_INVALID_POINTER
#define CFE_OS_QUEUE_EMPTY        OS_QUEUE_EMPTY
#define CFE_OS_QUEUE_FULL         OS_QUEUE_FULL
#define CFE_OS_QUEUE_TIMEOUT      OS_QUEUE_TIMEOUT
#define CFE_OS_SEM_FAILURE        OS_SEM_FAILURE
#define CFE_OS_SEM_TIMEOUT        OS_SEM_TIMEOUT
#define CFE_OS_ERR_NAME_TAKEN     OS_ERR_NAME_TAKEN
#define CFE_OS_ERR_NAME_NOT_FOUND OS_ERR_NAME_NOT_FOUND
#define CFE_OS_ERR_INVALID_ID     OS_ERR_INVALID_ID
#define CFE_OS_ERR_NO_FREE_IDS    OS_ERR_NO_FREE_IDS
typedef os_err_name_t os_fs_err_name_t;
typedef int32 os_fshealth_t;
typedef OS_file_prop_t OS_FDTableEntry;

/* ---- tasks, queues, interrupts ---- */
#define OS_TaskRegister()  CFEPY_6_Status(OS_SUCCESS)
#define OS_IntLock()       CFEPY_6_Status(OS_ERR_NOT_IMPLEMENTED)
#define OS_IntUnlock(x)    CFEPY_6_Status(OS_ERR_NOT_IMPLEMENTED + 0 * (x))
#define OS_IntEnable(x)    CFEPY_6_Status(OS_ERR_NOT_IMPLEMENTED + 0 * (x))
#define OS_IntDisable(x)   CFEPY_6_Status(OS_ERR_NOT_IMPLEMENTED + 0 * (x))
#define OS_Tick2Micros()   CFEPY_6_Status(10000)
#define OS_Milli2Ticks(ms) CFEPY_6_Status((int32)(((uint32)(ms)*1000 + 9999) / 10000))
#define OS_QueueGet(queue, data, size, copied, timeout)                                \
    ({                                                                                 \
        uint32 *cfepy_copied = (uint32 *)(copied);                                     \
        size_t cfepy_size = 0;                                                         \
        int32 cfepy_got = OS_QueueGet(queue, data, size, cfepy_copied ? &cfepy_size : NULL, timeout); \
        if (cfepy_copied) {                                                            \
            *cfepy_copied = (uint32)cfepy_size;                                        \
        }                                                                              \
        cfepy_got;                                                                     \
    })

/* ---- time: seconds and microseconds ---- */
typedef struct {
    uint32 seconds, microsecs;
} CFEPY_6_Time_t;
#define OS_GetLocalTime(time)                                                          \
    ({                                                                                 \
        CFEPY_6_Time_t *cfepy_time = (time);                                           \
        CFEPY_7_Time_t cfepy_now;                                                      \
        int32 cfepy_got = OS_GetLocalTime(cfepy_time ? &cfepy_now : NULL);             \
        if (cfepy_got == OS_SUCCESS) {                                                 \
            cfepy_time->seconds = (uint32)OS_TimeGetTotalSeconds(cfepy_now);           \
            cfepy_time->microsecs = OS_TimeGetMicrosecondsPart(cfepy_now);             \
        }                                                                              \
        cfepy_got;                                                                     \
    })
#define OS_SetLocalTime(time)                                                          \
    ({                                                                                 \
        const CFEPY_6_Time_t *cfepy_time = (time);                                     \
        CFEPY_7_Time_t cfepy_new = {0};                                                \
        if (cfepy_time) {                                                              \
            cfepy_new = OS_TimeAssembleFromMicroseconds(cfepy_time->seconds, cfepy_time->microsecs); \
        }                                                                              \
        OS_SetLocalTime(cfepy_time ? &cfepy_new : NULL);                               \
    })
typedef OS_time_t CFEPY_7_Time_t;
#define OS_time_t CFEPY_6_Time_t

/* ---- files ---- */
#define CFEPY_6_OPEN(path, access, flags)                                              \
    ({                                                                                 \
        osal_id_t cfepy_id = 0;                                                        \
        int32 cfepy_opened = OS_OpenCreate(&cfepy_id, path, flags, access);            \
        cfepy_opened < 0 ? cfepy_opened : (int32)cfepy_id;                             \
    })
#define OS_open(path, access, mode) ((void)(mode), CFEPY_6_OPEN(path, access, OS_FILE_FLAG_NONE))
#define OS_creat(path, access)      CFEPY_6_OPEN(path, access, OS_FILE_FLAG_CREATE | OS_FILE_FLAG_TRUNCATE)
#define OS_fsBlocksFree(name)                                                          \
    ({                                                                                 \
        OS_statvfs_t cfepy_volume;                                                     \
        int32 cfepy_got = OS_FileSysStatVolume(name, &cfepy_volume);                   \
        cfepy_got < 0 ? cfepy_got : (int32)cfepy_volume.blocks_free;                   \
    })
#define OS_fsBytesFree(name, bytes)                                                    \
    ({                                                                                 \
        OS_statvfs_t cfepy_volume;                                                     \
        int32 cfepy_got = OS_FileSysStatVolume(name, &cfepy_volume);                   \
        if (cfepy_got == OS_SUCCESS) {                                                 \
            *(bytes) = (uint64)cfepy_volume.blocks_free * cfepy_volume.block_size;     \
        }                                                                              \
        cfepy_got;                                                                     \
    })

/* What OS_stat tells: in OSAL 4.2 the structure of POSIX, in OSAL 5.0 one with whole seconds. */
typedef os_fstat_t CFEPY_7_Stat_t;
#if CFEPY_CFE_6 == 65
typedef struct stat CFEPY_6_Stat_t;
#define CFEPY_6_TELL(to, from)                                                         \
    ((to)->st_size = (off_t)(from).FileSize, (to)->st_mtime = (time_t)OS_TimeGetTotalSeconds((from).FileTime), \
     (to)->st_mode = (((from).FileModeBits & OS_FILESTAT_MODE_DIR) ? S_IFDIR : S_IFREG) | \
                     (((from).FileModeBits & OS_FILESTAT_MODE_READ) ? 0444 : 0) |      \
                     (((from).FileModeBits & OS_FILESTAT_MODE_WRITE) ? 0222 : 0) |     \
                     (((from).FileModeBits & OS_FILESTAT_MODE_EXEC) ? 0111 : 0))
#else
typedef struct {
    uint32 FileModeBits;
    int32 FileTime;
    uint32 FileSize;
} CFEPY_6_Stat_t;
#undef OS_FILESTAT_TIME
#define OS_FILESTAT_TIME(stat) ((stat).FileTime)
#define CFEPY_6_TELL(to, from)                                                         \
    ((to)->FileModeBits = (from).FileModeBits, (to)->FileSize = (uint32)(from).FileSize, \
     (to)->FileTime = (int32)OS_TimeGetTotalSeconds((from).FileTime))
#endif
#define OS_stat(path, result)                                                          \
    ({                                                                                 \
        CFEPY_6_Stat_t *cfepy_stat = (result);                                         \
        CFEPY_7_Stat_t cfepy_told;                                                     \
        int32 cfepy_got = OS_stat(path, cfepy_stat ? &cfepy_told : NULL);              \
        if (cfepy_got == OS_SUCCESS) {                                                 \
            memset(cfepy_stat, 0, sizeof(*cfepy_stat));                                \
            CFEPY_6_TELL(cfepy_stat, cfepy_told);                                      \
        }                                                                              \
        cfepy_got;                                                                     \
    })
#define os_fstat_t CFEPY_6_Stat_t

/* ---- folders: a pointer that is the id, and an entry for each source file that reads folders ---- */
#if CFEPY_CFE_6 == 65
typedef struct {
    char d_name[OS_MAX_PATH_LEN];
} CFEPY_6_Entry_t;
#undef OS_DIRENTRY_NAME
#define OS_DIRENTRY_NAME(entry) ((entry).d_name)
#else
typedef os_dirent_t CFEPY_6_Entry_t;
#endif
typedef void *os_dirp_t;
#define OS_opendir(path)                                                               \
    ({                                                                                 \
        osal_id_t cfepy_id = 0;                                                        \
        OS_DirectoryOpen(&cfepy_id, path) == OS_SUCCESS ? (os_dirp_t)(cpuaddr)cfepy_id : (os_dirp_t)NULL; \
    })
#define OS_readdir(folder)                                                             \
    ({                                                                                 \
        static CFEPY_6_Entry_t cfepy_entry;                                            \
        CFEPY_7_Entry_t cfepy_next;                                                    \
        CFEPY_6_Entry_t *cfepy_found = NULL;                                           \
        if (OS_DirectoryRead((osal_id_t)(cpuaddr)(folder), &cfepy_next) == OS_SUCCESS) { \
            memset(&cfepy_entry, 0, sizeof(cfepy_entry));                              \
            memcpy(&cfepy_entry, cfepy_next.FileName, sizeof(cfepy_next.FileName));    \
            cfepy_found = &cfepy_entry;                                                \
        }                                                                              \
        cfepy_found;                                                                   \
    })
#define OS_closedir(folder)  OS_DirectoryClose((osal_id_t)(cpuaddr)(folder))
#define OS_rewinddir(folder) ((void)OS_DirectoryRewind((osal_id_t)(cpuaddr)(folder)))
typedef os_dirent_t CFEPY_7_Entry_t;
#define os_dirent_t CFEPY_6_Entry_t

#endif
