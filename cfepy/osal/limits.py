"""Fixed numbers of OSAL's interface, under NASA's names: time-outs, sizes, file modes (osapi-*.h, osconfig.h).

Numbers that a platform may change (how many queues, how many tasks) are in `cfepy.config`. Imports nothing of cfepy.
"""

from __future__ import annotations

OS_PEND = -1
OS_CHECK = 0

OS_MAX_API_NAME = 20  # with the terminating NUL: names have at most 19 characters
OS_MAX_PATH_LEN = 64
OS_MAX_FILE_NAME = 20
OS_MAX_LOCAL_PATH_LEN = 128
OS_MAX_NUM_OPEN_FILES = 50
OS_MAX_NUM_OPEN_DIRS = 4
OS_MAX_FILE_SYSTEMS = 14
OS_FS_DEV_NAME_LEN = 32
OS_FS_VOL_NAME_LEN = 32
OS_MAX_CONDVARS = 4
OS_MAX_RWLOCKS = 20
OS_BUFFER_SIZE = 172
OS_ERROR_NAME_LENGTH = 35

OS_MAX_TASK_PRIORITY = 255
OS_FP_ENABLED = 1

OS_SEM_EMPTY = 0
OS_SEM_FULL = 1
SEM_VALUE_MAX = 0x7FFFFFFF
SIZE_MAX = 0x7FFFFFFF  # OS_CHECK_SIZE refuses this and above

OS_OBJECT_ID_UNDEFINED = 0
OS_OBJECT_CREATOR_ANY = 0

OS_FILE_FLAG_NONE = 0
OS_FILE_FLAG_CREATE = 1
OS_FILE_FLAG_TRUNCATE = 2

OS_READ_ONLY = 0
OS_WRITE_ONLY = 1
OS_READ_WRITE = 2

OS_SEEK_SET = 0
OS_SEEK_CUR = 1
OS_SEEK_END = 2

OS_FILESTAT_MODE_EXEC = 1
OS_FILESTAT_MODE_WRITE = 2
OS_FILESTAT_MODE_READ = 4
OS_FILESTAT_MODE_DIR = 0x10000

OS_VERSION_NUMBER = (7, 0, 0, 0)
OS_BUILD_NUMBER = 0
PS_PER_NS = 1_000
