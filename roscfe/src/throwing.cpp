// What functions of the C++ library call where they would throw. Nodes of the profiles pool and strict have no handler, so
// the application ends with an event; and the library's own, with the tables, the names of types and the memory that it
// throws with, are no part of the image.
#if defined(ROSCFE_PROFILE_POOL) || defined(ROSCFE_PROFILE_STRICT)

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
