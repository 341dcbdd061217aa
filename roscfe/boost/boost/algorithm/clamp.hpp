// A value between two bounds.
#ifndef BOOST_ALGORITHM_CLAMP_HPP
#define BOOST_ALGORITHM_CLAMP_HPP

namespace boost
{
namespace algorithm
{
namespace detail
{

template <class T>
struct identity
{
    typedef T type;
};

} // namespace detail

// The bounds become of the value's type, as in Boost.
template <class T, class Less>
const T &clamp(const T &value, const typename detail::identity<T>::type &low,
               const typename detail::identity<T>::type &high, Less less)
{
    return less(value, low) ? low : less(high, value) ? high : value;
}

template <class T>
const T &clamp(const T &value, const typename detail::identity<T>::type &low,
               const typename detail::identity<T>::type &high)
{
    return value < low ? low : high < value ? high : value;
}

} // namespace algorithm
} // namespace boost

#endif
