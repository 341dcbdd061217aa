/* FILEs: modes, buffers, positions, states, and formatted input. */
#include "trial.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

static long size_of(const char *path)
{
    struct stat facts;
    return stat(path, &facts) ? -errno : (long)facts.st_size;
}

static void put(const char *path, const char *text)
{
    FILE *to = fopen(path, "w");
    int status = fputs(text, to);
    SAY("put %d %d", status >= 0, fclose(to));
}

static void show(const char *path)
{
    char data[200];
    FILE *from = fopen(path, "r");
    if (from == NULL) {
        SAY("no %s %d", path, errno);
        return;
    }
    size_t count = fread(data, 1, sizeof data - 1, from);
    data[count] = 0;
    SAY("show %zu %s eof %d error %d", count, quoted(data), !!feof(from), !!ferror(from));
    fclose(from);
}

static void modes(void)
{
    static const char *const all[] = {"r", "w", "a", "r+", "w+", "a+", "rb", "wx", "r+b", "rw", "x", "", "we"};
    for (size_t i = 0; i < COUNT(all); i++) {
        put("cf/work/m.txt", "0123456789");
        errno = 0;
        FILE *file = fopen("cf/work/m.txt", all[i]);
        SAY("mode %s %d %d", all[i], file != NULL, file == NULL ? errno : 0);
        if (file == NULL)
            continue;
        errno = 0;
        int first = fgetc(file), error = first < 0 ? errno : 0, failed = !!ferror(file);
        SAY("first %d %d %d at %ld", first, error, failed, ftell(file));
        fseek(file, 2, SEEK_SET);
        errno = 0;
        int put_one = fputc('x', file);
        SAY("put %d %d at %ld", put_one, put_one < 0 ? errno : 0, ftell(file));
        SAY("close %d", fclose(file));
        show("cf/work/m.txt");
    }
}

static void buffers(void)
{
    char block[9000];
    memset(block, 'b', sizeof block);
    static const int sizes[] = {1, 100, 3995, 1, 4096, 4095, 2, 5000, 8192, 8193, 3, 4096, 4096};
    FILE *file = fopen("cf/work/b.bin", "wb");
    for (size_t i = 0; i < COUNT(sizes); i++)
    {
        size_t count = fwrite(block, 1, sizes[i], file);
        long size = size_of("cf/work/b.bin");
        SAY("write %d %zu file %ld at %ld", sizes[i], count, size, ftell(file));
    }
    int status = fflush(file);
    SAY("flush %d %ld", status, size_of("cf/work/b.bin"));
    for (int i = 0; i < 4100; i += 1)
        fputc('c', file);
    SAY("characters %ld", size_of("cf/work/b.bin"));
    status = fflush(NULL);
    SAY("null flush %d %ld", status, size_of("cf/work/b.bin"));
    status = fclose(file);
    SAY("close %d %ld", status, size_of("cf/work/b.bin"));
    file = fopen("cf/work/b.bin", "w");
    size_t first = fwrite(block, 1, 4096, file);
    SAY("first block %zu %ld", first, size_of("cf/work/b.bin"));
    fclose(file);
    file = fopen("cf/work/l.txt", "w");
    SAY("lines %d", setvbuf(file, NULL, _IOLBF, 0));
    fprintf(file, "one");
    SAY("half %ld", size_of("cf/work/l.txt"));
    fprintf(file, " line\nand");
    SAY("line %ld", size_of("cf/work/l.txt"));
    fclose(file);
    file = fopen("cf/work/l.txt", "a");
    setbuf(file, NULL);
    fprintf(file, "%s %c%d", "no", 0, 42);
    SAY("unbuffered %ld at %ld", size_of("cf/work/l.txt"), ftell(file));
    fclose(file);
}

static void positions(void)
{
    put("cf/work/p.txt", "alpha\nbeta\n\ngamma");
    FILE *file = fopen("cf/work/p.txt", "r+");
    char line[8] = "";
    fpos_t place;
    while (fgets(line, sizeof line, file) != NULL)
        SAY("line %s at %ld", quoted(line), ftell(file));
    SAY("end %d %d", !!feof(file), fgetc(file));
    SAY("unget %d %d %d", ungetc('Z', file), !!feof(file), fgetc(file));
    SAY("unget EOF %d", ungetc(EOF, file));
    rewind(file);
    SAY("rewound %ld %d", ftell(file), !!feof(file));
    SAY("get %d at %ld", fgetc(file), ftell(file));
    SAY("pos %d", fgetpos(file, &place));
    SAY("seek %d at %ld", fseek(file, -3, SEEK_END), ftell(file));
    SAY("char %c", fgetc(file));
    SAY("setpos %d %c", fsetpos(file, &place), fgetc(file));
    SAY("relative %d %c", fseek(file, 2, SEEK_CUR), fgetc(file));
    errno = 0;
    SAY("negative %d %d", fseek(file, -1, SEEK_SET), errno);
    SAY("odd %d %d", fseek(file, 0, 9), errno);
    fseek(file, 1, SEEK_SET);
    fgetc(file);
    fseek(file, 0, SEEK_CUR);
    fputs("PP", file);
    SAY("written at %ld", ftell(file));
    fseek(file, 40, SEEK_SET);
    fputc('!', file);
    SAY("number %d", fileno(file) > 2);
    fclose(file);
    show("cf/work/p.txt");
    SAY("size %ld", size_of("cf/work/p.txt"));
    file = fopen("cf/work/p.txt", "r");
    char items[70];
    SAY("items %zu eof %d", fread(items, 7, 9, file), !!feof(file));
    SAY("none %zu %zu", fread(items, 0, 9, file), fread(items, 1, 3, file));
    SAY("read only %zu %d", fwrite("x", 1, 1, file), !!ferror(file));
    clearerr(file);
    SAY("cleared %d %d", !!feof(file), !!ferror(file));
    fclose(file);
}

static void scans(void)
{
    put("cf/work/s.txt", "# values\nalpha 1.5 -3\nbeta 2.25 7\ngamma x 9\n0x1F,017,  last\n99");
    FILE *file = fopen("cf/work/s.txt", "r");
    char word[20], rest[40];
    double value = 0;
    int number = 0, count, more = 0;
    SAY("comment %d", fscanf(file, "#%39[^\n]\n", rest));
    SAY("text %s at %ld", quoted(rest), ftell(file));
    for (int i = 0; i < 3; i++) {
        count = fscanf(file, "%19s %lf %d", word, &value, &number);
        SAY("scan %d %s %g %d at %ld", count, word, value, number, ftell(file));
    }
    SAY("stuck %c", fgetc(file));
    SAY("two %d", fscanf(file, " x %d %i,%i,%n", &number, &count, &number, &more));
    SAY("found %d %d %d at %ld", count, number, more, ftell(file));
    SAY("word %d %s", fscanf(file, "%s", word), word);
    SAY("line %s", quoted(fgets(rest, sizeof rest, file)));
    count = fscanf(file, "%d", &number);
    SAY("last %d %d eof %d", count, number, !!feof(file));
    SAY("end %d eof %d", fscanf(file, "%d", &number), !!feof(file));
    rewind(file);
    SAY("again %d %s", fscanf(file, "%*s %s", word), word);
    SAY("unget %d", ungetc('7', file));
    count = fscanf(file, "%d", &number);
    SAY("number %d %d", count, number);
    char *made = NULL;
    count = fscanf(file, "%ms", &made);
    SAY("made %d %s", count, made);
    free(made);
    fclose(file);
    FILE *both = fopen("cf/work/s2.txt", "w+");
    fprintf(both, "%d %s", 12, "twelve");
    rewind(both);
    count = fscanf(both, "%d %19s", &number, word);
    SAY("both %d %d %s", count, number, word);
    fclose(both);
}

static void lines(void)
{
    char *line = NULL, long_text[400];
    size_t size = 0;
    long count;
    memset(long_text, 'x', sizeof long_text);
    long_text[390] = 0;
    FILE *file = fopen("cf/work/l.txt", "w+");
    fprintf(file, "one\n\n%s\ntwo;three;last", long_text);
    rewind(file);
    for (int i = 0; i < 3; i++) {
        count = getline(&line, &size, file);
        SAY("getline %ld %ld", count, (long)size);
    }
    while ((count = getdelim(&line, &size, ';', file)) >= 0)
        SAY("getdelim %ld %s", count, quoted(line));
    SAY("end %d", !!feof(file));
    free(line);
    fclose(file);
}

static void descriptors(void)
{
    int number = open("cf/work/d.bin", O_RDWR | O_CREAT | O_TRUNC, 0644);
    FILE *file = fdopen(number, "r+");
    SAY("fdopen %d", file != NULL && fileno(file) == number);
    fputs("stream", file);
    SAY("before %ld", (long)lseek(number, 0, SEEK_CUR));
    SAY("direct %ld", (long)write(number, "DIRECT", 6));
    fflush(file);
    SAY("after %ld", (long)lseek(number, 0, SEEK_CUR));
    SAY("close %d", fclose(file));
    SAY("closed %d", close(number) == -1 && errno == EBADF);
    show("cf/work/d.bin");
    errno = 0;
    SAY("bad fdopen %d %d", fdopen(number, "r") == NULL, errno == EBADF);
}

static void trial(void)
{
    mkdir("cf/work", 0755);
    modes();
    buffers();
    positions();
    scans();
    lines();
    descriptors();
}
