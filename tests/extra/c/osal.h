/* Declarations of OSAL for compiled applications of tests, in plain C types. */
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef uint32_t Id;
typedef int64_t Time; /* an OS_time_t is handed over as one */
typedef struct { char name[20]; Id creator; int32_t value; } SemInfo;
typedef struct { char name[20]; Id creator; } Named;
typedef struct { char name[20]; Id creator; size_t stack_size; uint8_t priority; } TaskInfo;
typedef struct { char name[20]; Id creator; uint32_t start, interval, accuracy; } TimerInfo;
typedef struct { char name[20]; Id creator; uint32_t interval, freerun, accuracy; } TimeBaseInfo;
typedef struct { char path[64]; Id user; uint8_t valid; } FileInfo;
typedef struct { uint32_t mode; Time time; size_t size; } FileStat;
typedef struct { size_t block_size, total_blocks, blocks_free; } VolumeStat;
typedef struct { uint32_t max_fds, free_fds, max_volumes, free_volumes; } FsInfo;
typedef struct { size_t length; uint8_t data[32]; } SockAddr;
typedef struct { uint8_t ids[7]; } FdSet;
typedef struct {
    uint64_t entry_point, host_module_id;
    char filename[64], name[20];
    struct { uint32_t valid, flags; uint64_t code, code_size, data, data_size, bss, bss_size; } addr;
} ModuleInfo;

int32_t OS_TaskCreate(Id *, const char *, void (*)(void), void *, size_t, uint8_t, uint32_t);
int32_t OS_TaskDelete(Id), OS_TaskInstallDeleteHandler(void (*)(void)), OS_TaskSetPriority(Id, uint8_t);
int32_t OS_TaskGetIdByName(Id *, const char *), OS_TaskGetInfo(Id, TaskInfo *);
int32_t OS_TaskFindIdBySystemData(Id *, const void *, size_t);
unsigned long pthread_self(void);
Id OS_TaskGetId(void);
void OS_TaskExit(void);
int32_t CFE_ES_GetAppID(uint32_t *);

int32_t OS_BinSemCreate(Id *, const char *, uint32_t, uint32_t), OS_BinSemGive(Id), OS_BinSemTake(Id);
int32_t OS_BinSemFlush(Id), OS_BinSemTimedWait(Id, uint32_t), OS_BinSemDelete(Id), OS_BinSemGetInfo(Id, SemInfo *);
int32_t OS_BinSemGetIdByName(Id *, const char *);
int32_t OS_CountSemCreate(Id *, const char *, uint32_t, uint32_t), OS_CountSemGive(Id), OS_CountSemTake(Id);
int32_t OS_CountSemTimedWait(Id, uint32_t), OS_CountSemGetInfo(Id, SemInfo *), OS_CountSemDelete(Id);
int32_t OS_MutSemCreate(Id *, const char *, uint32_t), OS_MutSemTake(Id), OS_MutSemGive(Id), OS_MutSemDelete(Id);
int32_t OS_MutSemGetInfo(Id, Named *);
int32_t OS_CondVarCreate(Id *, const char *, uint32_t), OS_CondVarLock(Id), OS_CondVarUnlock(Id), OS_CondVarWait(Id);
int32_t OS_CondVarSignal(Id), OS_CondVarTimedWait(Id, const Time *), OS_CondVarGetInfo(Id, Named *);
int32_t OS_RwLockCreate(Id *, const char *, uint32_t), OS_RwLockReadTake(Id), OS_RwLockReadGive(Id);
int32_t OS_RwLockWriteTake(Id), OS_RwLockWriteGive(Id), OS_RwLockDelete(Id);
int32_t OS_QueueCreate(Id *, const char *, size_t, size_t, uint32_t), OS_QueuePut(Id, const void *, size_t, uint32_t);
int32_t OS_QueueGet(Id, void *, size_t, size_t *, int32_t), OS_QueueGetInfo(Id, Named *), OS_QueueDelete(Id);

int32_t OS_TimeBaseCreate(Id *, const char *, uint32_t (*)(Id)), OS_TimeBaseSet(Id, uint32_t, uint32_t);
int32_t OS_TimeBaseGetInfo(Id, TimeBaseInfo *), OS_TimeBaseGetFreeRun(Id, uint32_t *), OS_TimeBaseDelete(Id);
int32_t OS_TimerCreate(Id *, const char *, uint32_t *, void (*)(Id)), OS_TimerSet(Id, uint32_t, uint32_t);
int32_t OS_TimerAdd(Id *, const char *, Id, void (*)(Id, void *), void *), OS_TimerGetInfo(Id, TimerInfo *);
int32_t OS_TimerDelete(Id);
int32_t OS_GetLocalTime(Time *), OS_SetLocalTime(const Time *), OS_GetMonotonicTime(Time *);
int32_t OS_TimeToRelativeMilliseconds(Time);
Time OS_TimeFromRelativeMilliseconds(int32_t);

int32_t OS_OpenCreate(Id *, const char *, int32_t, int32_t), OS_close(Id), OS_read(Id, void *, size_t);
int32_t OS_write(Id, const void *, size_t), OS_TimedRead(Id, void *, size_t, int32_t), OS_lseek(Id, int64_t, uint32_t);
int32_t OS_TimedReadAbs(Id, void *, size_t, Time), OS_TimedWrite(Id, const void *, size_t, int32_t);
int32_t OS_FileAllocate(Id, int64_t, int64_t), OS_FileTruncate(Id, int64_t), OS_stat(const char *, FileStat *);
int32_t OS_chmod(const char *, uint32_t), OS_remove(const char *), OS_rename(const char *, const char *);
int32_t OS_cp(const char *, const char *), OS_mv(const char *, const char *), OS_FDGetInfo(Id, FileInfo *);
int32_t OS_FileOpenCheck(const char *), OS_CloseFileByName(const char *), OS_CloseAllFiles(void);
int32_t OS_mkdir(const char *, uint32_t), OS_rmdir(const char *), OS_DirectoryOpen(Id *, const char *);
int32_t OS_DirectoryRead(Id, char *), OS_DirectoryRewind(Id), OS_DirectoryClose(Id);
int32_t OS_mkfs(char *, const char *, const char *, size_t, size_t), OS_mount(const char *, const char *);
int32_t OS_unmount(const char *), OS_rmfs(const char *), OS_FileSysStatVolume(const char *, VolumeStat *);
int32_t OS_chkfs(const char *, bool), OS_FS_GetPhysDriveName(char *, const char *), OS_GetFsInfo(FsInfo *);
int32_t OS_TranslatePath(const char *, char *), OS_ShellOutputToFile(const char *, Id);

int32_t OS_SocketAddrInit(SockAddr *, uint32_t), OS_SocketAddrToString(char *, size_t, const SockAddr *);
int32_t OS_SocketAddrFromString(SockAddr *, const char *), OS_SocketAddrGetPort(uint16_t *, const SockAddr *);
int32_t OS_SocketAddrSetPort(SockAddr *, uint16_t), OS_SocketOpen(Id *, uint32_t, uint32_t);
int32_t OS_SocketBind(Id, const SockAddr *), OS_SocketConnect(Id, const SockAddr *, int32_t);
int32_t OS_SocketAccept(Id, Id *, SockAddr *, int32_t), OS_SocketShutdown(Id, uint32_t);
int32_t OS_SocketRecvFrom(Id, void *, size_t, SockAddr *, int32_t);
int32_t OS_SocketSendTo(Id, const void *, size_t, const SockAddr *), OS_SocketGetInfo(Id, Named *);
int32_t OS_SocketGetOption(Id, uint32_t, int32_t *), OS_SocketSetOption(Id, uint32_t, const int32_t *);
int32_t OS_SelectSingle(Id, uint32_t *, int32_t), OS_SelectMultiple(FdSet *, FdSet *, int32_t), OS_SelectFdZero(FdSet *);
int32_t OS_SelectFdAdd(FdSet *, Id), OS_SelectFdClear(FdSet *, Id);
bool OS_SelectFdIsSet(const FdSet *, Id);

int32_t OS_ModuleLoad(Id *, const char *, const char *, uint32_t), OS_ModuleUnload(Id), OS_ModuleInfo(Id, ModuleInfo *);
int32_t OS_SymbolLookup(uint64_t *, const char *), OS_ModuleSymbolLookup(Id, uint64_t *, const char *);
int32_t OS_SymbolTableDump(const char *, size_t);
int32_t OS_GetResourceName(Id, char *, size_t), OS_ConvertToArrayIndex(Id, uint32_t *);
int32_t OS_ObjectIdToArrayIndex(uint32_t, Id, uint32_t *), OS_GetErrorName(int32_t, char *);
uint32_t OS_IdentifyObject(Id);
void OS_ForEachObject(Id, void (*)(Id, void *), void *), OS_ForEachObjectOfType(uint32_t, Id, void (*)(Id, void *), void *);
char *OS_StatusToString(int32_t, char *);
int32_t OS_RegisterEventHandler(int32_t (*)(uint32_t, Id, void *)), OS_API_Init(void), OS_HeapGetInfo(size_t *);
int32_t OS_NetworkGetID(void), OS_NetworkGetHostName(char *, size_t);
uint32_t OS_BSP_GetArgC(void), OS_GetBuildNumber(void);
char *const *OS_BSP_GetArgV(void);
const char *OS_GetVersionString(void), *OS_GetVersionCodeName(void);
void OS_GetVersionNumber(uint8_t *), OS_ApplicationExit(int32_t), OS_BSP_SetExitCode(int32_t);
