// A pointer that owns its object and gives it to nobody. The standard library's unique_ptr could be moved.
#ifndef BOOST_SCOPED_PTR_HPP_INCLUDED
#define BOOST_SCOPED_PTR_HPP_INCLUDED

#include <memory>

namespace boost
{

template <class T>
class scoped_ptr
{
  public:
    typedef T element_type;

    explicit scoped_ptr(T *object = nullptr) noexcept : owned_(object) {}
    scoped_ptr(const scoped_ptr &) = delete;
    scoped_ptr &operator=(const scoped_ptr &) = delete;

    void reset(T *object = nullptr) noexcept { owned_.reset(object); }
    void swap(scoped_ptr &other) noexcept { owned_.swap(other.owned_); }

    T *get() const noexcept { return owned_.get(); }
    T &operator*() const { return *owned_; }
    T *operator->() const noexcept { return owned_.get(); }
    explicit operator bool() const noexcept { return static_cast<bool>(owned_); }
    bool operator!() const noexcept { return !owned_; }

  private:
    std::unique_ptr<T> owned_;
};

template <class T>
void swap(scoped_ptr<T> &a, scoped_ptr<T> &b) noexcept
{
    a.swap(b);
}

template <class T>
T *get_pointer(const scoped_ptr<T> &pointer) noexcept
{
    return pointer.get();
}

} // namespace boost

#endif
