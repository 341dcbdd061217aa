// A program on the heap of the profiles pool and strict: each line of its input is a case, and it prints what came of it.
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <map>
#include <new>
#include <string>
#include <vector>

#include "roscfe/heap.h"

extern "C" {
void *memalign(std::size_t alignment, std::size_t size);
void *reallocarray(void *at, std::size_t count, std::size_t size);
void  __cxa_pure_virtual();
void  __cxa_deleted_virtual();
void *__cxa_allocate_exception(std::size_t size) noexcept;
void *__cxa_allocate_dependent_exception() noexcept;
void  __cxa_free_exception(void *) noexcept;
void  __cxa_free_dependent_exception(void *) noexcept;
__attribute__((weak)) void __gcov_dump(); // writes which lines were reached, where that is measured
}

namespace std
{
void __throw_bad_exception();
} // namespace std

static void *g_spare[32]; // blocks of all small sizes: __gcov_dump allocates, and the arena may be full

namespace roscfe
{

[[noreturn]] void refuse(const char *what, const char *detail)
{
    std::printf("refused: %s: %s\n", what, detail);
    std::fflush(stdout);
    if (__gcov_dump != nullptr)
    {
        for (void *const each : g_spare)
        {
            std::free(each);
        }
        __gcov_dump();
    }
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
    void *volatile none = nullptr;
    std::free(none);
    ::operator delete(none);
    std::free(std::realloc(nullptr, 10));
    say("realloc of 0", std::realloc(std::malloc(10), 0) == nullptr);
    char *      line = nullptr; // libc's own memory goes back to libc
    std::size_t size = 0;
    say("getline", getline(&line, &size, stdin) == 5);
    line = static_cast<char *>(std::realloc(line, 500));
    say("kept", std::strcmp(line, "line\n") == 0);
    std::free(line);
}

// Each form of operator delete gives a block back: the next block of that size is the same.
void given_back()
{
    using std::align_val_t;
    const align_val_t far    = align_val_t(64);
    const std::size_t before = roscfe::heap::used();
    const auto        place  = [](void *at) { return reinterpret_cast<std::uintptr_t>(at); };
    void *            block  = ::operator new(3000);
    const auto        plain  = place(block);
    ::operator delete(block);
    block            = ::operator new(6000, far);
    const auto apart = place(block);
    ::operator delete(block, far);
    const auto same = [&place](void *at, std::uintptr_t wanted) {
        say("same", place(at) == wanted);
        return at;
    };
    ::operator delete[](same(::operator new[](3000), plain));
    ::operator delete(same(::operator new(3000), plain), std::size_t(3000));
    ::operator delete[](same(::operator new[](3000), plain), std::size_t(3000));
    ::operator delete(same(::operator new(3000, std::nothrow), plain), std::nothrow);
    ::operator delete[](same(::operator new[](3000, std::nothrow), plain), std::nothrow);
    ::operator delete[](same(::operator new[](6000, far), apart), far);
    ::operator delete(same(::operator new(6000, far), apart), std::size_t(6000), far);
    ::operator delete[](same(::operator new[](6000, far), apart), std::size_t(6000), far);
    ::operator delete(same(::operator new(6000, far, std::nothrow), apart), far, std::nothrow);
    ::operator delete[](same(::operator new[](6000, far, std::nothrow), apart), far, std::nothrow);
    say("used", roscfe::heap::used() - before == 4096 + 8192);
    say("capacity", roscfe::heap::capacity() == 262144);
}

void resized()
{
    char *text = static_cast<char *>(std::malloc(100));
    const auto place = reinterpret_cast<std::uintptr_t>(text);
    for (const std::size_t size : {10, 100})
    {
        text = static_cast<char *>(std::realloc(text, size));
        say("same", reinterpret_cast<std::uintptr_t>(text) == place);
    }
    std::strcpy(text, "kept");
    text = static_cast<char *>(reallocarray(text, 500, 4));
    say("reallocarray", text != nullptr && std::strcmp(text, "kept") == 0);
    std::free(text);
    say("none", std::calloc(5, 0) != nullptr && reallocarray(nullptr, 5, 0) != nullptr);
    errno = 0;
    say("odd", memalign(48, 16) == nullptr && errno == EINVAL);
    void *at = nullptr;
    say("odd", posix_memalign(&at, 4, 16) == EINVAL && posix_memalign(&at, 0, 16) == EINVAL);
    g_size = SIZE_MAX;
    say("full", posix_memalign(&at, 64, g_size) == ENOMEM && at == nullptr);
    say("end of the text", std::strcmp(strndup("ab", 100), "ab") == 0);
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
    const std::string text(1000, 'x');
    int               blocks = 0;
    while (new (std::nothrow) char[1000] != nullptr)
    {
        ++blocks;
    }
    say("some", blocks > 200 && blocks <= 256);
    say("malloc", std::malloc(1000) == nullptr);
    say("aligned", new (std::nothrow) Wide[8] == nullptr);
    void *volatile at = std::calloc(10, 100); // kept, or the compiler leaves the call out
    say("calloc", at == nullptr);
    at = strdup(text.c_str());
    say("strdup", at == nullptr);
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

void at_index()
{
    std::vector<int> numbers(3);
    g_size = 5;
    std::printf("%d\n", numbers.at(g_size));
}

// The functions that the C++ library and the compiler call in place of an exception, by name.
void thrown(const std::string &name)
{
    const std::map<std::string, std::function<void()>> all = {
        {"vector::at", at_index},
        {"bad_alloc", [] { std::__throw_bad_alloc(); }},
        {"bad_array_new_length", [] { std::__throw_bad_array_new_length(); }},
        {"bad_cast", [] { std::__throw_bad_cast(); }},
        {"bad_exception", [] { std::__throw_bad_exception(); }},
        {"bad_function_call", [] { std::function<void()>()(); }},
        {"bad_typeid", [] { std::__throw_bad_typeid(); }},
        {"logic_error", [] { std::__throw_logic_error(""); }},
        {"domain_error", [] { std::__throw_domain_error(""); }},
        {"invalid_argument", [] { std::__throw_invalid_argument(""); }},
        {"length_error", [] { std::vector<int>().reserve(SIZE_MAX); }},
        {"out_of_range", [] { std::__throw_out_of_range(""); }},
        {"runtime_error", [] { std::__throw_runtime_error(""); }},
        {"range_error", [] { std::__throw_range_error(""); }},
        {"overflow_error", [] { std::__throw_overflow_error(""); }},
        {"underflow_error", [] { std::__throw_underflow_error(""); }},
        {"allocate", [] { __cxa_allocate_exception(8); }},
        {"allocate dependent", [] { __cxa_allocate_dependent_exception(); }},
        {"free", [] { __cxa_free_exception(nullptr), __cxa_free_dependent_exception(nullptr); }},
        {"pure", [] { __cxa_pure_virtual(); }},
        {"deleted", [] { __cxa_deleted_virtual(); }},
    };
    all.at(name)();
}

} // namespace

int main(int, char **arguments)
{
    std::setvbuf(stdout, nullptr, _IONBF, 0);
    const std::string what = arguments[1];
    say("nothing taken", roscfe::heap::used() < 4096);
    for (int i = 0; __gcov_dump != nullptr && i < 32; ++i)
    {
        g_spare[i] = std::malloc(std::size_t(8) << i / 4);
    }
    what == "aligned"     ? aligned()
    : what == "c"         ? of_c()
    : what == "given back" ? given_back()
    : what == "resized"   ? resized()
    : what == "too large" ? too_large()
    : what == "full"      ? full()
    : what == "sealed"    ? sealed()
    : what == "negative"  ? negative()
    : what == "half"      ? half()
    : what == "wide"      ? wide()
                          : thrown(what);
    std::puts("done");
}
