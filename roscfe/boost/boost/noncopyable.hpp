// A base class that forbids copies.
#ifndef BOOST_NONCOPYABLE_HPP_INCLUDED
#define BOOST_NONCOPYABLE_HPP_INCLUDED

namespace boost
{
namespace noncopyable_ // a namespace of its own keeps a base class from dragging boost into look-ups
{

class noncopyable
{
  protected:
    noncopyable() = default;
    ~noncopyable() = default;
    noncopyable(const noncopyable &) = delete;
    noncopyable &operator=(const noncopyable &) = delete;
};

} // namespace noncopyable_

typedef noncopyable_::noncopyable noncopyable;

} // namespace boost

#endif
