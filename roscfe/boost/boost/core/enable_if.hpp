// boost::enable_if and its kin: a type that exists only if a condition holds.
#ifndef BOOST_CORE_ENABLE_IF_HPP_INCLUDED
#define BOOST_CORE_ENABLE_IF_HPP_INCLUDED

namespace boost
{

template <bool holds, class T = void>
struct enable_if_c
{
    typedef T type;
};

template <class T>
struct enable_if_c<false, T>
{
};

template <bool holds, class T>
struct lazy_enable_if_c
{
    typedef typename T::type type;
};

template <class T>
struct lazy_enable_if_c<false, T>
{
};

template <class Condition, class T = void>
struct enable_if : enable_if_c<Condition::value, T>
{
};

template <class Condition, class T = void>
struct disable_if : enable_if_c<!Condition::value, T>
{
};

template <bool holds, class T = void>
struct disable_if_c : enable_if_c<!holds, T>
{
};

template <class Condition, class T>
struct lazy_enable_if : lazy_enable_if_c<Condition::value, T>
{
};

template <class Condition, class T>
struct lazy_disable_if : lazy_enable_if_c<!Condition::value, T>
{
};

template <bool holds, class T>
struct lazy_disable_if_c : lazy_enable_if_c<!holds, T>
{
};

} // namespace boost

#endif
