// A program on the heap of the profiles pool and strict: each line of its input is a case, and it prints what came of it.
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string>
#include <vector>

#include "roscfe/heap.h"

extern "C" {
void *memalign(std::size_t alignment, std::size_t size);
void *reallocarray(void *at, std::size_t count, std::size_t size);
}

namespace roscfe
{

[[noreturn]] void refuse(const char *what, const char *detail)
{
    std::printf("refused: %s: %s\n", what, detail);
    std::fflush(stdout);
    std::_Exit(0);
}

} // namespace roscfe

namespace
{

volatile std::size_t g_size; // which the compiler does not know

bool is_aligned(const void *at, std::size_t alignment)
{
    return reinterpret_cast<std::uintptr_t>(at) % alignment == 0;
}

struct alignas(256) Wide
{
    char bytes[256];
};

void say(const char *what, bool good)
{
    std::printf("%s %d\n", what, good);
}

// Whether memory is the arena's: more of that is used when a block of a size is taken for the first time.
template <class F>
void *taken(const char *what, F take)
{
    const std::size_t before = roscfe::heap::used();
    void *            at     = take();
    say(what, at != nullptr && roscfe::heap::used() > before);
    return at;
}

void aligned()
{
    Wide *wide = static_cast<Wide *>(taken("new", [] { return new Wide; }));
    say("aligned", is_aligned(wide, 256));
    std::memset(wide, 1, sizeof *wide);
    Wide *wides = static_cast<Wide *>(taken("new[]", [] { return new Wide[3]; }));
    say("aligned", is_aligned(wides, 256));
    std::memset(static_cast<void *>(wides), 2, 3 * sizeof *wides);
    Wide *offered = new (std::nothrow) Wide;
    say("aligned", is_aligned(offered, 256));
    say("apart", wide->bytes[0] == 1 && wides[2].bytes[255] == 2);
    delete wide;
    delete[] wides;
    delete offered;
    const std::size_t before = roscfe::heap::used();
    delete new Wide;
    delete[] new Wide[3];
    say("again", roscfe::heap::used() == before);
    void *far = ::operator new(8, std::align_val_t(16384));
    say("far", is_aligned(far, 16384));
    ::operator delete(far, std::align_val_t(16384));
    say("too far", ::operator new(8, std::align_val_t(std::size_t(1) << 40), std::nothrow) == nullptr);
}

void of_c()
{
    char *text = static_cast<char *>(taken("malloc", [] { return std::malloc(100); }));
    std::strcpy(text, "kept");
    text = static_cast<char *>(taken("realloc", [text] { return std::realloc(text, 1000); }));
    say("kept", std::strcmp(text, "kept") == 0);
    std::free(text);
    auto *zeros = static_cast<unsigned char *>(taken("calloc", [] { return std::calloc(50, 50); }));
    bool  clear = true;
    for (int i = 0; i < 2500; ++i)
    {
        clear = clear && zeros[i] == 0;
    }
    say("clear", clear);
    std::free(zeros);
    void *at = taken("aligned_alloc", [] { return std::aligned_alloc(1024, 4096); });
    say("aligned", is_aligned(at, 1024));
    std::free(at);
    at = nullptr;
    say("posix_memalign", posix_memalign(&at, 512, 600) == 0 && is_aligned(at, 512));
    std::free(at);
    say("odd", posix_memalign(&at, 48, 600) == EINVAL);
    at = memalign(128, 16);
    say("memalign", is_aligned(at, 128));
    std::free(at);
    const std::size_t before = roscfe::heap::used();
    char *            copy   = strdup(std::string(20000, 'x').c_str());
    say("strdup", roscfe::heap::used() > before && std::strlen(copy) == 20000);
    std::free(copy);
    copy = strndup("abcdef", 3);
    say("strndup", std::strcmp(copy, "abc") == 0);
    std::free(copy);
    std::free(nullptr);
    std::free(std::realloc(nullptr, 10));
    say("realloc of 0", std::realloc(std::malloc(10), 0) == nullptr);
    char *      line = nullptr; // libc's own memory goes back to libc
    std::size_t size = 0;
    say("getline", getline(&line, &size, stdin) == 5);
    line = static_cast<char *>(std::realloc(line, 500));
    say("kept", std::strcmp(line, "line\n") == 0);
    std::free(line);
}

void too_large()
{
    for (const std::size_t size : {SIZE_MAX, SIZE_MAX - 8, SIZE_MAX / 2 + 2, SIZE_MAX / 2, std::size_t(1) << 31})
    {
        g_size = size;
        say("nothrow", ::operator new(g_size, std::nothrow) == nullptr);
        say("nothrow", ::operator new(g_size, std::align_val_t(64), std::nothrow) == nullptr);
        errno = 0;
        say("malloc", std::malloc(g_size) == nullptr && errno == ENOMEM);
        say("aligned_alloc", std::aligned_alloc(64, g_size) == nullptr);
        say("realloc", std::realloc(nullptr, g_size) == nullptr);
    }
    g_size = SIZE_MAX / 4 + 1;
    say("calloc", std::calloc(g_size, 4) == nullptr);
    say("reallocarray", reallocarray(nullptr, g_size, 4) == nullptr);
    char *kept = static_cast<char *>(std::malloc(10));
    std::strcpy(kept, "kept");
    g_size = SIZE_MAX;
    say("realloc", std::realloc(kept, g_size) == nullptr && std::strcmp(kept, "kept") == 0);
}

void full()
{
    int blocks = 0;
    while (new (std::nothrow) char[1000] != nullptr)
    {
        ++blocks;
    }
    say("some", blocks > 200 && blocks <= 256);
    say("malloc", std::malloc(1000) == nullptr);
    say("aligned", new (std::nothrow) Wide[8] == nullptr);
    std::printf("%p\n", static_cast<void *>(new char[1000]));
}

void sealed()
{
    roscfe::heap::seal();
    void *const offered = new (std::nothrow) char[100];
    std::printf("nothrow %d, counted %u\n", offered != nullptr, roscfe::heap::late_allocations());
    std::printf("malloc %d\n", std::malloc(100) != nullptr);
}

void negative()
{
    g_size        = SIZE_MAX;
    double *block = new double[static_cast<long>(g_size)];
    std::printf("block %p\n", static_cast<void *>(block));
}

void half()
{
    g_size = SIZE_MAX / 2 + 1;
    std::printf("block %p\n", ::operator new(g_size));
}

void wide()
{
    g_size = std::size_t(1) << 40;
    std::printf("block %p\n", ::operator new(16, std::align_val_t(g_size)));
}

void thrown()
{
    std::vector<int> numbers(3);
    g_size = 5;
    std::printf("%d\n", numbers.at(g_size));
}

} // namespace

int main(int, char **arguments)
{
    std::setvbuf(stdout, nullptr, _IONBF, 0);
    const std::string what = arguments[1];
    say("nothing taken", roscfe::heap::used() < 4096);
    what == "aligned"     ? aligned()
    : what == "c"         ? of_c()
    : what == "too large" ? too_large()
    : what == "full"      ? full()
    : what == "sealed"    ? sealed()
    : what == "negative"  ? negative()
    : what == "half"      ? half()
    : what == "wide"      ? wide()
                          : thrown();
    std::puts("done");
}
