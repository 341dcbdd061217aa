// A row of items of a fixed length, in which a new one takes the place of that at the other end. What most nodes call is
// there; nodes for the host get the computer's Boost in its place.
#ifndef BOOST_CIRCULAR_BUFFER_HPP
#define BOOST_CIRCULAR_BUFFER_HPP

#include <cstddef>
#include <iterator>
#include <stdexcept>
#include <vector>

#include "roscfe/refuse.h"

namespace boost
{

template <class T>
class circular_buffer
{
    template <class Buffer, class Item>
    class Iterator
    {
      public:
        typedef std::random_access_iterator_tag iterator_category;
        typedef T                               value_type;
        typedef std::ptrdiff_t                  difference_type;
        typedef Item *                          pointer;
        typedef Item &                          reference;

        Iterator() = default;
        Iterator(Buffer *buffer, std::size_t at) : buffer_(buffer), at_(at) {}
        operator Iterator<const circular_buffer, const T>() const { return {buffer_, at_}; }

        Item &     operator*() const { return (*buffer_)[at_]; }
        Item *     operator->() const { return &(*buffer_)[at_]; }
        Item &     operator[](difference_type by) const { return *(*this + by); }
        Iterator & operator++() { return *this += 1; }
        Iterator & operator--() { return *this += -1; }
        Iterator   operator++(int) { return step(1); }
        Iterator   operator--(int) { return step(-1); }
        Iterator & operator+=(difference_type by)
        {
            at_ += static_cast<std::size_t>(by);
            return *this;
        }
        Iterator &      operator-=(difference_type by) { return *this += -by; }
        Iterator        operator+(difference_type by) const { return Iterator(*this) += by; }
        Iterator        operator-(difference_type by) const { return Iterator(*this) -= by; }
        difference_type operator-(const Iterator &other) const
        {
            return static_cast<difference_type>(at_) - static_cast<difference_type>(other.at_);
        }
        bool operator==(const Iterator &other) const { return at_ == other.at_; }
        bool operator!=(const Iterator &other) const { return at_ != other.at_; }
        bool operator<(const Iterator &other) const { return at_ < other.at_; }

      private:
        Iterator step(difference_type by)
        {
            const Iterator before = *this;
            *this += by;
            return before;
        }

        Buffer *    buffer_ = nullptr;
        std::size_t at_     = 0;
    };

  public:
    typedef T                                             value_type;
    typedef std::size_t                                   size_type;
    typedef std::size_t                                   capacity_type;
    typedef T &                                           reference;
    typedef const T &                                     const_reference;
    typedef Iterator<circular_buffer, T>                  iterator;
    typedef Iterator<const circular_buffer, const T>      const_iterator;
    typedef std::reverse_iterator<iterator>               reverse_iterator;
    typedef std::reverse_iterator<const_iterator>         const_reverse_iterator;

    circular_buffer() = default;
    explicit circular_buffer(std::size_t capacity) : items_(capacity) {}
    circular_buffer(std::size_t count, const T &item) : items_(count, item), size_(count) {}
    circular_buffer(std::size_t capacity, std::size_t count, const T &item) : items_(capacity), size_(count)
    {
        for (std::size_t i = 0; i < count; ++i)
        {
            items_[i] = item;
        }
    }

    std::size_t size() const { return size_; }
    std::size_t capacity() const { return items_.size(); }
    std::size_t reserve() const { return capacity() - size_; }
    bool        empty() const { return size_ == 0; }
    bool        full() const { return size_ == capacity(); }

    // Keeps the first ones that find room.
    void set_capacity(std::size_t capacity) { become(capacity, 0); }
    // Keeps the last ones that find room.
    void rset_capacity(std::size_t capacity) { become(capacity, size_ > capacity ? size_ - capacity : 0); }

    T &      operator[](std::size_t at) { return items_[place(at)]; }
    const T &operator[](std::size_t at) const { return items_[place(at)]; }
    T &      at(std::size_t at) { return items_[place(checked(at))]; }
    const T &at(std::size_t at) const { return items_[place(checked(at))]; }
    T &      front() { return (*this)[0]; }
    const T &front() const { return (*this)[0]; }
    T &      back() { return (*this)[size_ - 1]; }
    const T &back() const { return (*this)[size_ - 1]; }

    void push_back(const T &item)
    {
        if (capacity() == 0)
        {
            return;
        }
        items_[place(size_)] = item;
        if (full())
        {
            first_ = place(1);
        }
        else
        {
            ++size_;
        }
    }
    void push_front(const T &item)
    {
        if (capacity() == 0)
        {
            return;
        }
        first_         = place(capacity() - 1);
        items_[first_] = item;
        size_ += full() ? 0 : 1;
    }
    void pop_back()
    {
        --size_;
        items_[place(size_)] = T();
    }
    void pop_front()
    {
        front() = T();
        first_  = place(1);
        --size_;
    }
    void clear()
    {
        while (!empty())
        {
            pop_back();
        }
    }

    iterator               begin() { return {this, 0}; }
    iterator               end() { return {this, size_}; }
    const_iterator         begin() const { return {this, 0}; }
    const_iterator         end() const { return {this, size_}; }
    reverse_iterator       rbegin() { return reverse_iterator(end()); }
    reverse_iterator       rend() { return reverse_iterator(begin()); }
    const_reverse_iterator rbegin() const { return const_reverse_iterator(end()); }
    const_reverse_iterator rend() const { return const_reverse_iterator(begin()); }

  private:
    std::size_t place(std::size_t at) const { return (first_ + at) % capacity(); }

    std::size_t checked(std::size_t at) const
    {
        if (at >= size_)
        {
            ROSCFE_THROW(std::out_of_range("circular_buffer"));
        }
        return at;
    }

    void become(std::size_t capacity, std::size_t from)
    {
        std::vector<T> items(capacity);
        std::size_t    kept = 0;
        for (; kept < capacity && from + kept < size_; ++kept)
        {
            items[kept] = (*this)[from + kept];
        }
        items_.swap(items);
        first_ = 0;
        size_  = kept;
    }

    std::vector<T> items_;
    std::size_t    first_ = 0;
    std::size_t    size_  = 0;
};

} // namespace boost

#endif
