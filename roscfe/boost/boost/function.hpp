// A callable of any kind: the standard library's function with the members that only Boost's has.
#ifndef BOOST_FUNCTION_HPP_INCLUDED
#define BOOST_FUNCTION_HPP_INCLUDED

#include <cstddef>
#include <functional>
#include <type_traits>
#include <utility>

namespace boost
{

template <class Signature>
class function;

template <class Result, class... Arguments>
class function<Result(Arguments...)> : public std::function<Result(Arguments...)>
{
    typedef std::function<Result(Arguments...)> Base;

    template <class F>
    using IfOther = typename std::enable_if<!std::is_same<typename std::decay<F>::type, function>::value &&
                                                std::is_constructible<Base, F>::value,
                                            int>::type;

  public:
    typedef Result result_type;

    function()                 = default;
    function(const function &) = default;
    function(function &&)      = default;
    function(std::nullptr_t) {}
    // Any other callable. One that is a function itself is copied, not wrapped: an empty one stays empty.
    template <class F, IfOther<F> = 0>
    function(F &&callable) : Base(std::forward<F>(callable))
    {
    }

    function &operator=(const function &) = default;
    function &operator=(function &&) = default;
    function &operator=(std::nullptr_t)
    {
        Base::operator=(nullptr);
        return *this;
    }
    template <class F, IfOther<F> = 0>
    function &operator=(F &&callable)
    {
        return *this = function(std::forward<F>(callable));
    }

    bool empty() const { return !*this; }
    void clear() { *this = nullptr; }
};

// Boost's older spelling, without the parentheses.
template <class Result>
using function0 = function<Result()>;
template <class Result, class A>
using function1 = function<Result(A)>;
template <class Result, class A, class B>
using function2 = function<Result(A, B)>;
template <class Result, class A, class B, class C>
using function3 = function<Result(A, B, C)>;

} // namespace boost

#endif
