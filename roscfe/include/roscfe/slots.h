// Messages that a subscription has received: made once, and used again when nobody holds them any more.
#ifndef ROSCFE_SLOTS_H
#define ROSCFE_SLOTS_H

#include <cstddef>

#include <boost/shared_ptr.hpp>

namespace roscfe
{

// As many messages as a queue holds and the node keeps, each with the memory that its shared pointer needs.
template <class M>
class Slots
{
  public:
    explicit Slots(std::size_t count) : slots_(new Slot[count])
    {
        for (std::size_t i = count; i > 0; --i)
        {
            give(&slots_[i - 1]);
        }
    }
    ~Slots() { delete[] slots_; }
    Slots(const Slots &) = delete;
    Slots &operator=(const Slots &) = delete;

    bool any() const { return free_ != nullptr; }

    // A message, as it was left by the one before; the slot is free again when no pointer to it is left.
    static boost::shared_ptr<M> take(const boost::shared_ptr<Slots> &slots)
    {
        Slot *slot   = slots->free_;
        slots->free_ = slot->next;
        return boost::shared_ptr<M>(&slot->message, Nothing(), Allocator<M>(slots, slot));
    }

  private:
    static constexpr std::size_t kPointerBytes = 96; // of what the pointers of one message share

    struct Slot
    {
        M     message{};
        Slot *next = nullptr;
        alignas(std::max_align_t) unsigned char pointer[kPointerBytes];
    };

    // The message stays; what counts is when the memory of the pointers is given back.
    struct Nothing
    {
        void operator()(M *) const {}
    };

    template <class T>
    struct Allocator
    {
        typedef T value_type;
        template <class U>
        struct rebind
        {
            typedef Allocator<U> other;
        };

        Allocator(const boost::shared_ptr<Slots> &of, Slot *taken) : slots(of), slot(taken) {}
        template <class U>
        Allocator(const Allocator<U> &other) : slots(other.slots), slot(other.slot)
        {
        }

        T *allocate(std::size_t)
        {
            static_assert(sizeof(T) <= kPointerBytes, "a slot has too little room for what shared pointers share");
            return reinterpret_cast<T *>(slot->pointer);
        }
        void deallocate(T *, std::size_t) { slots->give(slot); }
        template <class U>
        bool operator==(const Allocator<U> &other) const
        {
            return slot == other.slot;
        }
        template <class U>
        bool operator!=(const Allocator<U> &other) const
        {
            return slot != other.slot;
        }

        boost::shared_ptr<Slots> slots;
        Slot *                   slot;
    };

    void give(Slot *slot)
    {
        slot->next = free_;
        free_      = slot;
    }

    Slot *slots_;
    Slot *free_ = nullptr;
};

} // namespace roscfe

#endif
