// A callable of any kind: the standard library's function with the members that only Boost's has.
#ifndef BOOST_FUNCTION_HPP_INCLUDED
#define BOOST_FUNCTION_HPP_INCLUDED

#include <functional>

namespace boost
{

template <class Signature>
class function;

template <class Result, class... Arguments>
class function<Result(Arguments...)> : public std::function<Result(Arguments...)>
{
  public:
    using std::function<Result(Arguments...)>::function;
    using std::function<Result(Arguments...)>::operator=;

    function() = default;

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
