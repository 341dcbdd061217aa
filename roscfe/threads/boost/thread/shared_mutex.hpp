// A mutex that readers share. One of them may become its writer later.
#ifndef BOOST_THREAD_SHARED_MUTEX_HPP
#define BOOST_THREAD_SHARED_MUTEX_HPP

#include "boost/thread/condition_variable.hpp"
#include "boost/thread/lock_guard.hpp"
#include "boost/thread/lock_types.hpp"
#include "boost/thread/mutex.hpp"

namespace boost
{

class shared_mutex
{
  public:
    shared_mutex() = default;
    shared_mutex(const shared_mutex &) = delete;
    shared_mutex &operator=(const shared_mutex &) = delete;

    void lock() { wait([this] { return try_it(may_write(), has_writer_, true); }); }
    bool try_lock() { return once([this] { return try_it(may_write(), has_writer_, true); }); }
    void unlock() { change([this] { has_writer_ = false; }); }

    void lock_shared() { wait([this] { return try_read(); }); }
    bool try_lock_shared() { return once([this] { return try_read(); }); }
    void unlock_shared() { change([this] { --readers_; }); }

    void lock_upgrade() { wait([this] { return try_it(!has_writer_ && !has_heir_, has_heir_, true); }); }
    bool try_lock_upgrade() { return once([this] { return try_it(!has_writer_ && !has_heir_, has_heir_, true); }); }
    void unlock_upgrade() { change([this] { has_heir_ = false; }); }
    void unlock_upgrade_and_lock()
    {
        wait([this] {
            if (readers_ > 0 || has_writer_)
            {
                return false;
            }
            has_heir_ = false;
            return try_it(true, has_writer_, true);
        });
    }
    void unlock_and_lock_upgrade()
    {
        change([this] {
            has_writer_ = false;
            has_heir_   = true;
        });
    }
    void unlock_and_lock_shared()
    {
        change([this] {
            has_writer_ = false;
            ++readers_;
        });
    }
    void unlock_upgrade_and_lock_shared()
    {
        change([this] {
            has_heir_ = false;
            ++readers_;
        });
    }

  private:
    bool may_write() const { return readers_ == 0 && !has_writer_ && !has_heir_; }
    bool try_read()
    {
        readers_ += has_writer_ ? 0 : 1;
        return !has_writer_;
    }
    static bool try_it(bool may, bool &what, bool value)
    {
        what = may ? value : what;
        return may;
    }

    template <class Try>
    void wait(Try attempt)
    {
        unique_lock<mutex> lock(mutex_);
        changed_.wait(lock, attempt);
    }
    template <class Try>
    bool once(Try attempt)
    {
        const lock_guard<mutex> guard(mutex_);
        return attempt();
    }
    template <class Change>
    void change(Change to)
    {
        const lock_guard<mutex> guard(mutex_);
        to();
        changed_.notify_all();
    }

    mutex                  mutex_;
    condition_variable     changed_;
    int                    readers_    = 0;
    bool                   has_writer_ = false;
    bool                   has_heir_   = false; // a reader that may become the writer
};

typedef shared_mutex upgrade_mutex;

template <class Mutex>
class shared_lock
{
  public:
    typedef Mutex mutex_type;

    shared_lock() = default;
    explicit shared_lock(Mutex &mutex) : mutex_(&mutex) { lock(); }
    shared_lock(Mutex &mutex, defer_lock_t) : mutex_(&mutex) {}
    shared_lock(Mutex &mutex, adopt_lock_t) : mutex_(&mutex), owns_(true) {}
    shared_lock(Mutex &mutex, try_to_lock_t) : mutex_(&mutex) { try_lock(); }
    shared_lock(const shared_lock &) = delete;
    shared_lock &operator=(const shared_lock &) = delete;
    ~shared_lock()
    {
        if (owns_)
        {
            unlock();
        }
    }

    void lock()
    {
        mutex_->lock_shared();
        owns_ = true;
    }
    bool try_lock()
    {
        owns_ = mutex_->try_lock_shared();
        return owns_;
    }
    void unlock()
    {
        owns_ = false;
        mutex_->unlock_shared();
    }
    bool     owns_lock() const { return owns_; }
    explicit operator bool() const { return owns_; }
    Mutex *  mutex() const { return mutex_; }

  private:
    Mutex *mutex_ = nullptr;
    bool   owns_  = false;
};

template <class Mutex>
class upgrade_lock
{
  public:
    typedef Mutex mutex_type;

    explicit upgrade_lock(Mutex &mutex) : mutex_(&mutex) { lock(); }
    upgrade_lock(const upgrade_lock &) = delete;
    upgrade_lock &operator=(const upgrade_lock &) = delete;
    ~upgrade_lock()
    {
        if (owns_)
        {
            unlock();
        }
    }

    void lock()
    {
        mutex_->lock_upgrade();
        owns_ = true;
    }
    void unlock()
    {
        owns_ = false;
        mutex_->unlock_upgrade();
    }
    bool   owns_lock() const { return owns_; }
    Mutex *mutex() const { return mutex_; }

  private:
    Mutex *mutex_;
    bool   owns_ = false;
};

// While this is there, its reader is the writer.
template <class Mutex>
class upgrade_to_unique_lock
{
  public:
    typedef Mutex mutex_type;

    explicit upgrade_to_unique_lock(upgrade_lock<Mutex> &lock) : mutex_(lock.mutex()) { mutex_->unlock_upgrade_and_lock(); }
    ~upgrade_to_unique_lock() { mutex_->unlock_and_lock_upgrade(); }
    upgrade_to_unique_lock(const upgrade_to_unique_lock &) = delete;
    upgrade_to_unique_lock &operator=(const upgrade_to_unique_lock &) = delete;

    bool owns_lock() const { return true; }

  private:
    Mutex *mutex_;
};

} // namespace boost

#endif
