// An array that owns its items and gives them to nobody.
#ifndef BOOST_SCOPED_ARRAY_HPP_INCLUDED
#define BOOST_SCOPED_ARRAY_HPP_INCLUDED

#include <cstddef>
#include <memory>

namespace boost
{

template <class T>
class scoped_array
{
  public:
    typedef T element_type;

    explicit scoped_array(T *items = nullptr) noexcept : owned_(items) {}
    scoped_array(const scoped_array &) = delete;
    scoped_array &operator=(const scoped_array &) = delete;

    void reset(T *items = nullptr) noexcept { owned_.reset(items); }
    void swap(scoped_array &other) noexcept { owned_.swap(other.owned_); }

    T *get() const noexcept { return owned_.get(); }
    T &operator[](std::ptrdiff_t index) const { return owned_[static_cast<std::size_t>(index)]; }
    explicit operator bool() const noexcept { return static_cast<bool>(owned_); }
    bool operator!() const noexcept { return !owned_; }

  private:
    std::unique_ptr<T[]> owned_;
};

} // namespace boost

#endif
