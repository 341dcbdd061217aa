// How a thread asks another one to end: the other one throws where it waits.
#ifndef BOOST_THREAD_ROSCFE_INTERRUPTION_HPP
#define BOOST_THREAD_ROSCFE_INTERRUPTION_HPP

#include "roscfe/thread_waits.h"

namespace boost
{

// What a thread throws that was interrupted. It is none of std::exception.
class thread_interrupted
{
};

namespace roscfe_thread
{

// What a thread and the objects that stand for it share.
struct Data
{
    bool is_interrupted = false;
    bool is_done        = false;
    int  disabled       = 0; // objects that forbid interruptions
};

inline thread_local Data *t_data = nullptr; // null in the main thread, which cannot be interrupted

inline bool may_be_interrupted()
{
    return t_data != nullptr && t_data->disabled == 0;
}

// The flag that ends a wait of the calling thread, or null.
inline const bool *interruption()
{
    return may_be_interrupted() ? &t_data->is_interrupted : nullptr;
}

} // namespace roscfe_thread

namespace this_thread
{

inline bool interruption_enabled()
{
    return roscfe_thread::may_be_interrupted();
}

inline bool interruption_requested()
{
    return roscfe_thread::t_data != nullptr && roscfe_thread::t_data->is_interrupted;
}

inline void interruption_point()
{
    if (roscfe_thread::may_be_interrupted() && roscfe_thread::t_data->is_interrupted)
    {
        roscfe_thread::t_data->is_interrupted = false;
        throw thread_interrupted();
    }
}

class disable_interruption
{
  public:
    disable_interruption() { change(1); }
    ~disable_interruption() { change(-1); }
    disable_interruption(const disable_interruption &) = delete;
    disable_interruption &operator=(const disable_interruption &) = delete;

  private:
    friend class restore_interruption;

    static void change(int by)
    {
        if (roscfe_thread::t_data != nullptr)
        {
            roscfe_thread::t_data->disabled += by;
        }
    }
};

class restore_interruption
{
  public:
    explicit restore_interruption(disable_interruption &) { disable_interruption::change(-1); }
    ~restore_interruption() { disable_interruption::change(1); }
    restore_interruption(const restore_interruption &) = delete;
    restore_interruption &operator=(const restore_interruption &) = delete;
};

} // namespace this_thread
} // namespace boost

#endif
