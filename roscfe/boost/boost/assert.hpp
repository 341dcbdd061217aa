// Assertions are the standard library's. As there, each inclusion decides anew whether they are checked (NDEBUG).
#include <cassert>

#undef BOOST_ASSERT
#undef BOOST_ASSERT_MSG
#undef BOOST_VERIFY

#define BOOST_ASSERT(condition) assert(condition)
#define BOOST_ASSERT_MSG(condition, message) assert((condition) && (message))
#ifdef NDEBUG
#define BOOST_VERIFY(condition) ((void)(condition))
#else
#define BOOST_VERIFY(condition) assert(condition)
#endif
