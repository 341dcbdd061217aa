// What functions of the C++ library call where they would throw. Nodes of the profiles pool and strict have no handler, so
// the application ends with an event; and the library's own, with the tables, the names of types and the memory that it
// throws with, are no part of the image. A node of the profile pool that throws or catches itself has them; its exceptions
// are in its arena, and the C++ library's reserve for a computer without memory is no part of the image.
#if (defined(ROSCFE_PROFILE_POOL) || defined(ROSCFE_PROFILE_STRICT)) && defined(__cpp_exceptions)

#include <cstdarg>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <stdexcept>
#include <typeinfo>

#include "roscfe/refuse.h"

namespace
{

// The runtime keeps what it knows of an exception right before it, in less than this on all processors.
constexpr std::size_t kBefore = 256;

void *room_for_exception(std::size_t size)
{
    void *room = std::malloc(size);
    if (room == nullptr)
    {
        roscfe::refuse("exception", "the arena has no memory for it");
    }
    return std::memset(room, 0, size);
}

} // namespace

// As the C++ library's own, which translate their texts, and bring its streams and languages along for that.
namespace std
{

void __throw_bad_alloc()
{
    throw bad_alloc();
}
void __throw_bad_array_new_length()
{
    throw bad_array_new_length();
}
void __throw_bad_cast()
{
    throw bad_cast();
}
void __throw_bad_exception()
{
    throw bad_exception();
}
void __throw_bad_typeid()
{
    throw bad_typeid();
}
void __throw_logic_error(const char *text)
{
    throw logic_error(text);
}
void __throw_domain_error(const char *text)
{
    throw domain_error(text);
}
void __throw_invalid_argument(const char *text)
{
    throw invalid_argument(text);
}
void __throw_length_error(const char *text)
{
    throw length_error(text);
}
void __throw_out_of_range(const char *text)
{
    throw out_of_range(text);
}
void __throw_out_of_range_fmt(const char *format, ...)
{
    char         text[256];
    std::va_list values;
    va_start(values, format);
    std::vsnprintf(text, sizeof text, format, values);
    va_end(values);
    throw out_of_range(text);
}
void __throw_runtime_error(const char *text)
{
    throw runtime_error(text);
}
void __throw_range_error(const char *text)
{
    throw range_error(text);
}
void __throw_overflow_error(const char *text)
{
    throw overflow_error(text);
}
void __throw_underflow_error(const char *text)
{
    throw underflow_error(text);
}

} // namespace std

extern "C" {

void *__cxa_allocate_exception(std::size_t size) noexcept
{
    return static_cast<char *>(room_for_exception(kBefore + size)) + kBefore;
}
void __cxa_free_exception(void *exception) noexcept
{
    std::free(static_cast<char *>(exception) - kBefore);
}
void *__cxa_allocate_dependent_exception() noexcept
{
    return room_for_exception(kBefore);
}
void __cxa_free_dependent_exception(void *exception) noexcept
{
    std::free(exception);
}

} // extern "C"

#elif defined(ROSCFE_PROFILE_POOL) || defined(ROSCFE_PROFILE_STRICT)

#include <cstddef>

#include "roscfe/refuse.h"

namespace
{

[[noreturn]] void thrown()
{
    roscfe::refuse("exception", "a function of the C++ library has thrown one");
}

} // namespace

namespace std
{

void __throw_bad_alloc()
{
    thrown();
}
void __throw_bad_array_new_length()
{
    thrown();
}
void __throw_bad_cast()
{
    thrown();
}
void __throw_bad_exception()
{
    thrown();
}
void __throw_bad_function_call()
{
    thrown();
}
void __throw_bad_typeid()
{
    thrown();
}
void __throw_logic_error(const char *)
{
    thrown();
}
void __throw_domain_error(const char *)
{
    thrown();
}
void __throw_invalid_argument(const char *)
{
    thrown();
}
void __throw_length_error(const char *)
{
    thrown();
}
void __throw_out_of_range(const char *)
{
    thrown();
}
void __throw_out_of_range_fmt(const char *, ...)
{
    thrown();
}
void __throw_runtime_error(const char *)
{
    thrown();
}
void __throw_range_error(const char *)
{
    thrown();
}
void __throw_overflow_error(const char *)
{
    thrown();
}
void __throw_underflow_error(const char *)
{
    thrown();
}

} // namespace std

extern "C" {

[[noreturn]] void __cxa_pure_virtual()
{
    roscfe::refuse("exception", "a pure virtual function was called");
}
[[noreturn]] void __cxa_deleted_virtual()
{
    roscfe::refuse("exception", "a deleted virtual function was called");
}

[[noreturn]] void *__cxa_allocate_exception(std::size_t) noexcept
{
    thrown();
}
[[noreturn]] void *__cxa_allocate_dependent_exception() noexcept
{
    thrown();
}
void __cxa_free_exception(void *) noexcept {}
void __cxa_free_dependent_exception(void *) noexcept {}

} // extern "C"

#endif
