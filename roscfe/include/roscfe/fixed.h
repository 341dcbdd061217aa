// Strings and vectors with a fixed capacity: what messages are made of in the strict profile. They never allocate.
//
// They have what nodes use of std::string and std::vector. What does not fit ends the application with an event
// (roscfe::refuse); nothing is ever cut. Reading from the bus asks first (`fits`), and refuses the message instead.
#ifndef ROSCFE_FIXED_H
#define ROSCFE_FIXED_H

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <istream>
#include <iterator>
#include <ostream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "roscfe/refuse.h"

namespace roscfe
{
namespace detail
{

// End the application over a field that is too small, saying both numbers.
[[noreturn]] inline void refuse_overflow(const char *what, std::size_t wanted, std::size_t capacity)
{
    char  text[64];
    char *at = text + sizeof text;
    *--at = '\0';
    const auto put_text = [&at](const char *part) {
        for (std::size_t left = std::strlen(part); left > 0;)
            *--at = part[--left];
    };
    const auto put_number = [&at](std::size_t number) {
        do
            *--at = static_cast<char>('0' + number % 10);
        while (number /= 10);
    };
    put_text(" wanted");
    put_number(wanted);
    put_text(" at most, ");
    put_number(capacity);
    refuse(what, at);
}

} // namespace detail

template <std::size_t N>
class FixedString
{
  public:
    typedef char                                  value_type;
    typedef std::char_traits<char>                traits_type;
    typedef std::size_t                           size_type;
    typedef std::ptrdiff_t                        difference_type;
    typedef char &                                reference;
    typedef const char &                          const_reference;
    typedef char *                                pointer;
    typedef const char *                          const_pointer;
    typedef char *                                iterator;
    typedef const char *                          const_iterator;
    typedef std::reverse_iterator<iterator>       reverse_iterator;
    typedef std::reverse_iterator<const_iterator> const_reverse_iterator;

    static constexpr size_type npos = static_cast<size_type>(-1);

    FixedString() : size_(0) { text_[0] = '\0'; }
    FixedString(const FixedString &other) { set(other.view()); }
    FixedString(const char *text) { set(text); }
    FixedString(const char *text, size_type count) { set(std::string_view(text, count)); }
    FixedString(size_type count, char letter) : FixedString() { resize(count, letter); }
    FixedString(const std::string &text) { set(text); }
    FixedString(std::string_view text) { set(text); }
    template <std::size_t K>
    FixedString(const FixedString<K> &other)
    {
        set(other.view());
    }
    template <class Iterator, class = typename std::iterator_traits<Iterator>::iterator_category>
    FixedString(Iterator first, Iterator last) : FixedString()
    {
        append(first, last);
    }

    FixedString &operator=(const FixedString &other) { return this == &other ? *this : assign(other.view()); }
    FixedString &operator=(const char *text) { return assign(text); }
    FixedString &operator=(const std::string &text) { return assign(text); }
    FixedString &operator=(std::string_view text) { return assign(text); }
    FixedString &operator=(char letter) { return assign(1, letter); }
    template <std::size_t K>
    FixedString &operator=(const FixedString<K> &other)
    {
        return assign(other.view());
    }

    FixedString &assign(std::string_view text)
    {
        set(text);
        return *this;
    }
    FixedString &assign(const char *text, size_type count) { return assign(std::string_view(text, count)); }
    FixedString &assign(size_type count, char letter)
    {
        clear();
        return append(count, letter);
    }
    template <class Iterator, class = typename std::iterator_traits<Iterator>::iterator_category>
    FixedString &assign(Iterator first, Iterator last)
    {
        clear();
        return append(first, last);
    }

    static constexpr bool fits(size_type count) { return count <= N; }

    operator std::string() const { return std::string(text_, size_); }
    std::string_view view() const { return std::string_view(text_, size_); }
    std::string      str() const { return std::string(text_, size_); }

    const char *     c_str() const { return text_; }
    char *           data() { return text_; }
    const char *     data() const { return text_; }
    size_type        size() const { return size_; }
    size_type        length() const { return size_; }
    bool             empty() const { return size_ == 0; }
    static constexpr size_type capacity() { return N; }
    static constexpr size_type max_size() { return N; }
    void             reserve(size_type = 0) {}
    void             shrink_to_fit() {}

    iterator               begin() { return text_; }
    const_iterator         begin() const { return text_; }
    const_iterator         cbegin() const { return text_; }
    iterator               end() { return text_ + size_; }
    const_iterator         end() const { return text_ + size_; }
    const_iterator         cend() const { return text_ + size_; }
    reverse_iterator       rbegin() { return reverse_iterator(end()); }
    const_reverse_iterator rbegin() const { return const_reverse_iterator(end()); }
    reverse_iterator       rend() { return reverse_iterator(begin()); }
    const_reverse_iterator rend() const { return const_reverse_iterator(begin()); }

    char &      operator[](size_type index) { return text_[index]; }
    const char &operator[](size_type index) const { return text_[index]; }
    char &      at(size_type index) { return check(index), text_[index]; }
    const char &at(size_type index) const { return check(index), text_[index]; }
    char &      front() { return text_[0]; }
    const char &front() const { return text_[0]; }
    char &      back() { return text_[size_ - 1]; }
    const char &back() const { return text_[size_ - 1]; }

    void clear() { close(0); }
    void resize(size_type count, char letter = '\0')
    {
        room(count);
        if (count > size_)
            std::memset(text_ + size_, letter, count - size_);
        close(count);
    }
    // As resize, for one who has asked whether it fits, and who overwrites all of it.
    void resize_fitting(size_type count) { close(count); }
    void push_back(char letter) { append(1, letter); }
    void pop_back() { close(size_ - 1u); }

    FixedString &append(std::string_view text)
    {
        room(size_ + text.size());
        std::memmove(text_ + size_, text.data(), text.size());
        close(size_ + text.size());
        return *this;
    }
    FixedString &append(const char *text, size_type count) { return append(std::string_view(text, count)); }
    FixedString &append(size_type count, char letter)
    {
        resize(size_ + count, letter);
        return *this;
    }
    template <std::size_t K>
    FixedString &append(const FixedString<K> &text)
    {
        return append(text.view());
    }
    template <class Iterator, class = typename std::iterator_traits<Iterator>::iterator_category>
    FixedString &append(Iterator first, Iterator last)
    {
        for (; first != last; ++first)
            push_back(*first);
        return *this;
    }

    FixedString &operator+=(const char *text) { return append(text); }
    FixedString &operator+=(const std::string &text) { return append(std::string_view(text)); }
    FixedString &operator+=(char letter) { return append(1, letter); }
    template <std::size_t K>
    FixedString &operator+=(const FixedString<K> &text)
    {
        return append(text.view());
    }

    FixedString &erase(size_type from = 0, size_type count = npos)
    {
        check_place(from);
        const size_type gone = std::min<size_type>(count, size_ - from);
        std::memmove(text_ + from, text_ + from + gone, size_ - from - gone);
        close(size_ - gone);
        return *this;
    }
    iterator erase(const_iterator place)
    {
        const size_type from = static_cast<size_type>(place - text_);
        erase(from, 1);
        return text_ + from;
    }
    FixedString &insert(size_type place, std::string_view text)
    {
        check_place(place);
        const std::string_view old = view();
        room(size_ + text.size());
        const FixedString copy(text); // it may be a part of this one
        std::memmove(text_ + place + copy.size(), text_ + place, old.size() - place);
        std::memcpy(text_ + place, copy.data(), copy.size());
        close(old.size() + copy.size());
        return *this;
    }

    std::string substr(size_type from = 0, size_type count = npos) const
    {
        check_place(from);
        return std::string(view().substr(from, count));
    }

    size_type find(std::string_view text, size_type from = 0) const { return view().find(text, from); }
    size_type find(char letter, size_type from = 0) const { return view().find(letter, from); }
    size_type rfind(std::string_view text, size_type from = npos) const { return view().rfind(text, from); }
    size_type rfind(char letter, size_type from = npos) const { return view().rfind(letter, from); }
    size_type find_first_of(std::string_view set, size_type from = 0) const { return view().find_first_of(set, from); }
    size_type find_first_not_of(std::string_view set, size_type from = 0) const
    {
        return view().find_first_not_of(set, from);
    }
    size_type find_last_of(std::string_view set, size_type from = npos) const
    {
        return view().find_last_of(set, from);
    }
    size_type find_last_not_of(std::string_view set, size_type from = npos) const
    {
        return view().find_last_not_of(set, from);
    }

    int compare(std::string_view other) const { return view().compare(other); }
    template <std::size_t K>
    int compare(const FixedString<K> &other) const
    {
        return view().compare(other.view());
    }
    int compare(size_type from, size_type count, std::string_view other) const
    {
        check_place(from);
        return view().substr(from, count).compare(other);
    }

    void swap(FixedString &other) { std::swap(*this, other); }

  private:
    std::uint32_t size_;
    char          text_[N + 1];

    void set(std::string_view text)
    {
        room(text.size());
        std::memmove(text_, text.data(), text.size());
        close(text.size());
    }
    void close(size_type count)
    {
        size_ = static_cast<std::uint32_t>(count);
        text_[count] = '\0';
    }
    static void room(size_type count)
    {
        if (count > N)
            detail::refuse_overflow("a text is too long for a field of a message", count, N);
    }
    void check(size_type index) const
    {
        if (index >= size_)
            ROSCFE_THROW(std::out_of_range("FixedString: index out of range"));
    }
    void check_place(size_type index) const
    {
        if (index > size_)
            ROSCFE_THROW(std::out_of_range("FixedString: place out of range"));
    }
};

namespace detail
{

template <class T>
struct IsFixedString : std::false_type
{
};
template <std::size_t N>
struct IsFixedString<FixedString<N>> : std::true_type
{
};

template <class T>
constexpr bool is_text = IsFixedString<T>::value || std::is_convertible<const T &, std::string_view>::value;

// Two texts of which at least one is a FixedString, for its operators.
template <class A, class B>
using IfTexts = std::enable_if_t<(IsFixedString<A>::value && is_text<B>) || (is_text<A> && IsFixedString<B>::value)>;

// Whether items of one type go into a vector of the other: the same type, or texts, which differ in their capacity.
template <class T, class U>
constexpr bool alike = std::is_same<T, U>::value ||
                       ((IsFixedString<T>::value || IsFixedString<U>::value) && is_text<T> && is_text<U>);

template <class T, class U>
using IfAlike = std::enable_if_t<alike<T, U>>;

inline std::string_view view_of(std::string_view text)
{
    return text;
}

template <std::size_t N>
std::string_view view_of(const FixedString<N> &text)
{
    return text.view();
}

} // namespace detail

template <class A, class B, class = detail::IfTexts<A, B>>
bool operator==(const A &a, const B &b)
{
    return detail::view_of(a) == detail::view_of(b);
}

template <class A, class B, class = detail::IfTexts<A, B>>
bool operator!=(const A &a, const B &b)
{
    return detail::view_of(a) != detail::view_of(b);
}

template <class A, class B, class = detail::IfTexts<A, B>>
bool operator<(const A &a, const B &b)
{
    return detail::view_of(a) < detail::view_of(b);
}

template <class A, class B, class = detail::IfTexts<A, B>>
bool operator>(const A &a, const B &b)
{
    return detail::view_of(a) > detail::view_of(b);
}

template <class A, class B, class = detail::IfTexts<A, B>>
bool operator<=(const A &a, const B &b)
{
    return detail::view_of(a) <= detail::view_of(b);
}

template <class A, class B, class = detail::IfTexts<A, B>>
bool operator>=(const A &a, const B &b)
{
    return detail::view_of(a) >= detail::view_of(b);
}

// The sum of two texts may be any length: it is a std::string.
template <class A, class B, class = detail::IfTexts<A, B>>
std::string operator+(const A &a, const B &b)
{
    std::string sum(detail::view_of(a));
    return sum.append(detail::view_of(b));
}

template <std::size_t N>
std::string operator+(const FixedString<N> &a, char b)
{
    return a.str() + b;
}

template <std::size_t N>
std::string operator+(char a, const FixedString<N> &b)
{
    return a + b.str();
}

template <std::size_t N>
std::ostream &operator<<(std::ostream &os, const FixedString<N> &text)
{
    return os << text.view();
}

template <std::size_t N>
std::istream &operator>>(std::istream &is, FixedString<N> &text)
{
    std::string word;
    if (is >> word)
        text = word;
    return is;
}

template <class T, std::size_t N>
class FixedVector
{
  public:
    typedef T                                     value_type;
    typedef std::size_t                           size_type;
    typedef std::ptrdiff_t                        difference_type;
    typedef T &                                   reference;
    typedef const T &                             const_reference;
    typedef T *                                   pointer;
    typedef const T *                             const_pointer;
    typedef T *                                   iterator;
    typedef const T *                             const_iterator;
    typedef std::reverse_iterator<iterator>       reverse_iterator;
    typedef std::reverse_iterator<const_iterator> const_reverse_iterator;

    FixedVector() : size_(0) {}
    FixedVector(const FixedVector &other) : size_(0) { assign(other.begin(), other.end()); }
    explicit FixedVector(size_type count) : size_(0) { resize(count); }
    FixedVector(size_type count, const T &value) : size_(0) { resize(count, value); }
    FixedVector(std::initializer_list<T> items) : size_(0) { assign(items.begin(), items.end()); }
    template <class U, class Allocator, class = detail::IfAlike<T, U>>
    FixedVector(const std::vector<U, Allocator> &items) : size_(0)
    {
        assign(items.begin(), items.end());
    }
    template <class U, std::size_t K, class = detail::IfAlike<T, U>>
    FixedVector(const FixedVector<U, K> &items) : size_(0)
    {
        assign(items.begin(), items.end());
    }
    template <class Iterator, class = typename std::iterator_traits<Iterator>::iterator_category>
    FixedVector(Iterator first, Iterator last) : size_(0)
    {
        assign(first, last);
    }

    FixedVector &operator=(const FixedVector &other)
    {
        if (this != &other)
            assign(other.begin(), other.end());
        return *this;
    }
    FixedVector &operator=(std::initializer_list<T> items)
    {
        assign(items.begin(), items.end());
        return *this;
    }
    template <class U, class Allocator, class = detail::IfAlike<T, U>>
    FixedVector &operator=(const std::vector<U, Allocator> &items)
    {
        assign(items.begin(), items.end());
        return *this;
    }
    template <class U, std::size_t K, class = detail::IfAlike<T, U>>
    FixedVector &operator=(const FixedVector<U, K> &items)
    {
        assign(items.begin(), items.end());
        return *this;
    }

    static constexpr bool fits(size_type count) { return count <= N; }

    template <class U, class Allocator, class = detail::IfAlike<T, U>>
    operator std::vector<U, Allocator>() const
    {
        return std::vector<U, Allocator>(begin(), end());
    }

    T *              data() { return items_; }
    const T *        data() const { return items_; }
    size_type        size() const { return size_; }
    bool             empty() const { return size_ == 0; }
    static constexpr size_type capacity() { return N; }
    static constexpr size_type max_size() { return N; }
    void             reserve(size_type) {}
    void             shrink_to_fit() {}

    iterator               begin() { return items_; }
    const_iterator         begin() const { return items_; }
    const_iterator         cbegin() const { return items_; }
    iterator               end() { return items_ + size_; }
    const_iterator         end() const { return items_ + size_; }
    const_iterator         cend() const { return items_ + size_; }
    reverse_iterator       rbegin() { return reverse_iterator(end()); }
    const_reverse_iterator rbegin() const { return const_reverse_iterator(end()); }
    reverse_iterator       rend() { return reverse_iterator(begin()); }
    const_reverse_iterator rend() const { return const_reverse_iterator(begin()); }

    T &      operator[](size_type index) { return items_[index]; }
    const T &operator[](size_type index) const { return items_[index]; }
    T &      at(size_type index) { return check(index), items_[index]; }
    const T &at(size_type index) const { return check(index), items_[index]; }
    T &      front() { return items_[0]; }
    const T &front() const { return items_[0]; }
    T &      back() { return items_[size_ - 1]; }
    const T &back() const { return items_[size_ - 1]; }

    void clear() { size_ = 0; }
    void resize(size_type count) { resize(count, T()); }
    void resize(size_type count, const T &value)
    {
        room(count);
        for (size_type index = size_; index < count; ++index)
            items_[index] = value;
        size_ = static_cast<std::uint32_t>(count);
    }
    // As resize, for one who has asked whether it fits, and who overwrites all of it.
    void resize_fitting(size_type count) { size_ = static_cast<std::uint32_t>(count); }

    void push_back(const T &value)
    {
        room(size_ + 1u);
        items_[size_++] = value;
    }
    template <class... Arguments>
    T &emplace_back(Arguments &&...arguments)
    {
        push_back(T(std::forward<Arguments>(arguments)...));
        return back();
    }
    void pop_back() { --size_; }

    void assign(size_type count, const T &value)
    {
        const T copy = value; // it may be an item of this one
        clear();
        resize(count, copy);
    }
    void assign(std::initializer_list<T> items) { assign(items.begin(), items.end()); }
    template <class Iterator, class = typename std::iterator_traits<Iterator>::iterator_category>
    void assign(Iterator first, Iterator last)
    {
        typedef typename std::iterator_traits<Iterator>::iterator_category Category;
        clear();
        if constexpr (std::is_base_of<std::forward_iterator_tag, Category>::value)
        {
            const size_type count = static_cast<size_type>(std::distance(first, last));
            room(count);
            resize_fitting(count);
            std::copy(first, last, begin());
        }
        else
            for (; first != last; ++first)
                push_back(*first);
    }

    iterator insert(const_iterator place, const T &value) { return insert(place, size_type(1), value); }
    iterator insert(const_iterator place, size_type count, const T &value)
    {
        const T copy = value; // it may be an item of this one
        T *     gap = open(place, count);
        std::fill(gap, gap + count, copy);
        return gap;
    }
    template <class Iterator, class = typename std::iterator_traits<Iterator>::iterator_category>
    iterator insert(const_iterator place, Iterator first, Iterator last)
    {
        T *gap = open(place, static_cast<size_type>(std::distance(first, last)));
        std::copy(first, last, gap);
        return gap;
    }
    iterator insert(const_iterator place, std::initializer_list<T> items)
    {
        return insert(place, items.begin(), items.end());
    }
    iterator erase(const_iterator place) { return erase(place, place + 1); }
    iterator erase(const_iterator first, const_iterator last)
    {
        T *gap = items_ + (first - items_);
        std::move(items_ + (last - items_), end(), gap);
        size_ -= static_cast<std::uint32_t>(last - first);
        return gap;
    }

    void swap(FixedVector &other) { std::swap(*this, other); }

  private:
    std::uint32_t size_;
    T             items_[N > 0 ? N : 1];

    static void room(size_type count)
    {
        if (count > N)
            detail::refuse_overflow("an array is too long for a field of a message", count, N);
    }
    T *open(const_iterator place, size_type count)
    {
        room(size_ + count);
        T *gap = items_ + (place - items_);
        std::move_backward(gap, end(), end() + count);
        size_ += static_cast<std::uint32_t>(count);
        return gap;
    }
    void check(size_type index) const
    {
        if (index >= size_)
            ROSCFE_THROW(std::out_of_range("FixedVector: index out of range"));
    }
};

namespace detail
{

template <class A, class B>
bool same_items(const A &a, const B &b)
{
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

} // namespace detail

template <class T, std::size_t N, class U, std::size_t K, class = detail::IfAlike<T, U>>
bool operator==(const FixedVector<T, N> &a, const FixedVector<U, K> &b)
{
    return detail::same_items(a, b);
}

template <class T, std::size_t N, class U, class A, class = detail::IfAlike<T, U>>
bool operator==(const FixedVector<T, N> &a, const std::vector<U, A> &b)
{
    return detail::same_items(a, b);
}

template <class T, std::size_t N, class U, class A, class = detail::IfAlike<T, U>>
bool operator==(const std::vector<U, A> &a, const FixedVector<T, N> &b)
{
    return detail::same_items(a, b);
}

template <class T, std::size_t N, class U, std::size_t K, class = detail::IfAlike<T, U>>
bool operator!=(const FixedVector<T, N> &a, const FixedVector<U, K> &b)
{
    return !detail::same_items(a, b);
}

template <class T, std::size_t N, class U, class A, class = detail::IfAlike<T, U>>
bool operator!=(const FixedVector<T, N> &a, const std::vector<U, A> &b)
{
    return !detail::same_items(a, b);
}

template <class T, std::size_t N, class U, class A, class = detail::IfAlike<T, U>>
bool operator!=(const std::vector<U, A> &a, const FixedVector<T, N> &b)
{
    return !detail::same_items(a, b);
}

} // namespace roscfe

#endif
