/* OSAL: files, folders, volumes, loaded modules, the shell. */
#ifndef CFEPY_OSAL_FILES_H
#define CFEPY_OSAL_FILES_H

#include "osal_objects.h"

CFEPY_C_BEGIN

/* ---- files ---- */
#define OS_READ_ONLY  0
#define OS_SEEK_SET   0
#define OS_SEEK_CUR   1
#define OS_WRITE_ONLY 1
#define OS_READ_WRITE 2
#define OS_SEEK_END   2

typedef struct {
    char Path[OS_MAX_PATH_LEN];
    osal_id_t User;
    uint8 IsValid;
} OS_file_prop_t;

typedef struct {
    uint32 FileModeBits;
    OS_time_t FileTime;
    size_t FileSize;
} os_fstat_t;

enum {
    OS_FILESTAT_MODE_EXEC = 0x00001, OS_FILESTAT_MODE_WRITE = 0x00002, OS_FILESTAT_MODE_READ = 0x00004,
    OS_FILESTAT_MODE_DIR = 0x10000
};

typedef enum { OS_FILE_FLAG_NONE = 0x00, OS_FILE_FLAG_CREATE = 0x01, OS_FILE_FLAG_TRUNCATE = 0x02 } OS_file_flag_t;
#define OS_FILESTAT_MODE(stat)  ((stat).FileModeBits)
#define OS_FILESTAT_ISDIR(stat) (OS_FILESTAT_MODE(stat) & OS_FILESTAT_MODE_DIR)
#define OS_FILESTAT_EXEC(stat)  (OS_FILESTAT_MODE(stat) & OS_FILESTAT_MODE_EXEC)
#define OS_FILESTAT_WRITE(stat) (OS_FILESTAT_MODE(stat) & OS_FILESTAT_MODE_WRITE)
#define OS_FILESTAT_READ(stat)  (OS_FILESTAT_MODE(stat) & OS_FILESTAT_MODE_READ)
#define OS_FILESTAT_SIZE(stat)  ((stat).FileSize)
#define OS_FILESTAT_TIME(stat)  (OS_TimeGetTotalSeconds((stat).FileTime))
int32 OS_CloseAllFiles(void);
int32 OS_CloseFileByName(const char *Filename);
int32 OS_FDGetInfo(osal_id_t filedes, OS_file_prop_t *fd_prop);
int32 OS_FileAllocate(osal_id_t filedes, osal_offset_t offset, osal_offset_t len);
int32 OS_FileOpenCheck(const char *Filename);
int32 OS_FileTruncate(osal_id_t filedes, osal_offset_t len);
int32 OS_OpenCreate(osal_id_t *filedes, const char *path, int32 flags, int32 access_mode);
int32 OS_TimedRead(osal_id_t filedes, void *buffer, size_t nbytes, int32 timeout);
int32 OS_TimedReadAbs(osal_id_t filedes, void *buffer, size_t nbytes, OS_time_t abstime);
int32 OS_TimedWrite(osal_id_t filedes, const void *buffer, size_t nbytes, int32 timeout);
int32 OS_TimedWriteAbs(osal_id_t filedes, const void *buffer, size_t nbytes, OS_time_t abstime);
int32 OS_chmod(const char *path, uint32 access_mode);
int32 OS_close(osal_id_t filedes);
int32 OS_cp(const char *src, const char *dest);
int32 OS_lseek(osal_id_t filedes, osal_offset_t offset, uint32 whence);
int32 OS_mv(const char *src, const char *dest);
int32 OS_read(osal_id_t filedes, void *buffer, size_t nbytes);
int32 OS_remove(const char *path);
int32 OS_rename(const char *old_filename, const char *new_filename);
int32 OS_stat(const char *path, os_fstat_t *filestats);
int32 OS_write(osal_id_t filedes, const void *buffer, size_t nbytes);

/* ---- folders ---- */
typedef struct {
    char FileName[OS_MAX_API_NAME];
} os_dirent_t;

#define OS_DIRENTRY_NAME(entry) ((entry).FileName)
int32 OS_DirectoryClose(osal_id_t dir_id);
int32 OS_DirectoryOpen(osal_id_t *dir_id, const char *path);
int32 OS_DirectoryRead(osal_id_t dir_id, os_dirent_t *dirent);
int32 OS_DirectoryRewind(osal_id_t dir_id);
int32 OS_mkdir(const char *path, uint32 access);
int32 OS_rmdir(const char *path);

/* ---- volumes and paths ---- */
#define OS_CHK_ONLY 0
#define OS_REPAIR   1

typedef struct {
    uint32 MaxFds, FreeFds, MaxVolumes, FreeVolumes;
} os_fsinfo_t;

typedef struct {
    size_t block_size;
    osal_blockcount_t total_blocks, blocks_free;
} OS_statvfs_t;

int32 OS_FS_GetPhysDriveName(char *PhysDriveName, const char *MountPoint);
int32 OS_FileSysAddFixedMap(osal_id_t *filesys_id, const char *phys_path, const char *virt_path);
int32 OS_FileSysStatVolume(const char *name, OS_statvfs_t *statbuf);
int32 OS_GetFsInfo(os_fsinfo_t *filesys_info);
int32 OS_TranslatePath(const char *VirtualPath, char *LocalPath);
int32 OS_chkfs(const char *name, bool repair);
int32 OS_initfs(char *address, const char *devname, const char *volname, size_t blocksize,
    osal_blockcount_t numblocks);
int32 OS_mkfs(char *address, const char *devname, const char *volname, size_t blocksize, osal_blockcount_t numblocks);
int32 OS_mount(const char *devname, const char *mountpoint);
int32 OS_rmfs(const char *devname);
int32 OS_unmount(const char *mountpoint);

/* ---- modules and symbols ---- */
#define OS_MODULE_FLAG_GLOBAL_SYMBOLS 0x0
#define OS_MODULE_FLAG_LOCAL_SYMBOLS  0x1

typedef struct {
    uint32 valid, flags;
    cpuaddr code_address, code_size, data_address, data_size, bss_address, bss_size;
} OS_module_address_t;

typedef struct {
    cpuaddr entry_point, host_module_id;
    char filename[OS_MAX_PATH_LEN], name[OS_MAX_API_NAME];
    OS_module_address_t addr;
} OS_module_prop_t;

typedef const struct {
    const char *Name;
    void (*Address)(void);
    const char *Module;
} OS_static_symbol_record_t;

int32 OS_ModuleInfo(osal_id_t module_id, OS_module_prop_t *module_info);
int32 OS_ModuleLoad(osal_id_t *module_id, const char *module_name, const char *filename, uint32 flags);
int32 OS_ModuleSymbolLookup(osal_id_t module_id, cpuaddr *symbol_address, const char *symbol_name);
int32 OS_ModuleUnload(osal_id_t module_id);
int32 OS_SymbolLookup(cpuaddr *symbol_address, const char *symbol_name);
int32 OS_SymbolTableDump(const char *filename, size_t size_limit);
int32 OS_ShellOutputToFile(const char *Cmd, osal_id_t filedes);

CFEPY_C_END

#endif
