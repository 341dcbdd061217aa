// Casts of shared pointers are beside the shared pointers; here are those of plain ones.
#ifndef BOOST_POINTER_CAST_HPP_INCLUDED
#define BOOST_POINTER_CAST_HPP_INCLUDED

#include "boost/shared_ptr.hpp"

namespace boost
{

template <class T, class U>
T *static_pointer_cast(U *pointer)
{
    return static_cast<T *>(pointer);
}

template <class T, class U>
T *dynamic_pointer_cast(U *pointer)
{
    return dynamic_cast<T *>(pointer);
}

template <class T, class U>
T *const_pointer_cast(U *pointer)
{
    return const_cast<T *>(pointer);
}

} // namespace boost

#endif
