/* What is chosen when OSAL and the PSP are built: their sizes and limits (osconfig.h, pspconfig.h of a cFS build). */
#ifndef CFEPY_OSAL_CONFIG_H
#define CFEPY_OSAL_CONFIG_H

/* ---- OSAL ---- */
#define OSAL_CONFIG_INCLUDE_DYNAMIC_LOADER
#define OSAL_CONFIG_INCLUDE_NETWORK
#define OSAL_CONFIG_INCLUDE_STATIC_LOADER
#define OSAL_CONFIG_DEBUG_PRINTF
#define OSAL_CONFIG_DEBUG_PERMISSIVE_MODE
#define OSAL_CONFIG_CONSOLE_ASYNC
#define OS_ADD_TASK_FLAGS            0
#define OS_BUFFER_MSG_DEPTH          100
#define OS_BUFFER_SIZE               172
#define OS_FS_DEV_NAME_LEN           32
#define OS_FS_PHYS_NAME_LEN          64
#define OS_FS_VOL_NAME_LEN           32
#define OS_MAX_API_NAME              20
#define OS_MAX_BIN_SEMAPHORES        20
#define OS_MAX_CMD_LEN               1000
#define OS_MAX_CONDVARS              4
#define OS_MAX_CONSOLES              1
#define OS_MAX_COUNT_SEMAPHORES      20
#define OS_MAX_FILE_NAME             20
#define OS_MAX_FILE_SYSTEMS          14
#define OS_MAX_MODULES               20
#define OS_MAX_MUTEXES               20
#define OS_MAX_NUM_OPEN_DIRS         4
#define OS_MAX_NUM_OPEN_FILES        50
#define OS_MAX_PATH_LEN              64
#define OS_MAX_QUEUES                64
#define OS_MAX_RWLOCKS               20
#define OS_MAX_SYM_LEN               64
#define OS_MAX_TASKS                 64
#define OS_MAX_TIMEBASES             5
#define OS_MAX_TIMERS                10
#define OS_MODULE_FILE_EXTENSION     ".so"
#define OS_PRINTF_CONSOLE_NAME       ""
#define OS_QUEUE_MAX_DEPTH           50
#define OS_SHELL_CMD_INPUT_FILE_NAME ""
#define OS_SOCKADDR_MAX_LEN          28
#define OS_UTILITYTASK_PRIORITY      10
#define OS_UTILITYTASK_STACK_SIZE    2048

/* ---- the PSP ---- */
#define CFE_PSP_CF_EEPROM_VIRTUAL_MAPPING  "/mnt/eeprom"
#define CFE_PSP_CF_PHY_DEV_VIRTUAL_MAPPING "CF:0"
#define CFE_PSP_CF_ROMFS_VIRTUAL_MAPPING   "/romfs/cpu1/cf"
#define CFE_PSP_CF_VIRTUAL_MAPPING         "./cf"
#define CFE_PSP_DEBUG_LEVEL                1

#endif
