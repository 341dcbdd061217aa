/* Descriptors, folders and changes by path. */
#include "trial.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <termios.h>
#include <unistd.h>

#define TRY(call)                                                             \
    do {                                                                      \
        errno = 0;                                                            \
        long answer = (long)(call);                                           \
        SAY("%s = %ld, %d", #call, answer, answer == -1 ? errno : 0); \
    } while (0)

static int opened(const char *path, int flags)
{
    errno = 0;
    int number = open(path, flags, 0644);
    SAY("open %s %o %s %d", path, flags, number < 0 ? "failed" : "ok", errno);
    return number;
}

static void close_if(int number)
{
    if (number >= 0)
        SAY("close %d", close(number));
}

static void facts(const char *path)
{
    struct stat about;
    errno = 0;
    int status = stat(path, &about);
    if (status)
        SAY("stat %s %d %d", path, status, errno);
    else
        SAY("stat %s mode %o size %ld file %d", path, about.st_mode, S_ISDIR(about.st_mode) ? 0 : (long)about.st_size,
            S_ISREG(about.st_mode));
}

static int by_name(const void *one, const void *other) { return strcmp(one, other); }

static void list(const char *path)
{
    char names[20][80];
    int count = 0;
    errno = 0;
    DIR *folder = opendir(path);
    SAY("opendir %s %d %d", path, folder != NULL, errno);
    if (folder == NULL)
        return;
    errno = 0;
    for (struct dirent *entry; (entry = readdir(folder)) != NULL && count < 20; count++)
        sprintf(names[count], "%s %d", entry->d_name, entry->d_type);
    SAY("names %d errno %d", count, errno);
    qsort(names, count, sizeof *names, by_name);
    for (int i = 0; i < count; i++)
        SAY("name %s", names[i]);
    rewinddir(folder);
    SAY("again %d", readdir(folder) != NULL);
    SAY("closedir %d", closedir(folder));
}

static void contents(void)
{
    char data[64] = "";
    struct iovec pieces[2] = {{"gath", 4}, {"ered", 4}};
    int file = opened("cf/work/a.bin", O_RDWR | O_CREAT | O_TRUNC);
    TRY(write(file, "0123456789", 10));
    TRY(lseek(file, 4, SEEK_SET));
    TRY(read(file, data, 3));
    SAY("data %s", data);
    TRY(lseek(file, -2, SEEK_END));
    TRY(read(file, data, 10));
    TRY(read(file, data, 10));
    TRY(pwrite(file, "XY", 2, 1));
    TRY(pread(file, data, 4, 0));
    SAY("data %.4s", data);
    TRY(writev(file, pieces, 2));
    TRY(lseek(file, 30, SEEK_SET));
    TRY(write(file, "far", 3));
    TRY(lseek(file, 0, SEEK_CUR));
    TRY(ftruncate(file, 12));
    facts("cf/work/a.bin");
    TRY(ftruncate(file, 20));
    facts("cf/work/a.bin");
    TRY(lseek(file, -1, SEEK_SET));
    TRY(lseek(file, 0, 7));
    TRY(fsync(file));
    TRY(fcntl(file, F_GETFL) & (O_ACCMODE | O_APPEND | O_NONBLOCK));
    TRY(fcntl(file, F_SETFL, O_APPEND));
    TRY(fcntl(file, F_GETFL) & (O_ACCMODE | O_APPEND | O_NONBLOCK));
    TRY(lseek(file, 0, SEEK_SET));
    TRY(write(file, "end", 3));
    TRY(lseek(file, 0, SEEK_CUR));
    TRY(isatty(file));
    struct termios options;
    TRY(tcgetattr(file, &options));
    TRY(ioctl(file, 0x1234, 0));
    int other = dup(file);
    TRY(other > file);
    TRY(close(file));
    TRY(lseek(other, 2, SEEK_SET));
    TRY(close(other));
    TRY(read(other, data, 1));
    TRY(write(other, data, 1));
    TRY(lseek(other, 0, 0));
    TRY(close(other));
    TRY(fcntl(other, F_GETFL));
    TRY(close(-1));
}

static void opening(void)
{
    char data[4];
    close_if(opened("cf/work/none", O_RDONLY));
    close_if(opened("cf/none/x", O_RDWR | O_CREAT));
    close_if(opened("cf/work/a.bin/x", O_RDONLY));
    close_if(opened("cf/work/a.bin/", O_RDONLY));
    close_if(opened("cf/work", O_RDWR));
    close_if(opened("cf/work", O_RDONLY | O_CREAT));
    close_if(opened("cf/work/a.bin", O_RDWR | O_CREAT | O_EXCL));
    close_if(opened("cf/work/a.bin", O_RDONLY | O_DIRECTORY));
    close_if(opened("", O_RDONLY));
    close_if(opened("./cf/../cf/./work//a.bin", O_RDONLY));
    int file = opened("cf/work/a.bin", O_RDONLY);
    TRY(write(file, "x", 1));
    TRY(ftruncate(file, 1));
    close_if(file);
    file = opened("cf/work/a.bin", O_WRONLY);
    TRY(read(file, data, 1));
    close_if(file);
    file = opened("cf/work", O_RDONLY);
    TRY(read(file, data, 1));
    close_if(file);
    char name[300];
    memset(name, 'n', sizeof name);
    name[299] = 0;
    close_if(opened(name, O_RDWR | O_CREAT));
    close_if(opened("cf/work/a_name_that_is_longer_than_osal_permits.text", O_RDWR | O_CREAT));
    TRY(creat("cf/work/c.bin", 0600) > 2);
    TRY(access("cf/work/c.bin", R_OK | W_OK));
    TRY(access("cf/work/c.bin", F_OK));
    TRY(access("cf/work/none", F_OK));
    TRY(access("cf/work", X_OK));
}

static void changes(void)
{
    int file = opened("cf/work/c.bin", O_RDWR);
    TRY(write(file, "kept", 4));
    TRY(unlink("cf/work/c.bin"));
    facts("cf/work/c.bin");
    TRY(lseek(file, 0, SEEK_END));
    close_if(file);
    TRY(unlink("cf/work/c.bin"));
    TRY(remove("cf/work/c.bin"));
    TRY(unlink("cf/work"));
    TRY(mkdir("cf/work/sub", 0755));
    TRY(mkdir("cf/work/sub", 0755));
    TRY(mkdir("cf/work/sub/deep/", 0755));
    TRY(mkdir("cf/work/none/deep", 0755));
    TRY(mkdir("cf/work/a.bin/deep", 0755));
    TRY(mkdir("cf/work/a.bin", 0755));
    facts("cf/work/sub");
    facts("cf/work/sub/");
    facts("cf/work/sub/deep/..");
    facts("cf/work/none");
    TRY(rmdir("cf/work/sub"));
    TRY(remove("cf/work/sub"));
    TRY(rmdir("cf/work/a.bin"));
    TRY(rmdir("cf/work/none"));
    TRY(rename("cf/work/a.bin", "cf/work/sub"));
    TRY(rename("cf/work/sub", "cf/work/a.bin"));
    TRY(rename("cf/work/none", "cf/work/b.bin"));
    TRY(rename("cf/work/a.bin", "cf/work/sub/b.bin"));
    TRY(rename("cf/work/sub", "cf/work/sub/deep/x"));
    TRY(rename("cf/work/sub", "cf/work/other"));
    facts("cf/work/other/b.bin");
    TRY(rename("cf/work/other/deep", "cf/work/other"));
    TRY(truncate("cf/work/other/b.bin", 5));
    facts("cf/work/other/b.bin");
    TRY(truncate("cf/work/other", 5));
    list("cf/work");
    list("cf/work/other");
    list("cf/work/none");
    list("cf/work/other/b.bin");
    TRY(remove("cf/work/other/deep"));
    TRY(remove("cf/work/other/b.bin"));
    TRY(remove("cf/work/other"));
    TRY(rmdir("cf/work/."));
    list("cf/work");
}

static void outside(void)
{
    facts("/no/such/place");
    close_if(opened("/dev/ttyNOWHERE", O_RDWR));
    TRY(fopen("../no/such/place", "r") == NULL);
    list("/no/such");
}

static void trial(void)
{
    mkdir("cf/work", 0755);
    contents();
    opening();
    changes();
    outside();
}
