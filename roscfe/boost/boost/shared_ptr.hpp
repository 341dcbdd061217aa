// Shared pointers are the standard library's: messages, callbacks and a node's own.
#ifndef BOOST_SHARED_PTR_HPP_INCLUDED
#define BOOST_SHARED_PTR_HPP_INCLUDED

#include <memory>

namespace boost
{

using std::shared_ptr;

using std::const_pointer_cast;
using std::dynamic_pointer_cast;
using std::static_pointer_cast;

template <class T, class U>
shared_ptr<T> reinterpret_pointer_cast(const shared_ptr<U> &pointer) noexcept
{
    return shared_ptr<T>(pointer, reinterpret_cast<typename shared_ptr<T>::element_type *>(pointer.get()));
}

template <class T>
T *get_pointer(const shared_ptr<T> &pointer) noexcept
{
    return pointer.get();
}

} // namespace boost

#endif
