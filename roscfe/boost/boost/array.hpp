// An array of fixed length, which messages have for fields such as float64[36]: an aggregate, as Boost's is.
#ifndef BOOST_ARRAY_HPP_INCLUDED
#define BOOST_ARRAY_HPP_INCLUDED

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <stdexcept>

#include "roscfe/refuse.h"

namespace boost
{

template <class T, std::size_t N>
class array
{
  public:
    T elems[N]; // public, so that array<T, N> a = {{...}} works

    typedef T                                     value_type;
    typedef T *                                   iterator;
    typedef const T *                             const_iterator;
    typedef std::reverse_iterator<iterator>       reverse_iterator;
    typedef std::reverse_iterator<const_iterator> const_reverse_iterator;
    typedef T &                                   reference;
    typedef const T &                             const_reference;
    typedef std::size_t                           size_type;
    typedef std::ptrdiff_t                        difference_type;

    static constexpr std::size_t static_size = N;

    iterator               begin() { return elems; }
    const_iterator         begin() const { return elems; }
    const_iterator         cbegin() const { return elems; }
    iterator               end() { return elems + N; }
    const_iterator         end() const { return elems + N; }
    const_iterator         cend() const { return elems + N; }
    reverse_iterator       rbegin() { return reverse_iterator(end()); }
    const_reverse_iterator rbegin() const { return const_reverse_iterator(end()); }
    reverse_iterator       rend() { return reverse_iterator(begin()); }
    const_reverse_iterator rend() const { return const_reverse_iterator(begin()); }

    reference       operator[](size_type index) { return elems[index]; }
    const_reference operator[](size_type index) const { return elems[index]; }
    reference       at(size_type index) { return rangecheck(index), elems[index]; }
    const_reference at(size_type index) const { return rangecheck(index), elems[index]; }
    reference       front() { return elems[0]; }
    const_reference front() const { return elems[0]; }
    reference       back() { return elems[N - 1]; }
    const_reference back() const { return elems[N - 1]; }

    static constexpr size_type size() { return N; }
    static constexpr bool      empty() { return false; }
    static constexpr size_type max_size() { return N; }

    T *      data() { return elems; }
    const T *data() const { return elems; }
    T *      c_array() { return elems; }

    void swap(array &other) { std::swap_ranges(begin(), end(), other.begin()); }
    void fill(const T &value) { std::fill(begin(), end(), value); }
    void assign(const T &value) { fill(value); }

    template <class U>
    array &operator=(const array<U, N> &other)
    {
        std::copy(other.begin(), other.end(), begin());
        return *this;
    }

    static void rangecheck(size_type index)
    {
        if (index >= N)
            ROSCFE_THROW(std::out_of_range("array<>: index out of range"));
    }
};

// No items: such a field takes no bytes on the wire, but a class must have a size.
template <class T>
class array<T, 0>
{
  public:
    typedef T           value_type;
    typedef T *         iterator;
    typedef const T *   const_iterator;
    typedef T &         reference;
    typedef const T &   const_reference;
    typedef std::size_t size_type;

    static constexpr std::size_t static_size = 0;

    iterator       begin() { return nullptr; }
    const_iterator begin() const { return nullptr; }
    iterator       end() { return nullptr; }
    const_iterator end() const { return nullptr; }

    static constexpr size_type size() { return 0; }
    static constexpr bool      empty() { return true; }

    T *      data() { return nullptr; }
    const T *data() const { return nullptr; }
    T *      c_array() { return nullptr; }

    void fill(const T &) {}
    void assign(const T &) {}
};

template <class T, std::size_t N>
bool operator==(const array<T, N> &a, const array<T, N> &b)
{
    return std::equal(a.begin(), a.end(), b.begin());
}

template <class T, std::size_t N>
bool operator!=(const array<T, N> &a, const array<T, N> &b)
{
    return !(a == b);
}

template <class T, std::size_t N>
bool operator<(const array<T, N> &a, const array<T, N> &b)
{
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

template <class T, std::size_t N>
void swap(array<T, N> &a, array<T, N> &b)
{
    a.swap(b);
}

} // namespace boost

#endif
