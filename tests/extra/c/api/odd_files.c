/* OSAL's files and folders, used in odd ways: onto themselves, as the other kind, removed while open, with odd sizes. */
#include "api_test.h"

#define FILES 3
static osal_id_t fd[FILES], folder;
static char text[64];

static void put(const char *path, const char *content)
{
    osal_id_t file;
    int32 made = OS_OpenCreate(&file, path, OS_FILE_FLAG_CREATE | OS_FILE_FLAG_TRUNCATE, OS_WRITE_ONLY);
    if (made != OS_SUCCESS) {
        SAY("cannot put %s: %d", path, (int)made);
        return;
    }
    if (content[0])
        OS_write(file, content, strlen(content));
    OS_close(file);
}

/* Say what is at a path. */
static void show(const char *path)
{
    os_fstat_t facts;
    osal_id_t file;
    int32 status = OS_stat(path, &facts), size = -1;
    memset(text, 0, sizeof text);
    if (status == OS_SUCCESS && !OS_FILESTAT_ISDIR(facts) && OS_OpenCreate(&file, path, 0, OS_READ_ONLY) == OS_SUCCESS) {
        size = OS_read(file, text, sizeof text - 1);
        for (int i = 0; i < size; i++)
            text[i] = text[i] ? text[i] : '0';
        OS_close(file);
    }
    if (status != OS_SUCCESS)
        SAY("%s: none, %d", path, (int)status);
    else if (OS_FILESTAT_ISDIR(facts))
        SAY("%s: a folder", path);
    else
        SAY("%s: %d bytes [%s]", path, (int)OS_FILESTAT_SIZE(facts), text);
}

static void name_of(int which)
{
    OS_file_prop_t facts;
    int32 status = OS_FDGetInfo(fd[which], &facts);
    SAY("descriptor %d: %d, %s, valid %d", which, (int)status, facts.Path, facts.IsValid);
}

static int32 get(int which, size_t size)
{
    memset(text, 0, sizeof text);
    int32 got = OS_read(fd[which], text, size);
    for (int i = 0; i < got; i++)
        text[i] = text[i] ? text[i] : '0';
    SAY("read %d [%s]", (int)got, text);
    return got;
}

static void onto_themselves(void)
{
    SAY("-- onto themselves");
    put("/ram/a", "alpha");
    TELL(OS_mv("/ram/a", "/ram/a"));
    show("/ram/a");
    TELL(OS_rename("/ram/a", "/ram//a"));
    show("/ram/a");
    TELL(OS_cp("/ram/a", "/ram/a"));
    show("/ram/a");
    put("/ram/a", "alpha");
    TELL(OS_cp("/ram/a", "/ram/./a"));
    show("/ram/a");
    put("/ram/a", "alpha");
    TELL(OS_mv("/ram/a", "/ram/a/"));
    show("/ram/a");
    TELL(OS_cp("/ram/a", "/ram/a/"));
    show("/ram/a");
    TELL(OS_cp("/ram/a/", "/ram/b"));
    show("/ram/b");
    TELL(OS_mkdir("/ram/d", OS_READ_WRITE));
    TELL(OS_mv("/ram/d", "/ram/d"));
    show("/ram/d");
    TELL(OS_rename("/ram/d", "/ram/d/sub"));
    show("/ram/d/sub");
    TELL(OS_mv("/ram/d", "/ram/d/sub"));
    show("/ram/d");
    show("/ram/d/sub");
    TELL(OS_cp("/ram/d", "/ram/d"));
    TELL(OS_remove("/ram/d/sub"));
    TELL(OS_rmdir("/ram/d"));
    TELL(OS_cp("/ram/none", "/ram/a"));
    show("/ram/a");
    TELL(OS_mv("/ram/none", "/ram/a"));
    TELL(OS_mv("/ram/none", "/ram/none"));
    show("/ram/a");
    TELL(OS_remove("/ram/a"));
}

static void slashes(void)
{
    SAY("-- slash at the end");
    put("/ram/a", "alpha");
    show("/ram/a/");
    show("/ram/a/.");
    show("/ram/./a");
    show("/ram//a");
    show("/ram/");
    show("/ram");
    show("/ram/a/b");
    show("//ram/a");
    show("ram/a");
    TELL(OS_OpenCreate(&fd[0], "/ram/a/", 0, OS_READ_ONLY));
    TELL(OS_OpenCreate(&fd[0], "/ram/new/", OS_FILE_FLAG_CREATE, OS_READ_WRITE));
    show("/ram/new");
    TELL(OS_OpenCreate(&fd[0], "/ram/a/.", OS_FILE_FLAG_CREATE, OS_READ_WRITE));
    TELL(OS_chmod("/ram/a/", OS_READ_WRITE));
    TELL(OS_remove("/ram/a/"));
    TELL(OS_remove("/ram/a/."));
    TELL(OS_rename("/ram/a/", "/ram/b"));
    TELL(OS_rename("/ram/a", "/ram/b/"));
    TELL(OS_mv("/ram/a", "/ram/b/"));
    TELL(OS_mv("/ram/a", "/ram/b/c"));
    show("/ram/a");
    show("/ram/b");
    TELL(OS_mkdir("/ram/d/", 0));
    TELL(OS_mkdir("/ram/d/", 0));
    TELL(OS_mkdir("/ram/a/", 0));
    TELL(OS_mkdir("/ram/a", 0));
    TELL(OS_mkdir("/ram/x/y", 0));
    TELL(OS_mkdir("/ram/d/.", 0));
    TELL(OS_mkdir("/ram/e/.", 0));
    TELL(OS_mkdir("/ram", 0));
    show("/ram/d/");
    TELL(OS_rename("/ram/d", "/ram/e/"));
    TELL(OS_rename("/ram/e/", "/ram/d/"));
    show("/ram/d");
    TELL(OS_rename("/ram/d/.", "/ram/e"));
    TELL(OS_rename("/ram/d", "/ram/e/."));
    TELL(OS_rmdir("/ram/d/."));
    TELL(OS_remove("/ram/d/."));
    TELL(OS_rmdir("/ram/a"));
    TELL(OS_rmdir("/ram/a/"));
    TELL(OS_DirectoryOpen(&folder, "/ram/a/"));
    TELL(OS_DirectoryOpen(&folder, "/ram/d/."));
    TELL(OS_DirectoryClose(folder));
    TELL(OS_rmdir("/ram/d/"));
    TELL(OS_remove("/ram/a"));
}

static void other_kind(void)
{
    SAY("-- the other kind");
    put("/ram/a", "alpha");
    OS_mkdir("/ram/d", 0);
    put("/ram/d/in", "inside");
    TELL(OS_OpenCreate(&fd[0], "/ram/d", 0, OS_READ_ONLY));
    get(0, 5);
    TELL(OS_write(fd[0], "x", 1));
    TELL(OS_lseek(fd[0], 0, OS_SEEK_SET));
    TELL(OS_FileTruncate(fd[0], 0));
    TELL(OS_FileAllocate(fd[0], 0, 5));
    name_of(0);
    TELL(OS_FileOpenCheck("/ram/d"));
    TELL(OS_close(fd[0]));
    TELL(OS_OpenCreate(&fd[0], "/ram/d", 0, OS_WRITE_ONLY));
    TELL(OS_OpenCreate(&fd[0], "/ram/d", 0, OS_READ_WRITE));
    TELL(OS_OpenCreate(&fd[0], "/ram/d", OS_FILE_FLAG_CREATE, OS_READ_ONLY));
    TELL(OS_OpenCreate(&fd[0], "/ram/d", OS_FILE_FLAG_TRUNCATE, OS_READ_ONLY));
    TELL(OS_OpenCreate(&fd[0], "/ram", 0, OS_READ_ONLY));
    TELL(OS_close(fd[0]));
    TELL(OS_DirectoryOpen(&folder, "/ram/a"));
    TELL(OS_DirectoryOpen(&folder, "/ram/none"));
    TELL(OS_rmdir("/ram/d"));
    TELL(OS_remove("/ram/d"));
    TELL(OS_rename("/ram/a", "/ram/d"));
    TELL(OS_rename("/ram/d", "/ram/a"));
    TELL(OS_mv("/ram/a", "/ram/d"));
    TELL(OS_mv("/ram/d", "/ram/a"));
    show("/ram/a");
    show("/ram/d/in");
    put("/ram/a", "alpha");
    TELL(OS_cp("/ram/a", "/ram/d"));
    TELL(OS_cp("/ram/d", "/ram/a"));
    show("/ram/a");
    TELL(OS_cp("/ram/d", "/ram/copy"));
    show("/ram/copy");
    TELL(OS_mv("/ram/d", "/cf/d"));
    show("/cf/d");
    show("/ram/d");
    TELL(OS_remove("/cf/d"));
    OS_mkdir("/ram/e", 0);
    TELL(OS_rename("/ram/d", "/ram/e"));
    show("/ram/e/in");
    OS_mkdir("/ram/d", 0);
    TELL(OS_rename("/ram/d", "/ram/e"));
    TELL(OS_rmdir("/ram/d"));
    TELL(OS_remove("/ram/e/in"));
    TELL(OS_remove("/ram/e"));
    OS_remove("/ram/copy");
    OS_remove("/ram/a");
}

static void while_open(void)
{
    SAY("-- while open");
    put("/ram/a", "alphabet");
    TELL(OS_OpenCreate(&fd[0], "/ram/a", 0, OS_READ_WRITE));
    get(0, 4);
    TELL(OS_OpenCreate(&fd[1], "/ram/a", OS_FILE_FLAG_TRUNCATE, OS_WRITE_ONLY));
    get(0, 4);
    TELL(OS_write(fd[0], "late", 4));
    show("/ram/a");
    TELL(OS_write(fd[1], "early", 5));
    show("/ram/a");
    TELL(OS_lseek(fd[0], 0, OS_SEEK_CUR));
    TELL(OS_close(fd[1]));
    TELL(OS_OpenCreate(&fd[1], "/ram/a", OS_FILE_FLAG_TRUNCATE, OS_READ_ONLY));
    show("/ram/a");
    TELL(OS_write(fd[1], "x", 1));
    TELL(OS_close(fd[1]));
    TELL(OS_remove("/ram/a"));
    TELL(OS_write(fd[0], "gone", 4));
    TELL(OS_lseek(fd[0], 0, OS_SEEK_SET));
    get(0, 20);
    show("/ram/a");
    name_of(0);
    TELL(OS_FileOpenCheck("/ram/a"));
    put("/ram/a", "another");
    TELL(OS_lseek(fd[0], 0, OS_SEEK_SET));
    get(0, 20);
    TELL(OS_rename("/ram/a", "/ram/b"));
    name_of(0);
    TELL(OS_close(fd[0]));
    TELL(OS_close(fd[0]));
    show("/ram/b");
    TELL(OS_OpenCreate(&fd[0], "/ram/b", 0, OS_READ_WRITE));
    TELL(OS_rename("/ram//b", "/ram/c"));
    name_of(0);
    put("/ram/e", "victim");
    TELL(OS_OpenCreate(&fd[1], "/ram/e", 0, OS_READ_WRITE));
    TELL(OS_rename("/ram/c", "/ram/e"));
    get(0, 20);
    get(1, 20);
    name_of(1);
    TELL(OS_mv("/ram/e", "/cf/moved"));
    name_of(1);
    TELL(OS_write(fd[0], "+", 1));
    show("/cf/moved");
    show("/ram/e");
    TELL(OS_CloseFileByName("/ram/e"));
    TELL(OS_CloseFileByName("/ram/e"));
    name_of(0);
    TELL(OS_close(fd[1]));
    TELL(OS_close(fd[0]));
    TELL(OS_remove("/cf/moved"));
    TELL(OS_CloseFileByName("/ram//none"));
    TELL(OS_FileOpenCheck(""));
    put("/ram/a", "alpha");
    TELL(OS_OpenCreate(&fd[0], "/ram/a", 0, OS_WRITE_ONLY));
    TELL(OS_cp("/ram/a", "/ram/a"));
    TELL(OS_write(fd[0], "x", 1));
    show("/ram/a");
    TELL(OS_cp("/ram/a", "/ram/b"));
    TELL(OS_OpenCreate(&fd[1], "/ram/b", 0, OS_READ_ONLY));
    put("/ram/a", "longer than before");
    TELL(OS_cp("/ram/a", "/ram/b"));
    get(1, 30);
    TELL(OS_close(fd[0]));
    TELL(OS_close(fd[1]));
    TELL(OS_remove("/ram/a"));
    TELL(OS_remove("/ram/a"));
    TELL(OS_remove("/ram/b"));
}

static void sizes(void)
{
    SAY("-- sizes and places");
    put("/ram/a", "0123456789");
    TELL(OS_OpenCreate(&fd[0], "/ram/a", 0, OS_READ_WRITE));
    TELL(OS_OpenCreate(&fd[1], "/ram/a", 0, OS_READ_ONLY));
    TELL(OS_OpenCreate(&fd[2], "/ram/a", 0, OS_WRITE_ONLY));
    TELL(OS_read(fd[0], text, 0));
    TELL(OS_read(fd[0], text, (size_t)-1));
    TELL(OS_read(fd[0], NULL, 5));
    TELL(OS_write(fd[0], text, 0));
    TELL(OS_write(fd[0], text, (size_t)-5));
    TELL(OS_write(fd[1], text, 0));
    TELL(OS_write(fd[1], "x", 1));
    TELL(OS_TimedWrite(fd[1], "x", 1, 10));
    TELL(OS_read(fd[2], text, 5));
    TELL(OS_TimedRead(fd[2], text, 5, 10));
    TELL(OS_TimedRead(fd[0], text, 5, 0));
    TELL(OS_TimedRead(fd[0], text, 5, -7));
    TELL(OS_TimedReadAbs(fd[0], text, 5, OS_TimeAssembleFromNanoseconds(-5, 0)));
    TELL(OS_lseek(fd[0], -1, OS_SEEK_SET));
    TELL(OS_lseek(fd[0], -1, OS_SEEK_END));
    TELL(OS_lseek(fd[0], -10, OS_SEEK_CUR));
    TELL(OS_lseek(fd[0], 0, OS_SEEK_CUR));
    TELL(OS_lseek(fd[0], 0, 3));
    TELL(OS_lseek(fd[0], 0, (uint32)-1));
    TELL(OS_lseek(fd[0], 5, OS_SEEK_END));
    get(0, 5);
    TELL(OS_write(fd[0], "end", 3));
    show("/ram/a");
    TELL(OS_lseek(fd[1], 2000000000, OS_SEEK_SET));
    TELL(OS_lseek(fd[1], 2000000000, OS_SEEK_CUR));
    get(1, 5);
    TELL(OS_lseek(fd[1], 0x7fffffffffffffff, OS_SEEK_SET));
    TELL(OS_lseek(fd[1], 0x7fffffffffffffff, OS_SEEK_CUR));
    TELL(OS_FileTruncate(fd[0], 4));
    show("/ram/a");
    TELL(OS_lseek(fd[0], 0, OS_SEEK_CUR));
    TELL(OS_FileTruncate(fd[0], 7));
    TELL(OS_FileTruncate(fd[0], -1));
    TELL(OS_FileTruncate(fd[1], 3));
    TELL(OS_FileTruncate(fd[2], 6));
    show("/ram/a");
    TELL(OS_FileAllocate(fd[0], 0, 0));
    TELL(OS_FileAllocate(fd[0], -1, 5));
    TELL(OS_FileAllocate(fd[0], 2, -5));
    TELL(OS_FileAllocate(fd[0], 2, 2));
    TELL(OS_FileAllocate(fd[0], 5, 4));
    TELL(OS_FileAllocate(fd[1], 0, 20));
    show("/ram/a");
    TELL(OS_close(fd[0]));
    TELL(OS_close(fd[1]));
    TELL(OS_close(fd[2]));
    TELL(OS_read(fd[0], text, 5));
    TELL(OS_write(fd[0], text, 5));
    TELL(OS_lseek(fd[0], 0, OS_SEEK_SET));
    TELL(OS_FileTruncate(fd[0], 0));
    TELL(OS_FileAllocate(fd[0], 0, 5));
    TELL(OS_ShellOutputToFile("echo", fd[0]));
    name_of(0);
    TELL(OS_close(OS_OBJECT_ID_UNDEFINED));
    TELL(OS_read(OS_OBJECT_ID_UNDEFINED, text, 5));
    TELL(OS_OpenCreate(&fd[0], "/ram/a", 0, 3));
    TELL(OS_OpenCreate(&fd[0], "/ram/a", 0, -1));
    TELL(OS_OpenCreate(&fd[0], "/ram/a", 0x100, OS_READ_ONLY));
    TELL(OS_close(fd[0]));
    TELL(OS_remove("/ram/a"));
    TELL(OS_OpenCreate(&fd[0], "/ram/r", OS_FILE_FLAG_CREATE, OS_READ_ONLY));
    TELL(OS_write(fd[0], "x", 1));
    TELL(OS_close(fd[0]));
    show("/ram/r");
    TELL(OS_OpenCreate(&fd[0], "/ram/none", OS_FILE_FLAG_TRUNCATE, OS_WRITE_ONLY));
    TELL(OS_remove("/ram/r"));
}

static void short_header(void)
{
    CFE_FS_Header_t header;
    SAY("-- short header");
    put("/ram/a", "too short");
    memset(&header, '-', sizeof header);
    TELL(OS_OpenCreate(&fd[0], "/ram/a", 0, OS_READ_ONLY));
    TELL(OS_lseek(fd[0], 4, OS_SEEK_SET));
    TELL(CFE_FS_ReadHeader(&header, fd[0]));
    SAY("[%.12s]", (char *)&header);
    TELL(OS_lseek(fd[0], 0, OS_SEEK_CUR));
    TELL(OS_close(fd[0]));
    TELL(OS_OpenCreate(&fd[0], "/ram/a", 0, OS_WRITE_ONLY));
    TELL(CFE_FS_ReadHeader(&header, fd[0]));
    SAY("[%.12s]", (char *)&header);
    TELL(OS_close(fd[0]));
    TELL(OS_remove("/ram/a"));
}

static void paths(void)
{
    SAY("-- paths");
    TELL(OS_stat("", (os_fstat_t *)text));
    TELL(OS_remove(""));
    TELL(OS_remove("/"));
    TELL(OS_remove("/ram/x..y"));
    TELL(OS_remove("/ramx/a"));
    TELL(OS_rename("/ram/none", ""));
    TELL(OS_rename("", "/ram/a"));
    TELL(OS_cp("", "/ram/a"));
    TELL(OS_mv("/ram/none", ""));
    put("/ram/a", "alpha");
    TELL(OS_cp("/ram/a", ""));
    TELL(OS_mv("/ram/a", ""));
    TELL(OS_mv("/ram/a", "/nowhere/a"));
    TELL(OS_mv("/ram/a", "/cf/a/b"));
    show("/ram/a");
    TELL(OS_cp("/ram/a", "/ram/n2345678901234567890"));
    TELL(OS_cp("/ram/a", "/ram/n234567890123456789"));
    TELL(OS_remove("/ram/n234567890123456789"));
    TELL(OS_mkdir("/ram/n2345678901234567890", 0));
    TELL(OS_mkdir("/ram/n2345678901234567890/", 0));
    show("/ram/n2345678901234567890/");
    put("/ram/n2345678901234567890/f", "below");
    show("/ram/n2345678901234567890/f");
    TELL(OS_mkdir("/ram/n2345678901234567890/m2345678901234567890/", 0));
    put("/ram/n2345678901234567890/m2345678901234567890/p234567890123456", "63");
    show("/ram/n2345678901234567890/m2345678901234567890/p234567890123456");
    put("/ram/n2345678901234567890/m2345678901234567890/p2345678901234567", "64");
    TELL(OS_remove("/ram/n2345678901234567890/m2345678901234567890/p234567890123456"));
    TELL(OS_rmdir("/ram/n2345678901234567890/m2345678901234567890/"));
    TELL(OS_remove("/ram/n2345678901234567890/f"));
    TELL(OS_rmdir("/ram/n2345678901234567890/"));
    TELL(OS_stat("/ram/n23456789/n23456789/n23456789/n23456789/n23456789/n23456789/", (os_fstat_t *)text));
    put("/ram/ sp ace\t", "blank");
    show("/ram/ sp ace\t");
    TELL(OS_remove("/ram/ sp ace\t"));
    TELL(OS_remove("/ram/a"));
    TELL(OS_rename(NULL, "/ram/a"));
    TELL(OS_cp("/ram/a", NULL));
    TELL(OS_stat("/ram", NULL));
    TELL(OS_rmdir("/cf"));
    TELL(OS_remove("/cf"));
    TELL(OS_rename("/ram", "/ram/x"));
    TELL(OS_rename("/cf", "/ram/x"));
}

static int names(void)
{
    os_dirent_t entry;
    int count = 0;
    while (OS_DirectoryRead(folder, &entry) == OS_SUCCESS)
        count++;
    return count;
}

static void folders(void)
{
    os_dirent_t entry;
    SAY("-- folders");
    OS_mkdir("/ram/d", 0);
    put("/ram/d/one", "");
    put("/ram/d/two", "");
    TELL(OS_DirectoryOpen(&folder, "/ram/d"));
    SAY("%d names", names());
    TELL(OS_DirectoryRead(folder, &entry));
    put("/ram/d/three", "");
    TELL(OS_DirectoryRead(folder, &entry));
    TELL(OS_DirectoryRewind(folder));
    SAY("%d names", names());
    TELL(OS_remove("/ram/d/one"));
    TELL(OS_DirectoryRewind(folder));
    SAY("%d names", names());
    OS_remove("/ram/d/two");
    OS_remove("/ram/d/three");
    TELL(OS_rmdir("/ram/d"));
    TELL(OS_DirectoryRewind(folder));
    SAY("%d names", names());
    OS_mkdir("/ram/d", 0);
    put("/ram/d/one", "");
    TELL(OS_DirectoryRewind(folder));
    SAY("%d names", names());
    TELL(OS_DirectoryClose(folder));
    TELL(OS_DirectoryClose(folder));
    TELL(OS_DirectoryRead(folder, &entry));
    TELL(OS_DirectoryRewind(folder));
    TELL(OS_DirectoryOpen(&folder, "/ram/d"));
    TELL(OS_rename("/ram/d", "/ram/e"));
    SAY("%d names", names());
    put("/ram/e/two", "");
    TELL(OS_DirectoryRewind(folder));
    SAY("%d names", names());
    TELL(OS_DirectoryClose(folder));
    TELL(OS_DirectoryRead(OS_OBJECT_ID_UNDEFINED, &entry));
    TELL(OS_DirectoryRead(folder, NULL));
    TELL(OS_DirectoryOpen(NULL, "/ram/e"));
    TELL(OS_DirectoryOpen(&folder, NULL));
    OS_remove("/ram/e/one");
    TELL(OS_OpenCreate(&fd[0], "/ram/e/two", 0, OS_READ_ONLY));
    TELL(OS_rmdir("/ram/e"));
    TELL(OS_remove("/ram/e/two"));
    TELL(OS_rmdir("/ram/e"));
    TELL(OS_rmdir("/ram/e"));
    get(0, 5);
    TELL(OS_close(fd[0]));
}

static void descriptors(void)
{
    osal_id_t many[OS_MAX_NUM_OPEN_FILES];
    int count = 0;
    SAY("-- descriptors");
    put("/ram/a", "alpha");
    put("/ram/b", "beta");
    while (count < OS_MAX_NUM_OPEN_FILES && OS_OpenCreate(&many[count], "/ram/a", 0, OS_READ_ONLY) == OS_SUCCESS)
        count++;
    TELL(OS_OpenCreate(&fd[0], "/ram/b", OS_FILE_FLAG_TRUNCATE, OS_READ_WRITE));
    TELL(OS_OpenCreate(&fd[0], "/ram/none", 0, OS_READ_ONLY));
    TELL(OS_OpenCreate(&fd[0], "/nowhere/none", 0, OS_READ_ONLY));
    TELL(OS_cp("/ram/a", "/ram/b"));
    OS_close(many[0]);
    TELL(OS_cp("/ram/a", "/ram/b"));
    TELL(OS_cp("/ram/a", "/ram/none"));
    show("/ram/b");
    TELL(OS_mv("/ram/a", "/cf/a"));
    for (int i = 1; i < count; i++)
        OS_close(many[i]);
    show("/ram/a");
    show("/ram/b");
    show("/ram/none");
    TELL(OS_remove("/ram/a"));
    TELL(OS_remove("/ram/b"));
}

/* The folder of the disk itself, when it is empty. */
static void disk(void)
{
    SAY("-- disk");
    TELL(OS_DirectoryOpen(&folder, "/ram"));
    SAY("%d names", names());
    OS_DirectoryClose(folder);
    TELL(OS_rmdir("/ram"));
    show("/ram");
    put("/ram/a", "alpha");
    TELL(OS_mkdir("/ram/d", 0));
    TELL(OS_mkdir("/ram", 0));
    put("/ram/a", "alpha");
    show("/ram/a");
    TELL(OS_remove("/ram/a"));
    TELL(OS_remove("/ram/"));
    show("/ram");
    TELL(OS_mkdir("/ram/", 0));
    show("/ram");
}

void APITEST_Main(void)
{
    onto_themselves();
    slashes();
    other_kind();
    while_open();
    sizes();
    short_header();
    paths();
    folders();
    descriptors();
    disk();
    CFE_ES_ExitApp(CFE_ES_RunStatus_APP_EXIT);
}
