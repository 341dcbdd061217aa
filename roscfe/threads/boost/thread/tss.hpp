// A pointer of which each thread has its own.
#ifndef BOOST_THREAD_TSS_HPP
#define BOOST_THREAD_TSS_HPP

#include <pthread.h>

namespace boost
{

template <class T>
class thread_specific_ptr
{
  public:
    typedef T element_type;

    thread_specific_ptr() : thread_specific_ptr([](T *gone) { delete gone; }) {}
    explicit thread_specific_ptr(void (*destroy)(T *)) : destroy_(destroy) { pthread_key_create(&key_, end); }
    ~thread_specific_ptr()
    {
        reset();
        pthread_key_delete(key_);
    }
    thread_specific_ptr(const thread_specific_ptr &) = delete;
    thread_specific_ptr &operator=(const thread_specific_ptr &) = delete;

    T *get() const
    {
        const auto *held = static_cast<Held *>(pthread_getspecific(key_));
        return held != nullptr ? held->value : nullptr;
    }
    T *operator->() const { return get(); }
    T &operator*() const { return *get(); }

    void reset(T *value = nullptr)
    {
        if (value != get())
        {
            end(pthread_getspecific(key_));
            pthread_setspecific(key_, value != nullptr ? new Held{value, destroy_} : nullptr);
        }
    }
    T *release()
    {
        T *value = get();
        delete static_cast<Held *>(pthread_getspecific(key_));
        pthread_setspecific(key_, nullptr);
        return value;
    }

  private:
    struct Held
    {
        T *value;
        void (*destroy)(T *);
    };

    static void end(void *thing)
    {
        auto *held = static_cast<Held *>(thing);
        if (held != nullptr && held->destroy != nullptr)
        {
            held->destroy(held->value);
        }
        delete held;
    }

    pthread_key_t key_{};
    void (*destroy_)(T *);
};

} // namespace boost

#endif
